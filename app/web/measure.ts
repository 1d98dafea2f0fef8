// A tape measure: click two points or markers, and read distance and direction.
import { font } from './fonts.js';
import { centerOf, degrees } from './geometry.js';
import type { Marker, Point } from './geometry.js';
import type { Pointer } from './pointer.js';
import type { Stage } from './stage.js';

export class Measure {
  on = false;
  from: Point | null = null;
  to: Point | null = null;

  constructor(private readonly stage: Stage, private readonly pointer: Pointer, private readonly say: (words: string) => void) {
    stage.painters.push((c) => this.paint(c));
  }

  toggle(): void { this.on ? this.end() : this.begin(); }

  begin(): void {
    this.pointer.beginPick((at, marker) => this.take(at, marker), () => this.end());
    this.on = true;
    this.from = this.to = null;
    this.say('Measure: click two points, or markers for their centres. Escape cancels.');
  }

  end(): void {
    if (!this.on) return;
    this.on = false;
    this.from = this.to = null;
    this.pointer.endPick();
    this.stage.redraw();
  }

  words(): string {
    if (!this.from || !this.to) return '';
    const dx = this.to.x - this.from.x, dy = this.to.y - this.from.y;
    return `${Math.hypot(dx, dy).toFixed(3)} m (x ${dx.toFixed(3)}, y ${dy.toFixed(3)}; ${degrees(Math.atan2(dy, dx)).toFixed(1)}°)`;
  }

  private take(at: Point, marker: Marker | null): void {
    const place = marker ? centerOf(marker) : at;
    if (!this.from || this.to) [this.from, this.to] = [place, null];
    else this.to = place;
    if (this.to) this.say(`Measured: ${this.words()}`);
    this.stage.redraw();
  }

  private paint(c: CanvasRenderingContext2D): void {
    if (!this.from) return;
    const a = this.stage.view.toScreen(this.from);
    const b = this.to ? this.stage.view.toScreen(this.to) : a;
    c.strokeStyle = c.fillStyle = this.stage.colours.chosen;
    c.lineWidth = 2;
    c.beginPath();
    for (const p of [a, b]) {
      c.moveTo(p.x - 5, p.y - 5); c.lineTo(p.x + 5, p.y + 5);
      c.moveTo(p.x - 5, p.y + 5); c.lineTo(p.x + 5, p.y - 5);
    }
    c.moveTo(a.x, a.y); c.lineTo(b.x, b.y);
    c.stroke();
    c.font = font(13, 'bold');
    if (!this.to) return;
    const at = { x: (a.x + b.x) / 2 + 10, y: (a.y + b.y) / 2 - 8 };
    c.lineWidth = 4;
    c.strokeStyle = this.stage.colours.paper;
    c.strokeText(this.words(), at.x, at.y);
    c.fillText(this.words(), at.x, at.y);
  }
}
