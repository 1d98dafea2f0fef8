// The panel beside the map: the selection in numbers, coverage, issues, and all markers as a table.
import type { Issue } from './api.js';
import type { CountedCoverage } from './counted.js';
import { button, byId, el, plural } from './dom.js';
import type { Editor } from './editor.js';
import { IssueList } from './issue_list.js';
import { idCount, wrapDeg } from './geometry.js';
import type { Marker, Point } from './geometry.js';
import { drawFace } from './marker_paint.js';

const mostRows = 250;

export interface PanelActions {
  goTo(points: Point[]): void;
  suggest(): void;
  fill(): void;
  pickId(): void;
  letStand(issue: Issue, reason: string): void;
}

type FieldName = 'id' | 'x' | 'y' | 'z' | 'yawDeg';
const fields: [FieldName, string, string][] = [
  ['id', 'ID', '1'], ['x', 'x (m)', '0.01'], ['y', 'y (m)', '0.01'], ['z', 'z (m)', '0.01'], ['yawDeg', 'yaw (°)', '1']];
const farthestM = 1e5;

/** Without the last digits of binary fractions. */
const shortly = (value: number): string => String(Number(value.toFixed(6)));

interface ListRow { row: HTMLTableRowElement; id: HTMLButtonElement; cells: HTMLTableCellElement[] }

export class Panel {
  private shownSelection = '';
  private readonly issues: IssueList;
  private readonly coverageWords = el('p', { id: 'coverage-words' }, 'Counting from where a marker is seen');
  private readonly reason = el('p', { class: 'error', id: 'field-reason', role: 'alert' });
  private readonly rows = new Map<number, ListRow>();
  private listedKeys = '';
  private readonly listBody = el('tbody');
  private readonly listRest = el('p');
  private readonly gapWords = el('p', { id: 'gap-words' });

  constructor(private readonly editor: Editor, private readonly actions: PanelActions) {
    this.issues = new IssueList({
      show: (issue) => {
        editor.select([...editor.markers.values()].filter((m) => issue.ids.includes(m.id)).map((m) => m.key));
        actions.goTo(issue.places_m.map(([x, y]) => ({ x, y })));
      },
      letStand: (issue, reason) => actions.letStand(issue, reason),
    });
    byId('coverage').append(this.coverageWords, this.gapWords, el('div', { class: 'row' },
      button('Suggest next marker', 'Place a marker where it closes most of the gaps', () => actions.suggest()),
      button('Fill the gaps', 'Place as many markers as needed, by a greedy search (K)', () => actions.fill())));
    byId('filter').addEventListener('input', () => this.showList());
    const head = el('thead', {}, el('tr', {}, ...['ID', 'x (m)', 'y (m)', 'yaw (°)'].map((t) => el('th', { scope: 'col' }, t))));
    byId('list').replaceChildren(el('table', {}, head, this.listBody), this.listRest);
  }

  show(): void {
    this.showSelection();
    this.showList();
  }

  // -- selection ------------------------------------------------------------------------------------------

  showSelection(): void {
    const chosen = this.editor.chosen().map((m) => this.editor.preview.get(m.key) ?? m);
    const keys = chosen.map((m) => m.key).join();
    const box = byId('selection');
    if (keys === this.shownSelection && chosen.length === 1) return this.refreshFields(chosen[0]!);
    this.shownSelection = keys;
    if (chosen.length === 0) {
      box.replaceChildren(el('p', {}, this.editor.markers.size === 0
        ? 'There are no markers yet. Add places one at the centre of the view, Suggest next marker where it is needed most.'
        : 'Nothing. Click a marker; Shift+drag a box; press ? for all keys.'));
    } else if (chosen.length === 1) {
      box.replaceChildren(this.fieldsOf(chosen[0]!), el('div', { class: 'row' },
        button('Safest IDs', 'Free IDs, the safest first (I)', () => this.actions.pickId())), facesOf(chosen[0]!.id));
    } else {
      box.replaceChildren(el('p', {}, `${plural(chosen.length, 'marker')}. M moves and turns them by numbers, A copies them in an array, D distributes them evenly.`));
    }
  }

  private fieldsOf(marker: Marker): HTMLElement {
    const grid = el('div', { class: 'fields' });
    for (const [name, label, step] of fields) {
      const input = el('input', { id: `field-${name}`, type: 'number', step, value: shortly(marker[name]), 'aria-describedby': 'field-reason' });
      input.addEventListener('change', () => this.enter(marker.key, name, input));
      grid.append(el('label', { for: `field-${name}` }, label), input);
    }
    this.reason.textContent = '';
    return el('div', {}, grid, this.reason);
  }

