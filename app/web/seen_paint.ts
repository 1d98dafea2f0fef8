// Draws what the scanner sees: the ends of its beams by what is known of them, and the obstacle memory.
import type { Seen } from './live_socket.js';
import { inkNow } from './robot_paint.js';
import type { View } from './view.js';

export const seenForMs = 1000;  // older than this it is not drawn

/** Coordinates as x, y, x, y, ... */
function each(flat: number[], view: View, draw: (x: number, y: number) => void): void {
  for (let i = 0; i + 1 < flat.length; i += 2) {
    const p = view.toScreen({ x: flat[i]!, y: flat[i + 1]! });
    draw(p.x, p.y);
  }
}

/** Shape tells as much as colour: dots on the map, squares for what stands, discs with a rim for what may be a person. */
export function drawSeen(c: CanvasRenderingContext2D, view: View, seen: Seen): void {
  const colours = inkNow();
  c.save();
  drawCells(c, view, seen, seen.cells_standing, colours.stands, 0.45);
  drawCells(c, view, seen, seen.cells_moving, colours.person, 0.3);
  c.fillStyle = colours.stale;
  each(seen.mapped, view, (x, y) => c.fillRect(x - 1, y - 1, 2, 2));
  c.fillStyle = colours.stands;
  each(seen.standing, view, (x, y) => c.fillRect(x - 2.5, y - 2.5, 5, 5));
  c.strokeStyle = colours.rim;
  c.fillStyle = colours.person;
  c.lineWidth = 1;
  each(seen.person, view, (x, y) => {
    c.beginPath();
    c.arc(x, y, 4, 0, 2 * Math.PI);
    c.fill();
    c.stroke();
  });
  c.strokeStyle = colours.person;
  c.setLineDash([2, 2]);
  each(seen.hidden, view, (x, y) => {
    c.beginPath();
    c.arc(x, y, 6, 0, 2 * Math.PI);
    c.stroke();
  });
  c.restore();
}

function drawCells(c: CanvasRenderingContext2D, view: View, seen: Seen, cells: number[], colour: string, alpha: number): void {
  const side = Math.max(2, (seen.cell_m ?? 0) * view.pixelsPerM);
  const turn = view.angleOf(seen.cell_yaw_deg ?? 0);
  c.fillStyle = colour;
  c.globalAlpha = alpha;
  each(cells, view, (x, y) => {
    c.save();
    c.translate(x, y);
    c.rotate(turn);
    c.fillRect(-side / 2, -side / 2, side, side);
    c.restore();
  });
  c.globalAlpha = 1;
}

/** The protective field in plain words; nothing where the way is clear. */
export function fieldWords(field: { state: string; why: string | null } | null): string {
  if (field === null || field.state === 'free') return '';
  return `${field.state === 'stopped' ? 'waits' : 'slowed'}: ${field.why}`;
}
