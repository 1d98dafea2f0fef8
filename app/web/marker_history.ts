// Earlier states of the markers, as pictures and in words.
import * as api from './api.js';
import type { Floor } from './floor.js';
import type { Editor, Registry } from './editor.js';
import { centerOf } from './geometry.js';
import type { Marker, Point } from './geometry.js';
import { differences, summary } from './history.js';
import { chooseState } from './history_dialog.js';
import { mapPicture } from './map_picture.js';
import { markersOf } from './run_scene.js';

const largePx = { width: 460, height: 300 }, smallPx = { width: 96, height: 64 };
const inks = { same: '#7d8794', gone: '#d0006f', come: '#1d8a4a', moved: '#0b5fce' };

/** Gone are crosses, new ones pluses, and moved ones lines to where they are now: no colour alone tells. */
function drawStates(canvas: HTMLCanvasElement, floor: Floor, former: Marker[], now: Marker[], large: boolean): void {
  const { width, height } = large ? largePx : smallPx;
  const { c, place } = mapPicture(canvas, floor, width, height);
  const present = new Map(now.map((m) => [m.id, m])), before = new Map(former.map((m) => [m.id, m]));
  const at = (m: Marker): Point => place(centerOf(m));
  const size = large ? 4 : 1.5;
  const dot = (p: Point, ink: string) => { c.fillStyle = ink; c.beginPath(); c.arc(p.x, p.y, size * 0.7, 0, 2 * Math.PI); c.fill(); };
  const strokes = (p: Point, ink: string, ends: [number, number][]) => {
    c.strokeStyle = ink;
    c.beginPath();
    for (const [x, y] of ends) { c.moveTo(p.x - x * size, p.y - y * size); c.lineTo(p.x + x * size, p.y + y * size); }
    c.stroke();
  };
  c.lineWidth = large ? 2 : 1;
  for (const marker of former) {
    const after = present.get(marker.id);
    const p = at(marker);
    if (!large) dot(p, inks.same);
    else if (!after) strokes(p, inks.gone, [[1, 1], [1, -1]]);
    else if (Math.hypot(after.x - marker.x, after.y - marker.y) < 1e-6) dot(p, inks.same);
    else {
      const q = at(after);
      c.strokeStyle = inks.moved;
      c.beginPath();
      c.moveTo(p.x, p.y); c.lineTo(q.x, q.y);
      c.stroke();
      dot(q, inks.moved);
    }
  }
  if (!large) return;
  for (const marker of now) if (!before.has(marker.id)) strokes(at(marker), inks.come, [[1, 0], [0, 1]]);
}

/** Loads the state that is chosen into the editor, without saving. */
export async function openHistory(editor: Editor, floor: Floor): Promise<string> {
  const states = await api.getHistory();
  if (states.length === 0) return 'Nothing has been saved over yet';
  const now = editor.registry();
  const former = await chooseState<Registry>({ states, get: api.getFormer,
    compare: (state) => ({ summary: `Since then: ${summary(state, now)}. On the picture: × removed, + added, a line to where one was moved.`, list: differences(state, now) }),
    draw: (canvas, state, large) => drawStates(canvas, floor, markersOf(state), [...editor.shown()], large) });
  if (!former) return '';
  editor.replaceAll(former);
  return 'An earlier state was brought back; save to keep it, undo to leave it';
}
