// What part of the map the stage shows: metres with y up against pixels with y down.
import type { Point } from './geometry.js';

export class View {
  center: Point = { x: 0, y: 0 };
  pixelsPerM = 50;
  width = 1;
  height = 1;

  toScreen(p: Point): Point {
    return {
      x: (p.x - this.center.x) * this.pixelsPerM + this.width / 2,
      y: (this.center.y - p.y) * this.pixelsPerM + this.height / 2,
    };
  }

  toMap(p: Point): Point {
    return {
      x: (p.x - this.width / 2) / this.pixelsPerM + this.center.x,
      y: this.center.y - (p.y - this.height / 2) / this.pixelsPerM,
    };
  }

  panBy(dx: number, dy: number): void {
    this.center = { x: this.center.x - dx / this.pixelsPerM, y: this.center.y + dy / this.pixelsPerM };
  }

  /** Zooms about a place on the screen: what is under it stays under it. */
  zoomAt(screen: Point, factor: number): void {
    const before = this.toMap(screen);
    this.pixelsPerM = Math.min(5000, Math.max(2, this.pixelsPerM * factor));
    const after = this.toMap(screen);
    this.center = { x: this.center.x + before.x - after.x, y: this.center.y + before.y - after.y };
  }

  /** Shows all of these points, with some room around them; never closer than a few metres. */
  fit(points: Point[], leastM = 1): void {
    const xs = points.map((p) => p.x);
    const ys = points.map((p) => p.y);
    const low = { x: Math.min(...xs), y: Math.min(...ys) };
    const high = { x: Math.max(...xs), y: Math.max(...ys) };
    this.center = { x: (low.x + high.x) / 2, y: (low.y + high.y) / 2 };
    const size = { x: Math.max(leastM, high.x - low.x), y: Math.max(leastM, high.y - low.y) };
    this.pixelsPerM = 0.92 * Math.min(this.width / size.x, this.height / size.y);
  }
}
