// The usual routes of the site, as planned by the server.
import type { Point } from './geometry.js';
import type { Stage } from './stage.js';

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