  private refreshFields(marker: Marker): void {
    for (const [name] of fields) {
      const input = byId(`field-${name}`) as HTMLInputElement;
      input.value = shortly(marker[name]);
      input.removeAttribute('aria-invalid');
    }
    this.reason.textContent = '';
    const faces = document.querySelector('.faces');
    if (faces?.getAttribute('data-id') !== String(marker.id)) faces?.replaceWith(facesOf(marker.id));
  }

  private enter(key: number, name: FieldName, input: HTMLInputElement): void {
    const marker = this.editor.chosen().find((m) => m.key === key);
    const value = input.valueAsNumber;
    if (!marker) return;
    const wrong = whyNot(name, value);
    input.setAttribute('aria-invalid', String(wrong !== ''));
    this.reason.textContent = wrong === '' ? '' : `${wrong}; the marker keeps ${shortly(marker[name])}`;
    if (wrong !== '') return;
    this.editor.change([{ ...marker, [name]: name === 'yawDeg' ? wrapDeg(value) : value }]);
  }

  // -- coverage -------------------------------------------------------------------------------------------

  showCoverage(coverage: CountedCoverage): void {
    const { one, two } = coverage.shares();
    const percent = (share: number) => `${(100 * share).toFixed(1)} %`;
    this.coverageWords.textContent = `${percent(one)} of the floor where the robot can stand sees a marker, ${percent(two)} two or more, ` +
      'at every heading.';
  }

  // -- issues ---------------------------------------------------------------------------------------------

  showIssues(issues: Issue[]): void {
    const gaps = issues.filter((i) => i.kind === 'gap' && !i.accepted).length;
    this.gapWords.className = gaps === 0 ? 'fine' : 'warning';
    this.gapWords.textContent = gaps === 0 ? 'No gaps.' : `${plural(gaps, 'gap')} without any marker in view; short ones are bridged by odometry.`;
    this.issues.show(issues);
  }

  showUnchecked(why: string): void {
    this.gapWords.textContent = '';
    this.issues.showUnchecked(why);
  }

  // -- all markers ----------------------------------------------------------------------------------------

  private showList(): void {
    const filter = (byId('filter') as HTMLInputElement).value.trim();
    const all = [...this.editor.markers.values()].filter((m) => String(m.id).includes(filter)).sort((a, b) => a.id - b.id);
    const listed = all.slice(0, mostRows);
    for (const marker of listed) this.showRow(marker);
    this.listRest.textContent = all.length > mostRows ? `The first ${mostRows} of ${all.length}; filter to see others.` : '';
    const keys = listed.map((m) => m.key).join();
    if (keys === this.listedKeys) return;  // rows that stay where they are keep the focus, and a press under way
    this.listedKeys = keys;
    const focused = document.activeElement;
    this.listBody.replaceChildren(...listed.map((m) => this.rows.get(m.key)!.row));
    if (focused instanceof HTMLElement && this.listBody.contains(focused)) focused.focus({ preventScroll: true });
    for (const key of this.rows.keys()) if (!this.editor.markers.has(key)) this.rows.delete(key);
  }

  private showRow(marker: Marker): void {
    const m = this.editor.onMap(marker);
    let shown = this.rows.get(m.key);
    if (!shown) {
      const id = button('', 'Choose and show', () => {
        this.editor.select([m.key]);
        const now = this.editor.chosen()[0];
        if (now) this.actions.goTo([now]);
      });
      const cells = [el('td'), el('td'), el('td')];
      this.rows.set(m.key, shown = { row: el('tr', {}, el('td', {}, id), ...cells), id, cells });
    }
    shown.row.className = this.editor.selection.has(m.key) ? 'chosen' : '';
    [String(m.id), m.x.toFixed(3), m.y.toFixed(3), m.yawDeg.toFixed(1)].forEach((text, i) => {
      const cell = i === 0 ? shown!.id : shown!.cells[i - 1]!;
      if (cell.textContent !== text) cell.textContent = text;
    });
  }
}

/** What is wrong with a number for a field of a marker; nothing when it can be used. */
function whyNot(name: FieldName, value: number): string {
  if (name === 'id') return Number.isInteger(value) && value >= 0 && value < idCount ? '' : `IDs are whole numbers from 0 to ${idCount - 1}`;
  return Number.isFinite(value) && Math.abs(value) <= farthestM ? '' : `${name === 'yawDeg' ? 'yaw' : name} needs a number`;
}

/** The face as printed and as on the map, each labelled: they are mirror images. */
function facesOf(id: number): HTMLElement {
  const face = (fromAbove: boolean, words: string) => {
    const canvas = el('canvas', { width: '96', height: '96', role: 'img', 'aria-label': `Marker ${id} ${words}` });
    drawFace(canvas, id, fromAbove);
    return el('div', {}, canvas, words);
  };
  return el('div', { class: 'faces', 'data-id': String(id) },
    face(false, 'from below, as printed'), face(true, 'from above, as on the map'));
}
