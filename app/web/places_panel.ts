// The panel beside the map for zones, lanes and places: what is selected as fields with reasons, findings, and a list.
import type { PlacesIssue } from './api.js';
import { button, byId, el, plural } from './dom.js';
import { tidy, wrapDeg } from './geometry.js';
import type { Point } from './geometry.js';
import { isLane, isSpot, isZone, kindWords } from './places_doc.js';
import type { Item, Kind, Lane, PlacesEditor, Spot, Zone } from './places_doc.js';

const farthestM = 1e5, slowestMps = 0.02, fastestMps = 5, longestName = 80, fewestCorners = 3;
const mostListed = 300;

export interface PlacesActions { add(kind: Kind): void; goTo(points: Point[]): void; remove(): void }
interface Field { id: string; label: string; value: string; enter: (text: string) => string }

const shortly = (value: number): string => String(tidy(value));

export class PlacesPanel {
  private shownFor = '';
  private listed = '';
  private readonly reason = el('p', { class: 'error', id: 'place-reason', role: 'alert' });

  constructor(private readonly editor: PlacesEditor, private readonly actions: PlacesActions) {
    byId('place-new').append(...(['keep_out', 'speed_zone', 'place', 'node', 'edge'] as const).map((kind) =>
      button(kindWords[kind], `Add at the middle of the view, to be placed by numbers`, () => this.add(kind), { id: `new-${kind}` })));
  }

  private add(kind: Kind): void {
    this.actions.add(kind);
    const first = byId('place-selection').querySelector<HTMLElement>('input, select');
    first?.focus();
    if (first instanceof HTMLInputElement) first.select();
  }

  show(): void {
    this.showSelection();
    this.showList();
  }

  // -- the selected item --------------------------------------------------------------------------------------

  private showSelection(): void {
    const item = this.editor.chosen;
    const shape = item ? `${item.key} ${isZone(item) ? `${item.corners.length} ${this.editor.corner ?? ''}` : ''} ${isLane(item) ? this.spotNames() : ''}` : '';
    const box = byId('place-selection');
    if (shape === this.shownFor && item) return this.refresh(item);
    this.shownFor = shape;
    const focused = document.activeElement?.id ?? '';
    this.reason.textContent = '';
    if (!item) return box.replaceChildren(el('p', {}, this.editor.state.items.length === 0
      ? 'Nothing is drawn yet. Choose Keep-out above and click its corners on the map.' : 'Nothing. Click a zone, a lane or a place on the map or in the list.'));
    box.replaceChildren(el('p', { class: 'faint' }, kindWords[item.kind]), ...this.formOf(item), this.reason,
      el('div', { class: 'row' }, ...this.buttonsOf(item), button('Delete', 'Delete it (Delete)', () => this.actions.remove(), { id: 'place-delete' })));
    if (focused !== '' && box.querySelector(`#${focused}`)) byId(focused).focus();
  }

  private spotNames(): string { return this.editor.state.items.filter(isSpot).map((s) => s.name).join('\n'); }

  private refresh(item: Item): void {
    for (const field of this.fieldsOf(item)) {
      const input = byId(field.id) as HTMLInputElement;
      if (input.getAttribute('aria-invalid') === 'true' && document.activeElement === input) continue;
      input.value = field.value;
      input.removeAttribute('aria-invalid');
    }
    if (isLane(item)) {
      (byId('place-one-way') as HTMLInputElement).checked = item.oneWay;
      for (const end of ['from', 'to'] as const) (byId(`place-${end}`) as HTMLSelectElement).value = String(item[end]);
    }
    if (!byId('place-selection').querySelector('[aria-invalid="true"]')) this.reason.textContent = '';
  }

  private formOf(item: Item): HTMLElement[] {
    const fields = this.fieldsOf(item);
    const ofCorners = fields.filter((f) => f.id.startsWith('corner-'));
    const form: HTMLElement[] = [el('div', { class: 'fields wide' }, ...(isLane(item) ? this.laneFields(item) : []),
      ...fields.filter((f) => !ofCorners.includes(f)).flatMap((f) => [el('label', { for: f.id }, f.label), this.input(f)]))];
    if (isZone(item)) form.push(this.cornersOf(item, ofCorners));
    return form;
  }

  private input(field: Field): HTMLInputElement {
    const input = el('input', { id: field.id, value: field.value, 'aria-describedby': 'place-reason', autocomplete: 'off', ...(field.id === 'place-name' ? {} : { inputmode: 'decimal' }) });
    input.addEventListener('change', () => {
      const wrong = field.enter(input.value.trim());
      this.reason.textContent = wrong === '' ? '' : `${wrong}; it keeps what it had`;
      if (wrong === '') input.removeAttribute('aria-invalid');
      else input.setAttribute('aria-invalid', 'true');
    });
    return input;
  }

