// The visible part of the map: from metres with y up to pixels with y down, with the map rotated by turnDeg.
import { radians, transform, wrapDeg } from './geometry.js';
import type { Point } from './geometry.js';

export class View {
  center: Point = { x: 0, y: 0 };
  pixelsPerM = 50;
  turnDeg = 0;  // of the map on the screen, counter-clockwise
  width = 1;
  height = 1;

  toScreen(p: Point): Point {
    const at = this.turned({ x: p.x - this.center.x, y: p.y - this.center.y }, this.turnDeg);
    return { x: at.x * this.pixelsPerM + this.width / 2, y: this.height / 2 - at.y * this.pixelsPerM };
  }

  toMap(p: Point): Point {
    const at = this.turned({ x: (p.x - this.width / 2) / this.pixelsPerM, y: (this.height / 2 - p.y) / this.pixelsPerM }, -this.turnDeg);
    return { x: at.x + this.center.x, y: at.y + this.center.y };
  }

  /** Canvas angle of a map direction: radians, clockwise from the right. */
  angleOf(yawDeg: number): number { return -radians(yawDeg + this.turnDeg); }

  panBy(dx: number, dy: number): void {
    const by = this.turned({ x: dx / this.pixelsPerM, y: -dy / this.pixelsPerM }, -this.turnDeg);
    this.center = { x: this.center.x - by.x, y: this.center.y - by.y };
  }

  /** Zooms about a screen point, which keeps its map position. */
  zoomAt(screen: Point, factor: number): void {
    const before = this.toMap(screen);
    this.pixelsPerM = Math.min(5000, Math.max(2, this.pixelsPerM * factor));
    const after = this.toMap(screen);
    this.center = { x: this.center.x + before.x - after.x, y: this.center.y + before.y - after.y };
  }

  /** Rotates the map about the centre of the screen. */
  turnBy(deg: number): void { this.turnDeg = wrapDeg(this.turnDeg + deg); }

  /** Shows all of these points with a margin; at least leastM metres across. */
  fit(points: Point[], leastM = 1): void {
    const placed = points.map((p) => this.turned(p, this.turnDeg));
    const xs = placed.map((p) => p.x);
    const ys = placed.map((p) => p.y);
    const low = { x: Math.min(...xs), y: Math.min(...ys) };
    const high = { x: Math.max(...xs), y: Math.max(...ys) };
    this.center = this.turned({ x: (low.x + high.x) / 2, y: (low.y + high.y) / 2 }, -this.turnDeg);
    const size = { x: Math.max(leastM, high.x - low.x), y: Math.max(leastM, high.y - low.y) };
    this.pixelsPerM = 0.92 * Math.min(this.width / size.x, this.height / size.y);
  }

  private turned(p: Point, deg: number): Point { return deg === 0 ? p : transform({ x: 0, y: 0, yawDeg: deg }, p); }
}
