// Drives whose scans can become the map of a new site, to be chosen.
import * as api from './api.js';
import { button, el } from './dom.js';
import { duration, shortTime } from './when.js';
import { attempt } from './words.js';

export class NewSiteRuns {
  readonly element = el('div', { hidden: '' });
  private readonly list = el('ul', { class: 'plain', id: 'new-runs' });
  private readonly go: HTMLButtonElement;

  constructor(choose: (names: string[]) => void) {
    this.go = button('Map of these drives', 'Walls where the scanner saw them', () => choose(this.chosen()), { id: 'new-map-of-runs' });
    this.go.disabled = true;
    this.element.append(el('p', {}, 'From driving under markers, with a scanner: drives of one place, which may complete each other.'), this.list, el('div', { class: 'row' }, this.go));
    this.element.addEventListener('change', () => { this.go.disabled = this.chosen().length === 0; });
    attempt(() => this.fill());
  }

  private chosen(): string[] { return [...this.list.querySelectorAll('input')].filter((box) => box.checked).map((box) => box.value); }

  private async fill(): Promise<void> {
    const runs = await api.getScannedRuns();
    this.list.replaceChildren(...runs.map(({ name, started, site, duration_s }, i) => {
      const box = el('input', { type: 'checkbox', id: `new-run-${i}`, value: name });
      const facts = [started === null ? '' : shortTime(started), site ?? '', duration_s === null ? '' : duration(duration_s)].filter((words) => words !== '');
      return el('li', {}, el('label', { for: box.id }, box, ` ${name}`), el('span', { class: 'faint' }, facts.length > 0 ? ` ${facts.join(', ')}` : ''));
    }));
    this.element.hidden = runs.length === 0;
  }
}
