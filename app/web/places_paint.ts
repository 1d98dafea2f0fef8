// Draws zones, lanes and places over the map: hatched keep-outs, tinted speed zones, arrows on one-way lanes.
import { font } from './fonts.js';
import type { Point } from './geometry.js';
import { isLane, isSpot, isZone } from './places_doc.js';
import type { Lane, PlacesEditor, Spot, Zone } from './places_doc.js';
import { headOf } from './robot_paint.js';
import type { View } from './view.js';

interface ZoneInk { out: string; slow: string; lane: string; spot: string; paper: string; chosen: string }
const inks: Record<'light' | 'dark', ZoneInk> = {
  light: { out: '#a31515', slow: '#0b5fce', lane: '#00646c', spot: '#6a2fa0', paper: '#ffffff', chosen: '#d05a00' },
  dark: { out: '#ff9a92', slow: '#8fbcff', lane: '#5fd0d8', spot: '#d9a8ff', paper: '#12161d', chosen: '#ffc46b' },
};
/** Of zones, lanes and places. */
export const zoneInkNow = (): ZoneInk => inks[document.documentElement.dataset['theme'] === 'dark' ? 'dark' : 'light'];
const hatchPx = 11;
const shortPx = 64;   // a lane shorter than this on the screen has one arrow and no label
const manyItems = 150;  // from this many on, nodes have no label unless chosen
export const handlePx = 6;

export interface Marks { positions: Point[] }

function trace(c: CanvasRenderingContext2D, points: Point[]): void {
  c.beginPath();
  for (const p of points) c.lineTo(p.x, p.y);
  c.closePath();
}

/** With a rim of the paper's colour, so that it is legible on walls too. */
function label(c: CanvasRenderingContext2D, text: string, at: Point, colour: string, paper: string): void {
  c.font = font(12, '600');
  c.lineJoin = 'round';
  c.setLineDash([]);
  c.lineWidth = 4;
  c.strokeStyle = paper;
  c.strokeText(text, at.x, at.y);
  c.fillStyle = colour;
  c.fillText(text, at.x, at.y);
}

const middleOf = (points: Point[]): Point => ({ x: points.reduce((s, p) => s + p.x, 0) / points.length, y: points.reduce((s, p) => s + p.y, 0) / points.length });

function hatch(c: CanvasRenderingContext2D, points: Point[], view: View): void {
  const xs = points.map((p) => p.x), ys = points.map((p) => p.y);
  const low = { x: Math.max(0, Math.min(...xs)), y: Math.max(0, Math.min(...ys)) };
  const high = { x: Math.min(view.width, Math.max(...xs)), y: Math.min(view.height, Math.max(...ys)) };
  c.save();
  trace(c, points);
  c.clip();
  c.beginPath();
  for (let d = Math.floor((low.x + low.y) / hatchPx) * hatchPx; d < high.x + high.y; d += hatchPx) {
    c.moveTo(d - low.y, low.y);
    c.lineTo(d - high.y, high.y);
  }
  c.stroke();
  c.restore();
}

function drawZone(c: CanvasRenderingContext2D, view: View, zone: Zone, chosen: boolean): void {
  const colours = zoneInkNow();
  const colour = zone.kind === 'keep_out' ? colours.out : colours.slow;
  const points = zone.corners.map((p) => view.toScreen(p));
  c.fillStyle = c.strokeStyle = colour;
  c.globalAlpha = zone.kind === 'keep_out' ? 0.12 : 0.2;
  trace(c, points);
  c.fill();
  c.globalAlpha = 0.9;
  c.lineWidth = 1.2;
  c.setLineDash([]);
  if (zone.kind === 'keep_out') hatch(c, points, view);
  c.globalAlpha = 1;
  c.strokeStyle = chosen ? colours.chosen : colour;
  c.lineWidth = chosen ? 3 : 2;
  c.setLineDash(zone.kind === 'keep_out' ? [] : [7, 4]);
  trace(c, points);
  c.stroke();
}

