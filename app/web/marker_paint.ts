// Draws markers: on the map as seen through the ceiling, in the panel as printed.
import { centerOf, dotRadiusM, dotsOf, pitchM, sideM, transform } from './geometry.js';
import type { Marker, Point } from './geometry.js';
import type { View } from './view.js';

/** A marker as seen through the ceiling: a mirror image of the printed face. */
export function drawFromAbove(c: CanvasRenderingContext2D, marker: Marker, view: View, plate: string, dot: string, coarse: boolean): void {
  const scale = Math.max(view.pixelsPerM, 12 / (sideM + pitchM));  // never smaller than 12 pixels
  const middle = view.toScreen(centerOf(marker));
  c.save();
  c.translate(middle.x, middle.y);
  c.rotate(view.angleOf(marker.yawDeg));
  c.scale(scale, scale);
  const half = sideM / 2 + pitchM / 2;
  c.fillStyle = plate;
  c.fillRect(-half, -half, 2 * half, 2 * half);
  c.fillStyle = dot;
  if (coarse) {  // an arrow from O to X
    c.beginPath();
    c.moveTo(half * 0.8, 0); c.lineTo(-half * 0.6, -half * 0.6); c.lineTo(-half * 0.6, half * 0.6);
    c.fill();
  } else {
    for (const { row, column, corner } of dotsOf(marker.id)) {
      c.beginPath();
      c.arc(column * pitchM - sideM / 2, (3 - row) * pitchM - sideM / 2, dotRadiusM, 0, 2 * Math.PI);
      c.fillStyle = corner === 'O' ? '#ff8a3d' : corner === 'X' ? '#58b7ff' : dot;
      c.fill();
    }
  }
  c.restore();
}

/** The marker's face for the panel: from below as printed, or from above. */
export function drawFace(canvas: HTMLCanvasElement, id: number, fromAbove: boolean): void {
  const c = canvas.getContext('2d')!;
  const step = canvas.width / 5;
  c.clearRect(0, 0, canvas.width, canvas.height);
  c.font = '10px system-ui, sans-serif';
  c.textAlign = 'center';
  c.textBaseline = 'middle';
  for (const { row, column, corner } of dotsOf(id)) {
    const x = step * (column + 1);
    const y = step * ((fromAbove ? 3 - row : row) + 1);
    c.fillStyle = corner === 'O' ? '#ff8a3d' : corner === 'X' ? '#58b7ff' : '#eef2f8';
    c.beginPath();
    c.arc(x, y, step * 0.33, 0, 2 * Math.PI);
    c.fill();
    c.fillStyle = '#10151c';
    c.fillText(corner, x, y);
  }
}

/** Is a point of the map on the marker's plate, or within `slackM` of its centre? */
export function isOn(marker: Marker, p: Point, slackM: number): boolean {
  const o = transform({ x: 0, y: 0, yawDeg: -marker.yawDeg }, { x: p.x - marker.x, y: p.y - marker.y });
  const half = Math.max(sideM / 2 + pitchM / 2, slackM);
  return Math.abs(o.x - sideM / 2) <= half && Math.abs(o.y + sideM / 2) <= half;
}
