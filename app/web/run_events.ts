// What happened during a run, at its times: why it waited, what it doubted, what it reached.
import type { Run } from './api.js';
import { button, byId, el } from './dom.js';

export interface RunEvent { time: number; words: string; kind: 'bad' | 'doubt' | 'good' | '' }

const momentS = 2.0;  // of being well between twice the same
const burstS = 1.0;  // refused fixes that are not further apart are one event
const mostShown = 200;

interface Notice { at_s: number; words: string; stops: boolean }
interface Facts {
  goals?: { x_m: number; y_m: number; arrived: boolean; failure: string; ended_s?: number }[];
  notices?: Notice[];
  faults?: { fault: string; begin_s: number; end_s: number | null; marker: number | null }[];
}

export function eventsOf(run: Run): RunEvent[] {
  const facts = run.summary as Facts;
  const events: RunEvent[] = [...refusals(run.fixes)];
  for (const goal of facts.goals ?? []) {
    const place = `${goal.x_m.toFixed(2)}, ${goal.y_m.toFixed(2)} m`;
    if (goal.ended_s !== undefined && goal.arrived) events.push({ time: goal.ended_s, words: `reached ${place}`, kind: 'good' });
    else if (goal.ended_s !== undefined && goal.failure !== '') events.push({ time: goal.ended_s, words: `gave ${place} up: ${goal.failure}`, kind: 'bad' });
  }
  for (const notice of steadied(facts.notices ?? [])) {
    events.push({ time: notice.at_s, words: notice.words === '' ? 'all is well again' : `${notice.stops ? 'must not move: ' : ''}${notice.words}`, kind: notice.words === '' ? '' : notice.stops ? 'bad' : 'doubt' });
  }
  for (const fault of facts.faults ?? []) {
    const where = fault.marker === null ? '' : ` of marker ${fault.marker}`;
    events.push({ time: fault.begin_s, words: `simulated fault: ${fault.fault}${where}`, kind: 'doubt' });
    if (fault.end_s !== null) events.push({ time: fault.end_s, words: `end of ${fault.fault}${where}`, kind: '' });
  }
  return events.sort((a, b) => a.time - b.time);
}

/** Without what comes and goes within a moment: a person at the edge of the field, who sways. */
function steadied(notices: Notice[]): Notice[] {
  const kept: Notice[] = [];
  for (const notice of notices) {
    const last = kept.at(-1), before = kept.at(-2);
    if (last && last.words === '' && notice.at_s - last.at_s <= momentS && before?.words === notice.words) kept.pop();
    else if (last?.words !== notice.words) kept.push(notice);
  }
  return kept;
}

/** Rows of fixes.csv: stamp, x, y, yaw, confidence, accepted, IDs. */
function refusals(fixes: number[][]): RunEvent[] {
  const bursts: { begin: number; end: number; count: number; ids: Set<number> }[] = [];
  for (const [time, , , , , accepted, ...ids] of fixes) {
    if (accepted !== 0) continue;
    const last = bursts.at(-1);
    if (last && time! - last.end <= burstS) {
      [last.end, last.count] = [time!, last.count + 1];
      for (const id of ids) last.ids.add(id);
    } else bursts.push({ begin: time!, end: time!, count: 1, ids: new Set(ids) });
  }
  return bursts.map(({ begin, count, ids }) => ({ time: begin, words: `doubted ${count === 1 ? 'a fix' : `${count} fixes`} by ${[...ids].join(', ')}`, kind: 'doubt' as const }));
}

const classOf = { bad: 'error', doubt: 'warning', good: 'fine', '': '' } as const;

/** As buttons that go to their times; the newest that is past is marked by mark(). */
export class RunEvents {
  private events: RunEvent[] = [];
  private rows: HTMLButtonElement[] = [];

  constructor(private readonly goTo: (time: number) => void) {}

  show(run: Run, start: number): void {
    this.events = eventsOf(run).slice(0, mostShown);
    this.rows = this.events.map((event) => {
      const row = button('', 'Go to this time', () => this.goTo(event.time));
      row.append(el('time', {}, `${(event.time - start).toFixed(1)} s `), el('span', { class: classOf[event.kind] }, event.words));
      return row;
    });
    byId('run-events').replaceChildren(this.rows.length === 0 ? el('p', { class: 'faint' }, 'Nothing out of the ordinary.') : el('ul', { class: 'plain' }, ...this.rows.map((row) => el('li', {}, row))));
  }

  mark(time: number): void {
    const now = this.events.findLastIndex((event) => event.time <= time + 1e-3);
    this.rows.forEach((row, i) => row.classList.toggle('chosen', i === now));
  }
}