function labelZone(c: CanvasRenderingContext2D, view: View, zone: Zone): void {
  const colours = zoneInkNow();
  c.textAlign = 'center';
  const speed = zone.kind === 'speed_zone' ? `${zone.name === '' ? '' : ': '}${zone.maxMps} m/s` : zone.name === '' ? 'keep out' : '';
  label(c, `${zone.name}${speed}`, middleOf(zone.corners.map((p) => view.toScreen(p))), zone.kind === 'keep_out' ? colours.out : colours.slow, colours.paper);
}

/** Corners to drag, and a small ring in the middle of each side, which adds one. */
function drawHandles(c: CanvasRenderingContext2D, view: View, zone: Zone, corner: number | null): void {
  const colours = zoneInkNow();
  const points = zone.corners.map((p) => view.toScreen(p));
  c.setLineDash([]);
  c.lineWidth = 2;
  points.forEach((p, i) => {
    const next = points[(i + 1) % points.length]!;
    c.strokeStyle = colours.chosen;
    c.fillStyle = colours.paper;
    c.beginPath();
    c.arc((p.x + next.x) / 2, (p.y + next.y) / 2, handlePx - 2, 0, 2 * Math.PI);
    c.fill();
    c.stroke();
    c.fillStyle = i === corner ? colours.chosen : colours.paper;
    c.fillRect(p.x - handlePx, p.y - handlePx, 2 * handlePx, 2 * handlePx);
    c.strokeRect(p.x - handlePx, p.y - handlePx, 2 * handlePx, 2 * handlePx);
  });
}

function arrow(c: CanvasRenderingContext2D, at: Point, angle: number): void {
  c.beginPath();
  for (const [along, across] of [[9, 0], [-7, 7], [-3, 0], [-7, -7]] as const) {
    c.lineTo(at.x + along * Math.cos(angle) - across * Math.sin(angle), at.y + along * Math.sin(angle) + across * Math.cos(angle));
  }
  c.closePath();
  c.fill();
}

function drawLane(c: CanvasRenderingContext2D, view: View, lane: Lane, from: Spot, to: Spot, chosen: boolean): void {
  const colours = zoneInkNow();
  const [a, b] = [view.toScreen(from), view.toScreen(to)];
  const angle = Math.atan2(b.y - a.y, b.x - a.x);
  c.strokeStyle = c.fillStyle = chosen ? colours.chosen : colours.lane;
  c.lineWidth = chosen ? 4 : 2.5;
  c.setLineDash([]);
  c.beginPath();
  c.moveTo(a.x, a.y);
  c.lineTo(b.x, b.y);
  c.stroke();
  if (lane.oneWay) for (const share of Math.hypot(b.x - a.x, b.y - a.y) < shortPx ? [0.55] : [1 / 3, 2 / 3]) arrow(c, { x: a.x + share * (b.x - a.x), y: a.y + share * (b.y - a.y) }, angle);
}

/** Beside the lane, clear of its arrows. */
function labelLane(c: CanvasRenderingContext2D, view: View, lane: Lane, from: Spot, to: Spot): void {
  const [a, b] = [view.toScreen(from), view.toScreen(to)];
  if (lane.maxMps === null || Math.hypot(b.x - a.x, b.y - a.y) < shortPx) return;
  const isSteep = Math.abs(b.y - a.y) > Math.abs(b.x - a.x);
  c.textAlign = isSteep ? 'start' : 'center';
  label(c, `${lane.maxMps} m/s`, { x: (a.x + b.x) / 2 + (isSteep ? 12 : 0), y: (a.y + b.y) / 2 - (isSteep ? -4 : 10) }, zoneInkNow().lane, zoneInkNow().paper);
}

