// Cells of a map that a person draws on: walls, floor, and what lies outside. Every stroke can be undone.
import type { Point } from './geometry.js';

export const wall = 100, floor = 0, outside = 255;
export type Cell = typeof wall | typeof floor | typeof outside;

interface Stroke { at: number[]; before: number[]; after: Cell }

export class MapPaint {
  onChange: () => void = () => {};
  /** Indices of cells that have changed since who shows them has looked. */
  readonly changed: number[] = [];
  private readonly done: Stroke[] = [];
  private readonly undone: Stroke[] = [];
  private stroke: Stroke | null = null;
  private touched = new Set<number>();

  constructor(readonly columns: number, readonly rows: number, readonly cells: Uint8Array) {}

  get canUndo(): boolean { return this.done.length > 0; }
  get canRedo(): boolean { return this.undone.length > 0; }

  begin(value: Cell): void {
    this.stroke = { at: [], before: [], after: value };
    this.touched = new Set();
  }

  end(): void {
    if (this.stroke && this.stroke.at.length > 0) {
      this.done.push(this.stroke);
      this.undone.length = 0;
    }
    this.stroke = null;
    this.onChange();
  }

  /** From cell to cell, in whole cells; `width` cells wide. Between begin() and end(), as all that paints. */
  line(from: Point, to: Point, width: number): void {
    const steps = Math.max(1, Math.ceil(2 * Math.max(Math.abs(to.x - from.x), Math.abs(to.y - from.y))));
    const low = -Math.floor((width - 1) / 2), high = Math.floor(width / 2);
    for (let i = 0; i <= steps; ++i) {
      const x = Math.floor(from.x + (to.x - from.x) * i / steps), y = Math.floor(from.y + (to.y - from.y) * i / steps);
      for (let dx = low; dx <= high; ++dx) for (let dy = low; dy <= high; ++dy) this.set(x + dx, y + dy);
    }
    this.onChange();
  }

  rectangle(a: Point, b: Point): void {
    for (let y = Math.floor(Math.min(a.y, b.y)); y <= Math.floor(Math.max(a.y, b.y)); ++y)
      for (let x = Math.floor(Math.min(a.x, b.x)); x <= Math.floor(Math.max(a.x, b.x)); ++x) this.set(x, y);
    this.onChange();
  }

  /** All that hangs together with this cell over its four neighbours. */
  fill(at: Point): void {
    const start = this.index(Math.floor(at.x), Math.floor(at.y));
    if (start < 0 || !this.stroke || this.cells[start] === this.stroke.after) return;
    const old = this.cells[start]!;
    const open = [start];
    while (open.length > 0) {
      const index = open.pop()!;
      if (this.cells[index] !== old || this.touched.has(index)) continue;
      const x = index % this.columns, y = Math.floor(index / this.columns);
      this.set(x, y);
      for (const [nx, ny] of [[x + 1, y], [x - 1, y], [x, y + 1], [x, y - 1]] as const) {
        const next = this.index(nx, ny);
        if (next >= 0 && this.cells[next] === old) open.push(next);
      }
    }
    this.onChange();
  }

  undo(): void { this.move(this.done, this.undone, true); }
  redo(): void { this.move(this.undone, this.done, false); }

  private move(from: Stroke[], to: Stroke[], back: boolean): void {
    const stroke = from.pop();
    if (!stroke) return;
    stroke.at.forEach((index, i) => { this.cells[index] = back ? stroke.before[i]! : stroke.after; });
    for (const index of stroke.at) this.changed.push(index);
    to.push(stroke);
    this.onChange();
  }

  private index(x: number, y: number): number {
    return x < 0 || y < 0 || x >= this.columns || y >= this.rows ? -1 : y * this.columns + x;
  }

  private set(x: number, y: number): void {
    const index = this.index(x, y);
    if (index < 0 || !this.stroke || this.cells[index] === this.stroke.after) return;
    if (!this.touched.has(index)) {
      this.touched.add(index);
      this.stroke.at.push(index);
      this.stroke.before.push(this.cells[index]!);
    }
    this.cells[index] = this.stroke.after;
    this.changed.push(index);
  }
}
