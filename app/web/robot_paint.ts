// Draws the robot, its uncertainty ellipse, paths and goals over the map.
import { font } from './fonts.js';
import { degrees } from './geometry.js';
import type { Point, Pose } from './geometry.js';
import type { View } from './view.js';

export interface Ink { robot: string; path: string; preview: string; track: string; truth: string; goal: string; stale: string; person: string; stands: string; rim: string }
export const ink: Record<'light' | 'dark', Ink> = {
  light: { robot: '#0b5fce', path: '#1d6b34', preview: '#8a5a00', track: '#c33cc0', truth: '#e07000', goal: '#b3261e', stale: '#7d8794', person: '#d0006f', stands: '#00707a', rim: '#ffffff' },
  dark: { robot: '#7fb2ff', path: '#7fd699', preview: '#f0c060', track: '#e58ae2', truth: '#ffb067', goal: '#ff9a92', stale: '#8b95a3', person: '#ff5fa8', stands: '#5fd0d8', rim: '#12161d' },
};
export const inkNow = (): Ink => ink[document.documentElement.dataset['theme'] === 'dark' ? 'dark' : 'light'];

export function drawWay(c: CanvasRenderingContext2D, view: View, points: Iterable<Point>, colour: string, widthPx: number, dash: number[] = []): void {
  c.save();
  c.strokeStyle = colour;
  c.lineWidth = widthPx;
  c.lineJoin = 'round';
  c.setLineDash(dash);
  c.beginPath();
  for (const point of points) {
    const p = view.toScreen(point);
    c.lineTo(p.x, p.y);
  }
  c.stroke();
  c.restore();
}

/** A disc, or the outline where the robot has one: corners in its own frame, x ahead and y to the left. */
export interface RobotShape { radius_m: number; footprint_m: [number, number][] | null }

/** The footprint, to scale but never too small to be seen, and a wedge at its front. */
export function drawRobot(c: CanvasRenderingContext2D, view: View, pose: Pose, shape: RobotShape, colour: string): void {
  const at = view.toScreen(pose);
  const corners = shape.footprint_m ?? [[shape.radius_m, shape.radius_m]];
  const front = Math.max(...corners.map(([x]) => x)), side = Math.max(...corners.map(([, y]) => Math.abs(y)));
  const scale = Math.max(view.pixelsPerM, 7 / Math.max(front, side));
  c.save();
  c.translate(at.x, at.y);
  c.rotate(view.angleOf(pose.yawDeg));
  c.strokeStyle = c.fillStyle = colour;
  c.lineWidth = 2;
  c.globalAlpha = 0.3;
  c.beginPath();
  if (shape.footprint_m) for (const [x, y] of shape.footprint_m) c.lineTo(x * scale, -y * scale);
  else c.arc(0, 0, shape.radius_m * scale, 0, 2 * Math.PI);
  c.closePath();
  c.fill();
  c.globalAlpha = 1;
  c.stroke();
  const nose = front * scale, size = Math.min(front, side) * scale;
  c.beginPath();
  c.moveTo(nose, 0); c.lineTo(nose - size * 1.35, size * 0.5); c.lineTo(nose - size * 1.1, 0); c.lineTo(nose - size * 1.35, -size * 0.5);
  c.closePath();
  c.fill();
  c.restore();
}

/** Semi-axes (m) of the ellipse at this number of sigmas, and the direction of the longer one. */
export function ellipseOf([xx, xy, yy]: [number, number, number], sigmas: number): { long: number; short: number; yawRad: number } {
  const mean = (xx + yy) / 2;
  const apart = Math.hypot((xx - yy) / 2, xy);
  return { long: sigmas * Math.sqrt(Math.max(0, mean + apart)), short: sigmas * Math.sqrt(Math.max(0, mean - apart)), yawRad: 0.5 * Math.atan2(2 * xy, xx - yy) };
}

export function drawEllipse(c: CanvasRenderingContext2D, view: View, at: Point, covariance: [number, number, number], colour: string): void {
  const { long, short, yawRad } = ellipseOf(covariance, 3);
  const p = view.toScreen(at);
  c.save();
  c.strokeStyle = c.fillStyle = colour;
  c.lineWidth = 1.5;
  c.beginPath();
  c.ellipse(p.x, p.y, Math.max(1.5, long * view.pixelsPerM), Math.max(1.5, short * view.pixelsPerM), view.angleOf(degrees(yawRad)), 0, 2 * Math.PI);
  c.globalAlpha = 0.25;
  c.fill();
  c.globalAlpha = 1;
  c.stroke();
  c.restore();
}

/** A ring with a number; with a heading an arrow to it. */
export function drawGoal(c: CanvasRenderingContext2D, view: View, at: Point, yawDeg: number | null, label: string, colour: string): void {
  const p = view.toScreen(at);
  c.save();
  c.strokeStyle = c.fillStyle = colour;
  c.lineWidth = 2.5;
  c.beginPath();
  c.arc(p.x, p.y, 9, 0, 2 * Math.PI);
  c.stroke();
  c.beginPath();
  c.arc(p.x, p.y, 2.5, 0, 2 * Math.PI);
  c.fill();
  if (yawDeg !== null) {
    const end = headOf(view, p, yawDeg);
    c.beginPath();
    c.moveTo(p.x, p.y); c.lineTo(end.x, end.y);
    c.stroke();
    c.beginPath();
    c.arc(end.x, end.y, 4, 0, 2 * Math.PI);
    c.fill();
  }
  c.font = font(13, 'bold');
  c.fillText(label, p.x + 13, p.y - 9);
  c.restore();
}

const headPx = 38;

/** End of a goal's arrow on the screen. */
export function headOf(view: View, p: Point, yawDeg: number): Point {
  const angle = view.angleOf(yawDeg);
  return { x: p.x + headPx * Math.cos(angle), y: p.y + headPx * Math.sin(angle) };
}