  private cornersOf(zone: Zone, fields: Field[]): HTMLElement {
    const rows = zone.corners.map((_, i) => {
      const [x, y] = fields.slice(2 * i, 2 * i + 2).map((f) => { const made = this.input(f); made.setAttribute('aria-label', f.label); made.addEventListener('focus', () => { this.editor.corner = i; }); return el('td', {}, made); });
      const insert = button('+', `Add a corner after corner ${i + 1}`, () => this.insertAfter(i), { 'aria-label': `Add a corner after corner ${i + 1}`, id: `corner-add-${i}` });
      const remove = button('×', `Delete corner ${i + 1}`, () => this.removeCorner(i), { 'aria-label': `Delete corner ${i + 1}`, id: `corner-delete-${i}` });
      remove.disabled = zone.corners.length <= fewestCorners;
      return el('tr', i === this.editor.corner ? { class: 'chosen' } : {}, el('td', {}, String(i + 1)), x!, y!, el('td', {}, insert, remove));
    });
    return el('table', { class: 'corners' }, el('thead', {}, el('tr', {}, ...['Corner', 'x (m)', 'y (m)', ''].map((t) => t === '' ? el('td') : el('th', { scope: 'col' }, t)))), el('tbody', {}, ...rows));
  }

  private fresh<T extends Item>(item: T): T { return this.editor.find(item.key) as T; }

  private insertAfter(index: number): void {
    const zone = this.editor.chosen as Zone;
    const a = zone.corners[index]!, b = zone.corners[(index + 1) % zone.corners.length]!;
    this.editor.change({ ...zone, corners: zone.corners.toSpliced(index + 1, 0, { x: tidy((a.x + b.x) / 2), y: tidy((a.y + b.y) / 2) }) });
  }

  removeCorner(index: number): void {
    const zone = this.editor.chosen as Zone;
    this.editor.corner = null;
    this.editor.change({ ...zone, corners: zone.corners.toSpliced(index, 1) });
  }

  private fieldsOf(item: Item): Field[] {
    const put = (changed: Partial<Spot> & Partial<Zone> & Partial<Lane>) => this.editor.change({ ...this.fresh(item), ...changed } as Item);
    const number = (id: string, label: string, value: number, set: (value: number) => void): Field => ({ id, label, value: shortly(value),
      enter: (text) => { const n = Number(text); if (text === '' || !Number.isFinite(n) || Math.abs(n) > farthestM) return `${label} needs a number of metres`; set(n); return ''; } });
    const speed: Field = { id: 'place-speed', label: item.kind === 'edge' ? 'Greatest speed (m/s), empty: the robot\'s own' : 'Greatest speed (m/s)', value: isSpot(item) || item.maxMps === null ? '' : shortly(item.maxMps), enter: (text) => {
      if (text === '' && item.kind === 'edge') { put({ maxMps: null }); return ''; }
      const n = Number(text);
      if (text === '' || !(n >= slowestMps && n <= fastestMps)) return `The speed must be from ${slowestMps} to ${fastestMps} m/s`;
      put({ maxMps: n });
      return '';
    } };
    if (isLane(item)) return [speed];
    const name: Field = { id: 'place-name', label: 'Name', value: item.name, enter: (text) => {
      const wrong = this.whyNotName(item, text);
      if (wrong === '') put({ name: text });
      return wrong;
    } };
    if (isZone(item)) return [name, ...(item.kind === 'speed_zone' ? [speed] : []), ...item.corners.flatMap((p, i) => (['x', 'y'] as const).map((axis) =>
      number(`corner-${axis}-${i}`, `Corner ${i + 1}, ${axis}`, p[axis], (value) => { const zone = this.fresh(item); put({ corners: zone.corners.with(i, { ...zone.corners[i]!, [axis]: value }) }); })))];
    const heading: Field = { id: 'place-heading', label: 'Heading (°), empty: any', value: item.yawDeg === null ? '' : shortly(item.yawDeg), enter: (text) => {
      if (text !== '' && !(Math.abs(Number(text)) <= 360)) return 'The heading must be from -360 to 360°, or empty';
      put({ yawDeg: text === '' ? null : wrapDeg(Number(text)) });
      return '';
    } };
    return [name, number('place-x', 'x (m)', item.x, (x) => put({ x })), number('place-y', 'y (m)', item.y, (y) => put({ y })), ...(item.kind === 'place' ? [heading] : [])];
  }

