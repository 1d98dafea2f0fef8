// The usual drive of the site, and where on it the robot would see no marker for longer than its wheels can be trusted.
import type { Coverage } from './coverage.js';
import type { Point } from './geometry.js';
import type { Stage } from './stage.js';

const stepM = 0.05;

export interface BlindStretch { from: Point; to: Point; lengthM: number }

/** Places along the legs, a few centimetres apart. */
function* walk(leg: Point[]): Generator<Point> {
  for (let i = 1; i < leg.length; ++i) {
    const a = leg[i - 1]!, b = leg[i]!;
    const steps = Math.max(1, Math.ceil(Math.hypot(b.x - a.x, b.y - a.y) / stepM));
    for (let k = i === 1 ? 0 : 1; k <= steps; ++k) yield { x: a.x + (b.x - a.x) * k / steps, y: a.y + (b.y - a.y) * k / steps };
  }
}

const near = (a: Point, b: Point): boolean => Math.hypot(a.x - b.x, a.y - b.y) < 0.3;

/** The same stretch, there or back? */
const alike = (a: BlindStretch, b: BlindStretch): boolean =>
  (near(a.from, b.from) && near(a.to, b.to)) || (near(a.from, b.to) && near(a.to, b.from));

/** Stretches of the route longer than `mostM` from which no marker is sure to be seen. */
export function blindStretches(routes: Point[][], coverage: Coverage, mostM: number): BlindStretch[] {
  const found: BlindStretch[] = [];
  for (const route of routes) {
    let from: Point | null = null;
    let last: Point | null = null;
    let lengthM = 0;
    const close = () => {
      const stretch = from && last && lengthM > mostM ? { from, to: last, lengthM } : null;
      if (stretch && !found.some((other) => alike(stretch, other))) found.push(stretch);
      from = null;
      lengthM = 0;
    };
    for (const at of walk(route)) {
      if (coverage.countAt(at) > 0) close();
      else if (!from) from = at;
      else lengthM += Math.hypot(at.x - last!.x, at.y - last!.y);
      last = at;
    }
    close();
  }
  return found.sort((a, b) => b.lengthM - a.lengthM);
}

export function paintRoutes(c: CanvasRenderingContext2D, stage: Stage, routes: Point[][]): void {
  c.save();
  c.strokeStyle = stage.colours.route;
  c.lineWidth = 2;
  c.setLineDash([8, 5]);
  for (const route of routes) {
    c.beginPath();
    for (const p of route.map((place) => stage.view.toScreen(place))) c.lineTo(p.x, p.y);
    c.stroke();
  }
  c.restore();
}
