// The installation plan: where each marker hangs, with the distances to the walls, to be printed and taken along, or as CSV.
import * as api from './api.js';
import type { Floor } from './floor.js';
import { download } from './dialogs.js';
import { ask, byId, el, plural } from './dom.js';
import type { Editor } from './editor.js';
import { centerOf } from './geometry.js';
import { mapPicture } from './map_picture.js';

const mapPx = { width: 1400, height: 900 };
const columns: [string, (row: Map<string, string>) => string][] = [
  ['ID', (row) => row.get('id')!],
  ['x (m)', (row) => metres(row.get('x_m')!)], ['y (m)', (row) => metres(row.get('y_m')!)], ['height (m)', (row) => metres(row.get('z_m')!)],
  ['arrow (°)', (row) => Number(row.get('yaw_deg')).toFixed(1)],
  ['from the wall', (row) => wall(row, 'wall_x')], ['and', (row) => wall(row, 'wall_y')], ['hung', () => '☐']];

const metres = (text: string): string => Number(text).toFixed(3);
const wall = (row: Map<string, string>, which: string): string => row.get(which) === '' ? '' : `${row.get(which)}: ${metres(row.get(`${which}_m`)!)} m`;

/** Of a CSV without quotation marks in what is used here. */
function rowsOf(csv: string): Map<string, string>[] {
  const [head, ...lines] = csv.trim().split('\n').map((line) => line.split(','));
  return lines.map((cells) => new Map(head!.map((name, i) => [name, cells[i] ?? ''])));
}

/** The map with all IDs where they hang. */
function picture(editor: Editor, floor: Floor): HTMLCanvasElement {
  const canvas = el('canvas', { class: 'plan-map' });
  const { c, place } = mapPicture(canvas, floor, mapPx.width, mapPx.height);
  c.font = '15px system-ui, sans-serif';
  c.textAlign = 'center';
  c.lineWidth = 3;
  c.strokeStyle = '#ffffff';
  for (const marker of editor.shown()) {
    const p = place(centerOf(marker));
    c.fillStyle = '#b3261e';
    c.fillRect(p.x - 4, p.y - 4, 8, 8);
    c.fillStyle = '#000000';
    c.strokeText(String(marker.id), p.x, p.y + 19);
    c.fillText(String(marker.id), p.x, p.y + 19);
  }
  return canvas;
}

export async function offerPlan(editor: Editor, floor: Floor, site: string): Promise<string> {
  if (editor.markers.size === 0) return 'There are no markers to hang yet';
  const { text } = await api.planOf(editor.draft());
  const answer = await ask('Installation plan', [el('p', {}, `Where ${plural(editor.markers.size, 'marker')} ${editor.markers.size === 1 ? 'hangs' : 'hang'}: position and height of the centre, the way the arrow from dot O to X points, and the distances to the two nearer walls, with a map and a box to tick.`)],
    [['print', 'Print'], ['csv', 'Download as CSV'], ['', 'Cancel']]);
  if (answer === 'csv') download('plan.csv', new Blob([text], { type: 'text/csv' }));
  if (answer !== 'print') return '';
  const rows = rowsOf(text);
  const table = el('table', {}, el('thead', {}, el('tr', {}, ...columns.map(([name]) => el('th', { scope: 'col' }, name)))),
    el('tbody', {}, ...rows.map((row) => el('tr', {}, ...columns.map(([, words]) => el('td', {}, words(row)))))));
  const theme = document.documentElement.dataset['theme'] ?? 'light';
  document.documentElement.dataset['theme'] = 'light';  // for paper
  byId('paper').replaceChildren(el('h1', {}, `${site}: where the markers hang`), el('p', {}, `${rows[0]?.get('date') ?? ''}. The printed face looks down. Left, right, below and above are as on the map.`), picture(editor, floor), table);
  window.print();
  document.documentElement.dataset['theme'] = theme;
  return '';
}