  /** By the rules of places.yaml. */
  private whyNotName(item: Spot | Zone, text: string): string {
    if (text === '' && isSpot(item)) return 'It needs a name: lanes and routes refer to it';
    if (new TextEncoder().encode(text).length > longestName) return `A name has at most ${longestName} bytes`;
    if (/^[0-9.,+\-eE]*,[0-9.,+\-eE]*$/.test(text)) return 'A name must not read like a pair of numbers';
    const rivals = this.editor.state.items.filter((other) => other.key !== item.key && !isLane(other) && (isSpot(item) ? isSpot(other) : other.kind === item.kind));
    return text !== '' && rivals.some((other) => (other as Spot | Zone).name === text) ? `'${text}' is taken` : '';
  }

  private laneFields(lane: Lane): HTMLElement[] {
    const spots = this.editor.state.items.filter(isSpot);
    const end = (which: 'from' | 'to', label: string) => {
      const select = el('select', { id: `place-${which}`, 'aria-describedby': 'place-reason' }, ...spots.map((s) => el('option', { value: String(s.key) }, s.name)));
      select.value = String(lane[which]);
      select.addEventListener('change', () => {
        const changed = { ...this.fresh(lane), [which]: Number(select.value) };
        const isSame = changed.from === changed.to;
        this.reason.textContent = isSame ? 'A lane needs two different ends; it keeps what it had' : '';
        if (isSame) select.value = String(this.fresh(lane)[which]);
        else this.editor.change(changed);
      });
      return [el('label', { for: `place-${which}` }, label), select];
    };
    const box = el('input', { type: 'checkbox', id: 'place-one-way' });
    box.checked = lane.oneWay;
    box.addEventListener('change', () => this.editor.change({ ...this.fresh(lane), oneWay: box.checked }));
    return [...end('from', 'From'), ...end('to', 'To'), el('label', { for: 'place-one-way' }, 'One way, along the arrow'), box];
  }

  private buttonsOf(item: Item): HTMLElement[] {
    if (isLane(item)) return [button('Turn round', 'Exchange both ends', () => { const lane = this.fresh(item); this.editor.change({ ...lane, from: lane.to, to: lane.from }); }, { id: 'place-turn' })];
    return [];
  }

  // -- findings -----------------------------------------------------------------------------------------------

  showIssues(issues: PlacesIssue[]): void {
    byId('place-issues').replaceChildren(issues.length === 0 ? el('p', { class: 'fine' }, 'None found: every place can be reached, every lane driven.') : el('p', {}, plural(issues.length, 'finding')),
      el('ul', { class: 'plain' }, ...issues.map((issue) => el('li', {}, button(issue.words, 'Show on the map', () => this.actions.goTo(issue.positions_m.map(([x, y]) => ({ x, y }))),
        { class: issue.severity, 'data-kind': issue.kind })))));
  }

  /** What keeps the draft from being saved, and the item to blame. */
  showRefusal(words: string, item: Item | undefined): void {
    const text = item ? `${this.editor.titleOf(item)}: ${words}` : words;
    byId('place-issues').replaceChildren(el('p', { class: 'error' }, 'It cannot be saved like this:'), el('ul', { class: 'plain' }, el('li', {}, button(text, 'Select it', () => this.choose(item), { class: 'error', 'data-kind': 'refused' }))));
  }

  showChecking(words: string): void { byId('place-issues').replaceChildren(el('p', {}, words)); }

  private choose(item: Item | undefined): void { if (item) this.editor.select(item.key); }

  // -- all of them --------------------------------------------------------------------------------------------

  private showList(): void {
    const rows = this.editor.state.items.slice(0, mostListed).map((item) => ({ key: item.key, text: `${kindWords[item.kind]}: ${this.editor.titleOf(item)}` }));
    const shape = JSON.stringify(rows);
    if (shape !== this.listed) {
      this.listed = shape;
      const focused = document.activeElement?.id ?? '';
      byId('place-list').replaceChildren(el('ul', { class: 'plain' }, ...rows.map(({ key, text }) => el('li', {}, button(text, 'Select and show', () => this.showItem(key), { id: `place-row-${key}` })))),
        ...(this.editor.state.items.length > mostListed ? [el('p', {}, `The first ${mostListed} of ${this.editor.state.items.length}.`)] : []));
      if (focused.startsWith('place-row-')) document.getElementById(focused)?.focus({ preventScroll: true });
    }
    for (const { key } of rows) byId(`place-row-${key}`).classList.toggle('chosen', key === this.editor.selected);
  }

  private showItem(key: number): void {
    this.editor.select(key);
    const item = this.editor.find(key);
    const spots = item && isLane(item) ? [this.editor.spot(item.from), this.editor.spot(item.to)].filter((s) => s !== undefined) : [];
    if (item) this.actions.goTo(isZone(item) ? item.corners : isSpot(item) ? [item] : spots);
  }
}
