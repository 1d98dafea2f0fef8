// The list of former runs: when, how each ended, how long it took and how far off the robot was at worst.
import type { RunFacts } from './api.js';
import { button, byId, el, plural } from './dom.js';
import { duration, shortTime } from './when.js';

const mostShown = 100;

/** How a run ended, in words. */
export function outcomeOf(run: RunFacts): string {
  if (run.goals === null) return run.why ?? 'no report: under way, or its program ended in the middle';
  const reached = run.goals === 0 ? 'no goals' : run.arrived === run.goals ? `reached ${plural(run.goals, 'goal')}` : `reached ${run.arrived} of ${plural(run.goals, 'goal')}`;
  return `${reached}${run.contacts ? `, ${plural(run.contacts, 'contact')}` : ''}${run.why ? `: ${run.why}` : ''}`;
}

/** How far off at worst: on a real robot nobody knows, only how far it thought it might be. */
export function worstOf(run: RunFacts): string {
  if (run.worst_error_mm !== null) return `${run.worst_error_mm.toFixed(1)} mm off at worst`;
  return run.worst_3_sigma_mm === null ? '' : `3σ ${run.worst_3_sigma_mm.toFixed(1)} mm at worst`;
}

export interface RunListActions { open(name: string): void; beside(name: string | null): void }

export class RunList {
  private runs: RunFacts[] = [];
  private opened = '';
  private second: string | null = null;
  private readonly filter = el('input', { type: 'search', id: 'run-filter', placeholder: 'Filter by name, site or date', 'aria-label': 'Filter the runs' });
  private readonly list = el('ul', { class: 'plain', id: 'run-list' });
  private readonly rest = el('p', { class: 'faint' });

  constructor(private readonly actions: RunListActions) {
    this.filter.addEventListener('input', () => this.refresh());
    byId('runs').append(this.filter, this.list, this.rest);
  }

  /** The newest last. */
  show(runs: RunFacts[]): void {
    this.runs = runs.toReversed();
    this.refresh();
  }

  mark(opened: string, second: string | null): void {
    [this.opened, this.second] = [opened, second];
    this.refresh();
  }

  private refresh(): void {
    const focused = document.activeElement?.id ?? '';
    const wanted = this.filter.value.trim().toLowerCase();
    const fitting = this.runs.filter((run) => `${run.name} ${run.site ?? ''} ${timeOf(run)} ${outcomeOf(run)}`.toLowerCase().includes(wanted));
    this.list.replaceChildren(...fitting.slice(0, mostShown).map((run, i) => this.row(run, i)));
    this.rest.textContent = fitting.length > mostShown ? `${fitting.length - mostShown} more: narrow them down` : fitting.length === 0 ? 'None.' : '';
    if (focused.startsWith('run-open-') || focused.startsWith('run-beside-')) document.getElementById(focused)?.focus();
  }

  private row(run: RunFacts, index: number): HTMLElement {
    const bad = run.goals === null || run.arrived !== run.goals || (run.contacts ?? 0) > 0;
    const figures = [run.duration_s === null ? '' : duration(run.duration_s), worstOf(run)].filter((words) => words !== '').join(', ');
    const open = button('', 'Open this run', () => this.actions.open(run.name), { id: `run-open-${index}`, ...(run.name === this.opened ? { class: 'chosen', 'aria-current': 'true' } : {}) });
    open.replaceChildren(el('strong', {}, run.name), ` ${timeOf(run)}`, el('br'), el('span', { class: bad ? 'error' : 'fine' }, outcomeOf(run)), ...(figures === '' ? [] : [el('br'), figures]));
    open.disabled = run.goals === null;
    const isSecond = run.name === this.second;
    const beside = button('Beside', isSecond ? 'No longer draw it beside the opened run' : 'Draw it beside the opened run', () => this.actions.beside(isSecond ? null : run.name),
      { id: `run-beside-${index}`, 'aria-pressed': String(isSecond), 'aria-label': `${run.name} beside the opened run` });
    beside.disabled = run.goals === null || run.name === this.opened;
    return el('li', { class: 'run' }, open, beside);
  }
}

const timeOf = (run: RunFacts): string => run.started ?? run.ended ? shortTime((run.started ?? run.ended)!) : '';
