// Where runs of this site go badly, as colours on the floor, and the worst places with what can be done about each.
import { getHeat } from './api.js';
import type { Heat, HeatSquare } from './api.js';
import { button, byId, el, plural } from './dom.js';
import type { Point } from './geometry.js';
import type { Stage } from './stage.js';

type Kind = 'none' | 'sigma' | 'error' | 'blind' | 'waiting';
interface Measure { label: string; column: number; unit: string; digits: number; least: number }

/** `least`: what is smaller is nothing to worry about, and is not among the worst places. */
const measures: Record<Exclude<Kind, 'none'>, Measure> = {
  sigma: { label: 'how unsure it was (3σ)', column: 2, unit: 'mm', digits: 1, least: 10 },
  error: { label: 'how far off it was (simulation)', column: 3, unit: 'mm', digits: 1, least: 5 },
  blind: { label: 'time without a marker', column: 4, unit: 's', digits: 1, least: 0.5 },
  waiting: { label: 'time of waiting', column: 5, unit: 's', digits: 1, least: 0.5 },
};
// From light to dark, so that it is an order without colours too.
const scale = [[255, 237, 160], [254, 178, 76], [240, 59, 32], [128, 0, 38]];
const mostWorst = 5, apartM = 1.0;

/** The colour of a share from 0 to 1. */
function colourAt(share: number): string {
  const at = Math.min(1, Math.max(0, share)) * (scale.length - 1);
  const low = scale[Math.floor(at)]!, high = scale[Math.ceil(at)]!;
  return `rgb(${low.map((c, i) => Math.round(c + (at - Math.floor(at)) * (high[i]! - c))).join(' ')})`;
}

/** The worst squares, none nearer than a metre to a worse one. */
export function worstPlaces(squares: HeatSquare[], column: number, least: number): { at: Point; value: number }[] {
  const falling = squares.map((s) => ({ at: { x: s[0], y: s[1] }, value: s[column] ?? 0 })).filter((s) => s.value >= least).sort((a, b) => b.value - a.value);
  const worst: { at: Point; value: number }[] = [];
  for (const square of falling) {
    if (worst.length === mostWorst) break;
    if (worst.every((other) => Math.hypot(other.at.x - square.at.x, other.at.y - square.at.y) >= apartM)) worst.push(square);
  }
  return worst;
}

export interface HeatActions { goTo(points: Point[]): void; suggestNear(spot: Point): void }

export class HeatLayer {
  heat: Heat | null = null;
  private readonly choice = el('select', { id: 'heat-kind' }, el('option', { value: 'none' }, 'nothing'), ...Object.entries(measures).map(([kind, m]) => el('option', { value: kind }, m.label)));
  private readonly words = el('p', { id: 'heat-words', class: 'faint' });
  private readonly list = el('ul', { class: 'plain', id: 'heat-worst' });

  constructor(private readonly stage: Stage, private readonly actions: HeatActions) {
    this.choice.addEventListener('change', () => this.refresh());
    byId('heat').append(el('label', { for: 'heat-kind' }, 'Colour the floor by '), this.choice, this.words, this.list);
    this.refresh();
  }

  /** Anew: another run has ended. */
  async load(): Promise<void> {
    this.heat = await getHeat();
    this.refresh();
  }

  private get measure(): Measure | null { return this.choice.value === 'none' ? null : measures[this.choice.value as Exclude<Kind, 'none'>]; }

  private refresh(): void {
    const { heat, measure } = this;
    const of = heat ? `The newest ${plural(heat.runs, 'run')} of this site together.` : '';
    if (!measure || !heat) {
      this.words.textContent = of;
      this.list.replaceChildren();
    } else {
      const { column, unit, digits, least } = measure;
      const top = Math.max(0, ...heat.squares.map((s) => s[column] ?? 0));
      this.words.textContent = `${of} From light (0) to dark (${top.toFixed(digits)} ${unit}), in squares of ${(100 * heat.square_m).toFixed(0)} cm.`;
      const worst = worstPlaces(heat.squares, column, least);
      this.list.replaceChildren(...(worst.length === 0 ? [el('li', { class: 'fine' }, `Nowhere ${least} ${unit} or more.`)] : worst.map(({ at, value }) => {
        const place = `${at.x.toFixed(1)}, ${at.y.toFixed(1)} m`;
        return el('li', { class: 'run' }, button(`${place}: ${value.toFixed(digits)} ${unit}`, 'Show on the map', () => this.actions.goTo([at])),
          button('Suggest a marker here', `Place a marker that the robot sees at ${place}`, () => this.actions.suggestNear(at)));
      })));
    }
    this.stage.redrawOverlay();
  }

  paint(c: CanvasRenderingContext2D): void {
    const { heat, measure } = this;
    if (!heat || !measure) return;
    const { view } = this.stage;
    const top = Math.max(1e-9, ...heat.squares.map((s) => s[measure.column] ?? 0));
    const half = heat.square_m / 2;
    c.save();
    c.globalAlpha = 0.65;
    for (const square of heat.squares) {
      const value = square[measure.column];
      if (!value) continue;
      c.fillStyle = colourAt(value / top);
      c.beginPath();
      for (const [dx, dy] of [[-half, -half], [half, -half], [half, half], [-half, half]] as const) {
        const p = view.toScreen({ x: square[0] + dx, y: square[1] + dy });
        c.lineTo(p.x, p.y);
      }
      c.fill();
    }
    c.restore();
  }
}
