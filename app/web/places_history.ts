// Earlier states of zones, lanes and places, as pictures and in words.
import * as api from './api.js';
import type { Floor } from './floor.js';
import { chooseState } from './history_dialog.js';
import { mapPicture } from './map_picture.js';
import type { PlacesDocument, PlacesEditor } from './places_doc.js';
import { placesDifferences } from './places_merge.js';

const largePx = { width: 460, height: 300 }, smallPx = { width: 96, height: 64 };
const nowInk = '#0b5fce', formerInk = '#c2410c';

/** The former state in full lines, and that of now dashed over it where the picture is large. */
function drawStates(canvas: HTMLCanvasElement, floor: Floor, former: PlacesDocument, now: PlacesDocument, large: boolean): void {
  const { width, height } = large ? largePx : smallPx;
  const { c, place } = mapPicture(canvas, floor, width, height);
  const draw = (document: PlacesDocument, ink: string, dash: number[]) => {
    c.strokeStyle = c.fillStyle = ink;
    c.lineWidth = large ? 2 : 1;
    c.setLineDash(dash);
    for (const zone of [...document.keep_out, ...document.speed_zones]) {
      c.beginPath();
      for (const [x, y] of zone.corners_m) { const p = place({ x, y }); c.lineTo(p.x, p.y); }
      c.closePath();
      c.stroke();
    }
    const spots = new Map([...document.places, ...document.nodes].map((spot) => [spot.name, place({ x: spot.x_m, y: spot.y_m })]));
    for (const { from, to } of document.edges) {
      const [a, b] = [spots.get(from), spots.get(to)];
      if (!a || !b) continue;
      c.beginPath();
      c.moveTo(a.x, a.y); c.lineTo(b.x, b.y);
      c.stroke();
    }
    for (const p of spots.values()) {
      c.beginPath();
      c.arc(p.x, p.y, large ? 3.5 : 1.5, 0, 2 * Math.PI);
      c.fill();
    }
  };
  draw(former, formerInk, []);
  if (large) draw(now, nowInk, [5, 4]);
}

/** Loads the state that is chosen into the editor, without saving. */
export async function openPlacesHistory(editor: PlacesEditor, floor: Floor): Promise<string> {
  const states = await api.getPlacesHistory();
  if (states.length === 0) return 'Nothing has been saved over yet';
  const now = editor.document();
  const former = await chooseState<PlacesDocument>({ states, get: api.getFormerPlaces,
    compare: (state) => {
      const list = placesDifferences(state, now);
      return { summary: list.length === 0 ? 'The same as now.' : 'Changed since then, on the picture dashed:', list };
    },
    draw: (canvas, state, large) => drawStates(canvas, floor, state, now, large) });
  if (!former) return '';
  editor.replaceAll(former);
  return 'An earlier state was brought back; save to keep it, undo to leave it';
}
