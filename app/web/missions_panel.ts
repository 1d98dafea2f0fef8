// Missions: places in driving order, with how long the robot waits there and what it has done there, and how often all of it.
import { button, byId, el } from './dom.js';
import { isSpot, missionOf, missionWords } from './places_doc.js';
import type { MissionItem, PlacesEditor, Spot, Stop } from './places_doc.js';

const longestWaitS = 86_400, mostGoals = 500, longestName = 80;

export class MissionsPanel {
  private opened: number | null = null;
  private shownFor = '';
  private readonly reason = el('p', { class: 'error', id: 'mission-reason', role: 'alert' });

  /** `actions`: that the site has programs for. */
  constructor(private readonly editor: PlacesEditor, private readonly actions: string[]) {}

  show(): void {
    const places = this.places();
    const key = JSON.stringify([this.editor.state.missions, places.map((p) => [p.key, p.name]), this.opened]);
    if (key === this.shownFor) return;
    this.shownFor = key;
    const focused = document.activeElement?.id ?? '';
    const mission = this.editor.state.missions.find((m) => m.key === this.opened);
    const add = button('New mission', 'Over all places, to be changed', () => this.add(), { id: 'mission-new' });
    add.disabled = places.length === 0;
    this.reason.textContent = '';
    byId('place-missions').replaceChildren(
      ...(this.editor.state.missions.length === 0 ? [el('p', { class: 'faint' }, places.length === 0 ? 'A mission goes over places: draw some first.' : 'None yet.')] : []),
      el('ul', { class: 'plain' }, ...this.editor.state.missions.map((m) => el('li', {}, button(`${m.name}: ${this.words(m)}`, 'Change it', () => this.open(m.key === this.opened ? null : m.key),
        { id: `mission-${m.key}`, 'aria-expanded': String(m.key === this.opened), ...(m.key === this.opened ? { class: 'chosen' } : {}) })))),
      ...(mission ? [this.formOf(mission), this.reason] : []), el('div', { class: 'row' }, add));
    if (focused !== '' && byId('place-missions').querySelector(`#${focused}`)) byId(focused).focus();
  }

  private places(): Spot[] { return this.editor.state.items.filter(isSpot).filter((s) => s.kind === 'place'); }
  private words(mission: MissionItem): string { return missionWords(missionOf(mission, new Map(this.places().map((p) => [p.key, p.name])))); }

  private open(key: number | null): void {
    this.opened = key;
    this.show();
  }

  private add(): void {
    const names = new Set(this.editor.state.missions.map((m) => m.name));
    let n = 1;
    while (names.has(`Mission ${n}`)) ++n;
    const mission: MissionItem = { key: this.editor.key(), name: `Mission ${n}`, repeat: 1, stops: this.places().slice(0, mostGoals).map((p) => ({ place: p.key, waitS: 0, action: '' })) };
    this.opened = mission.key;
    this.editor.setMission(mission);
    byId('mission-name').focus();
  }

  private now(key: number): MissionItem { return this.editor.state.missions.find((m) => m.key === key)!; }
  private put(key: number, changed: Partial<MissionItem>): void { this.editor.setMission({ ...this.now(key), ...changed }); }
  private putStop(key: number, index: number, changed: Partial<Stop>): void {
    const { stops } = this.now(key);
    this.put(key, { stops: stops.with(index, { ...stops[index]!, ...changed }) });
  }

  /** A value that cannot be used stays in its field, with the reason. */
  private field(id: string, label: string, value: string, enter: (text: string) => string, attributes: Record<string, string> = {}): HTMLInputElement {
    const input = el('input', { id, value, 'aria-label': label, 'aria-describedby': 'mission-reason', autocomplete: 'off', ...attributes });
    input.addEventListener('change', () => {
      const wrong = enter(input.value.trim());
      this.reason.textContent = wrong === '' ? '' : `${wrong}; it keeps what it had`;
      if (wrong === '') input.removeAttribute('aria-invalid');
      else input.setAttribute('aria-invalid', 'true');
    });
    return input;
  }

