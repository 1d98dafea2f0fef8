// The server's findings on the registry: narrowed down to a kind, the errors first, and those that somebody lets stand apart.
import type { Issue } from './api.js';
import { ask, button, byId, el, plural } from './dom.js';

const mostIssues = 60;

export interface IssueActions {
  show(issue: Issue): void;
  /** With a reason it may stand; with none it is a warning again. */
  letStand(issue: Issue, reason: string): void;
}

const listOf = (items: HTMLElement[]): HTMLElement => el('ul', { class: 'plain' }, ...items.map((item) => el('li', {}, item)));

export class IssueList {
  private issues: Issue[] = [];
  private kind = '';  // of the issues listed; '' for all
  private isOpen = false;  // the list of those that may stand

  constructor(private readonly actions: IssueActions) {}

  showUnchecked(why: string): void { byId('issues').replaceChildren(el('p', {}, why)); }

  show(issues: Issue[]): void {
    this.issues = [...issues.filter((i) => i.severity === 'error'), ...issues.filter((i) => i.severity !== 'error')];
    const open = this.issues.filter((i) => !i.accepted);
    const standing = this.issues.filter((i) => i.accepted);
    const errors = open.filter((i) => i.severity === 'error').length;
    const counts = new Map<string, number>();
    for (const { kind } of open) counts.set(kind, (counts.get(kind) ?? 0) + 1);
    if (!counts.has(this.kind)) this.kind = '';
    const fitting = open.filter((i) => this.kind === '' || i.kind === this.kind);
    byId('issues').replaceChildren(
      open.length === 0 ? el('p', { class: 'fine' }, standing.length === 0 ? 'None found.' : 'None but those that may stand.') :
        el('p', {}, `${plural(errors, 'error')}, ${plural(open.length - errors, 'warning')}`),
      ...(counts.size > 1 ? [this.choiceOf(counts, open.length)] : []), listOf(fitting.slice(0, mostIssues).map((issue) => this.row(issue))),
      ...(fitting.length > mostIssues ? [el('p', { class: 'faint' }, `and ${fitting.length - mostIssues} more`)] : []),
      ...(standing.length > 0 ? [this.listOfStanding(standing)] : []));
  }

  private choiceOf(counts: Map<string, number>, all: number): HTMLElement {
    const choice = el('select', { id: 'issue-kind', 'aria-label': 'Kind of issue' }, el('option', { value: '' }, `all kinds (${all})`),
      ...[...counts].sort().map(([kind, count]) => el('option', { value: kind }, `${kind.replaceAll('-', ' ')} (${count})`)));
    choice.value = this.kind;
    choice.addEventListener('change', () => {
      this.kind = choice.value;
      this.show(this.issues);
      byId('issue-kind').focus();
    });
    return choice;
  }

  private toPlace(issue: Issue): HTMLElement {
    return button(issue.words, 'Show on the map', () => this.actions.show(issue), { class: issue.accepted ? 'faint' : issue.severity, 'data-kind': issue.kind });
  }

  private row(issue: Issue): HTMLElement {
    if (issue.severity === 'error') return this.toPlace(issue);
    return el('div', { class: 'issue' }, this.toPlace(issue), button('May stand…', 'Take it off the list, with a reason', () => { void this.askWhy(issue); }, { class: 'quiet' }));
  }

  private listOfStanding(standing: Issue[]): HTMLElement {
    const details = el('details', { id: 'standing-issues' }, el('summary', {}, `${standing.length} may stand`), listOf(standing.map((issue) => {
      const { reason, by, at } = issue.accepted!;
      return el('div', { class: 'issue' }, this.toPlace(issue), button('Warn again', 'Put it back on the list', () => this.actions.letStand(issue, ''), { class: 'quiet' }),
        el('p', { class: 'faint' }, `“${reason}”, ${by === '' ? '' : `${by}, `}${at.slice(0, 10)}`));
    })));
    details.open = this.isOpen;
    details.addEventListener('toggle', () => { this.isOpen = details.open; });
    return details;
  }

  private async askWhy(issue: Issue): Promise<void> {
    const why = el('input', { type: 'text', id: 'why', maxlength: '200', required: '', autocomplete: 'off' });
    const answer = await ask('May this warning stand?', [
      el('p', {}, issue.words),
      el('div', { class: 'fields wide' }, el('label', { for: 'why' }, 'Because'), why),
      el('p', { class: 'faint' }, issue.ids.length > 0 ? 'It comes back when it concerns other markers.' : 'It comes back when it grows by half a metre or moves.')],
    [['stand', 'Let it stand'], ['', 'Cancel']], () => (why.value.trim() === '' ? 'Say why: whoever comes next will ask.' : ''));
    if (answer === 'stand') this.actions.letStand(issue, why.value.trim());
  }
}
