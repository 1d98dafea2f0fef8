// Small plots over time, with the present values in words.
import uPlot from 'uplot';
import { el, positive } from './dom.js';
import { font } from './fonts.js';

export interface Line { label: string; unit: string; colour: string; digits: number; dash?: boolean }

const colourOf = (name: string): string => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

export class Plot {
  /** Called with the time that was clicked. */
  onPick: ((timeS: number) => void) | null = null;
  private plot: uPlot | null = null;
  private data: (number | null)[][];
  private readonly words = el('figcaption');
  private readonly box = el('div', { class: 'plot' });

  constructor(parent: HTMLElement, private readonly title: string, private readonly lines: Line[], private readonly heightPx = 100) {
    this.data = [[], ...lines.map(() => [])];
    parent.append(el('figure', {}, this.words, this.box));
    new ResizeObserver(() => this.fit()).observe(this.box);
    new MutationObserver(() => this.make()).observe(document.documentElement, { attributeFilter: ['data-theme'] });
    this.make();
  }

  /** Times, and for each line its values. */
  set(data: (number | null)[][]): void {
    this.data = data;
    this.plot?.setData(data);
  }

  /** Shows the values at a row, and marks its time. */
  tell(row: number, mark: boolean): void {
    const parts = this.lines.map((line, i) => {
      const value = this.data[i + 1]?.[row];
      const number = value === null || value === undefined ? '-' : `${positive(value.toFixed(line.digits))}${line.unit}`;
      return el('span', {}, el('i', { class: `ink ${line.colour.slice(2)}` }), `${line.label} ${number}`);
    });
    this.words.replaceChildren(el('strong', {}, this.title), ...parts);
    const time = this.data[0]?.[row];
    if (mark && this.plot && typeof time === 'number') this.plot.setCursor({ left: this.plot.valToPos(time, 'x'), top: 0 });
  }

  private make(): void {
    this.plot?.destroy();
    const axis = { stroke: colourOf('--faint'), grid: { stroke: colourOf('--line'), width: 1 }, ticks: { stroke: colourOf('--line'), width: 1 }, font: font(11) };
    this.plot = new uPlot({
      width: Math.max(50, this.box.clientWidth), height: this.heightPx, legend: { show: false }, padding: [6, 8, 0, 0],
      cursor: { y: false, drag: { x: false, y: false }, points: { show: false } },
      scales: { x: { time: false }, y: { range: (_, low, high) => [Math.min(0, low), high > 0 ? high * 1.08 : 1] } },
      axes: [{ ...axis, size: 30, gap: 2, space: 50 }, { ...axis, size: 40, space: 26 }],
      series: [{}, ...this.lines.map((line) => ({ stroke: colourOf(line.colour), width: 1.5, points: { show: false }, ...(line.dash ? { dash: [4, 3] } : {}) }))],
    }, this.data, this.box);
    this.plot.over.addEventListener('click', (e) => { if (this.plot) this.onPick?.(this.plot.posToVal(e.offsetX, 'x')); });
  }

  private fit(): void {
    if (this.box.clientWidth > 50) this.plot?.setSize({ width: this.box.clientWidth, height: this.heightPx });
  }
}

/** Three plots: uncertainty and error of the position, speed, markers in view. */
export class DrivePlots {
  private readonly plots: Plot[];

  constructor(parent: HTMLElement, onPick: ((timeS: number) => void) | null = null) {
    this.plots = [
      new Plot(parent, 'Position', [{ label: '3σ', unit: ' mm', colour: '--line-a', digits: 1 }, { label: 'error', unit: ' mm', colour: '--line-b', digits: 1 }]),
      new Plot(parent, 'Speed', [{ label: 'commanded', unit: ' m/s', colour: '--line-a', digits: 2, dash: true }, { label: 'driven', unit: ' m/s', colour: '--line-b', digits: 2 }]),
      new Plot(parent, 'Markers', [{ label: 'confidence', unit: '', colour: '--line-a', digits: 2 }, { label: 'in view', unit: '', colour: '--line-b', digits: 0 }]),
    ];
    for (const plot of this.plots) plot.onPick = onPick;
  }

  /** Rows of time, 3 sigma (mm), error (mm), commanded, driven (m/s), confidence, markers. */
  set(columns: (number | null)[][]): void {
    this.plots.forEach((plot, i) => plot.set([columns[0]!, columns[1 + 2 * i]!, columns[2 + 2 * i]!]));
  }

  tell(row: number, mark = false): void {
    for (const plot of this.plots) plot.tell(row, mark);
  }
}