  private formOf(mission: MissionItem): HTMLElement {
    const { key } = mission;
    const name = this.field('mission-name', 'Name', mission.name, (text) => {
      if (text === '' || new TextEncoder().encode(text).length > longestName) return `A name has 1 to ${longestName} bytes`;
      if (this.editor.state.missions.some((m) => m.key !== key && m.name === text)) return `'${text}' is taken`;
      this.put(key, { name: text });
      return '';
    });
    const repeat = this.field('mission-repeat', 'How often', String(mission.repeat), (text) => {
      const n = Number(text), most = Math.floor(mostGoals / this.now(key).stops.length);
      if (!Number.isInteger(n) || n < 1 || n > most) return `It can be driven 1 to ${most} times`;
      this.put(key, { repeat: n });
      return '';
    }, { inputmode: 'numeric' });
    const rows = mission.stops.map((stop, i) => this.rowOf(mission, stop, i));
    const add = button('Add a stop', 'Behind the last one', () => this.put(key, { stops: [...this.now(key).stops, { place: this.places()[0]!.key, waitS: 0, action: '' }] }), { id: 'mission-add-stop' });
    add.disabled = mission.stops.length * mission.repeat + mission.repeat > mostGoals;
    return el('div', { class: 'mission' }, el('div', { class: 'fields wide' }, el('label', { for: 'mission-name' }, 'Name'), name, el('label', { for: 'mission-repeat' }, 'How often'), repeat),
      el('table', {}, el('thead', {}, el('tr', {}, ...['Place', 'Wait (s)', ...(this.hasActions(mission) ? ['Action'] : [])].map((t) => el('th', { scope: 'col' }, t)), el('td'))), el('tbody', {}, ...rows)),
      el('div', { class: 'row' }, add, button('Delete', 'Delete this mission; undo brings it back', () => this.editor.removeMission(key), { id: 'mission-delete' })));
  }

  private hasActions(mission: MissionItem): boolean { return this.actions.length > 0 || mission.stops.some((stop) => stop.action !== ''); }

  private choice(id: string, label: string, options: [string, string][], value: string, enter: (value: string) => void): HTMLSelectElement {
    const select = el('select', { id, 'aria-label': label }, ...options.map(([v, words]) => el('option', { value: v }, words)));
    select.value = value;
    select.addEventListener('change', () => enter(select.value));
    return select;
  }

  private rowOf(mission: MissionItem, stop: Stop, i: number): HTMLElement {
    const { key } = mission;
    const nth = `Stop ${i + 1}`;
    const place = this.choice(`mission-place-${i}`, `${nth}, place`, this.places().map((p) => [String(p.key), p.name]), String(stop.place), (v) => this.putStop(key, i, { place: Number(v) }));
    const wait = this.field(`mission-wait-${i}`, `${nth}, seconds to wait`, String(stop.waitS), (text) => {
      const n = Number(text);
      if (text === '' || !(n >= 0 && n <= longestWaitS)) return `A wait is 0 to ${longestWaitS} seconds`;
      this.putStop(key, i, { waitS: n });
      return '';
    }, { inputmode: 'decimal' });
    const known = [...new Set([...this.actions, ...(stop.action === '' ? [] : [stop.action])])];
    const action = this.choice(`mission-action-${i}`, `${nth}, action`, [['', 'none'], ...known.map((a): [string, string] => [a, a])], stop.action, (v) => this.putStop(key, i, { action: v }));
    const up = button('↑', `${nth}: earlier`, () => this.put(key, { stops: this.now(key).stops.toSpliced(i, 1).toSpliced(i - 1, 0, stop) }), { id: `mission-up-${i}`, 'aria-label': `${nth}: earlier` });
    up.disabled = i === 0;
    const remove = button('×', `${nth}: remove`, () => this.put(key, { stops: this.now(key).stops.toSpliced(i, 1) }), { id: `mission-remove-${i}`, 'aria-label': `${nth}: remove` });
    remove.disabled = mission.stops.length === 1;
    return el('tr', {}, el('td', {}, place), el('td', {}, wait), ...(this.hasActions(mission) ? [el('td', {}, action)] : []), el('td', {}, up, remove));
  }
}