function drawSpot(c: CanvasRenderingContext2D, view: View, spot: Spot, chosen: boolean): void {
  const colours = zoneInkNow();
  const p = view.toScreen(spot);
  const colour = spot.kind === 'place' ? colours.spot : colours.lane;
  c.strokeStyle = chosen ? colours.chosen : colour;
  c.fillStyle = colours.paper;
  c.lineWidth = chosen ? 3.5 : 2.5;
  c.setLineDash([]);
  c.beginPath();
  c.arc(p.x, p.y, spot.kind === 'place' ? 7 : 4.5, 0, 2 * Math.PI);
  c.fill();
  c.stroke();
  if (spot.yawDeg !== null) {
    const end = headOf(view, p, spot.yawDeg);
    c.beginPath();
    c.moveTo(p.x + 0.2 * (end.x - p.x), p.y + 0.2 * (end.y - p.y));
    c.lineTo(end.x, end.y);
    c.stroke();
    c.fillStyle = c.strokeStyle;
    arrow(c, end, Math.atan2(end.y - p.y, end.x - p.x));
  }
}

function labelSpot(c: CanvasRenderingContext2D, view: View, spot: Spot): void {
  const colours = zoneInkNow();
  const p = view.toScreen(spot);
  c.textAlign = 'start';
  label(c, spot.name, { x: p.x + 11, y: p.y - 9 }, spot.kind === 'place' ? colours.spot : colours.lane, colours.paper);
}

/** `edits`: with handles at what is selected, and rings at the positions that the check complains of. */
export function paintPlaces(c: CanvasRenderingContext2D, view: View, editor: PlacesEditor, edits: boolean, marks: Marks): void {
  c.save();
  const items = editor.shown();
  const isChosen = (key: number) => edits && key === editor.selected;
  for (const kind of ['speed_zone', 'keep_out']) for (const zone of items) if (isZone(zone) && zone.kind === kind) drawZone(c, view, zone, isChosen(zone.key));
  const lanes = items.filter(isLane).flatMap((lane) => {
    const [from, to] = [editor.spot(lane.from), editor.spot(lane.to)];
    return from && to ? [{ lane, from, to }] : [];
  });
  for (const { lane, from, to } of lanes) drawLane(c, view, lane, from, to, isChosen(lane.key));
  for (const spot of items) if (isSpot(spot)) drawSpot(c, view, spot, isChosen(spot.key));
  for (const zone of items) if (isZone(zone)) labelZone(c, view, zone);
  for (const { lane, from, to } of lanes) labelLane(c, view, lane, from, to);
  for (const spot of items) if (isSpot(spot) && (spot.kind === 'place' || isChosen(spot.key) || items.length <= manyItems)) labelSpot(c, view, spot);
  const chosen = editor.chosen;
  if (edits && chosen && isZone(chosen)) drawHandles(c, view, chosen, editor.corner);
  if (edits) drawMarks(c, view, marks);
  c.restore();
}

function drawMarks(c: CanvasRenderingContext2D, view: View, marks: Marks): void {
  c.strokeStyle = zoneInkNow().out;
  c.lineWidth = 2.5;
  c.setLineDash([4, 3]);
  for (const position of marks.positions) {
    const p = view.toScreen(position);
    c.beginPath();
    c.arc(p.x, p.y, 15, 0, 2 * Math.PI);
    c.stroke();
  }
}

/** What is being drawn: corners so far and the pointer. */
export function paintDrawing(c: CanvasRenderingContext2D, view: View, points: Point[], hover: Point | null): void {
  if (points.length === 0) return;
  const colours = zoneInkNow();
  const all = [...points, ...(hover ? [hover] : [])].map((p) => view.toScreen(p));
  c.save();
  c.strokeStyle = colours.chosen;
  c.fillStyle = colours.paper;
  c.lineWidth = 2;
  c.setLineDash([6, 4]);
  c.beginPath();
  for (const p of all) c.lineTo(p.x, p.y);
  c.stroke();
  c.setLineDash([]);
  for (const p of points.map((q) => view.toScreen(q))) {
    c.beginPath();
    c.arc(p.x, p.y, handlePx, 0, 2 * Math.PI);
    c.fill();
    c.stroke();
  }
  c.restore();
}
