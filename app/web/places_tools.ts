// What the pointer does on the map while zones, lanes and places are drawn.
import { degrees, tidy } from './geometry.js';
import type { Point } from './geometry.js';
import { isLane, isSpot, isZone } from './places_doc.js';
import type { Item, Kind, PlacesEditor, Spot, Zone } from './places_doc.js';
import type { Guest, Snap } from './pointer.js';
import { headOf } from './robot_paint.js';
import type { View } from './view.js';

const nearPx = 11;
const usualMps = 0.25;

type Held = { kind: 'corner'; zone: Zone; index: number } | { kind: 'zone'; zone: Zone; from: Point } | { kind: 'spot'; spot: Spot } | { kind: 'heading'; spot: Spot };

const far = (a: Point, b: Point): number => Math.hypot(a.x - b.x, a.y - b.y);

/** From a point to a straight line between two others, on the screen. */
function distanceTo(p: Point, a: Point, b: Point): number {
  const along = ((p.x - a.x) * (b.x - a.x) + (p.y - a.y) * (b.y - a.y)) / ((b.x - a.x) ** 2 + (b.y - a.y) ** 2 || 1);
  const share = Math.min(1, Math.max(0, along));
  return far(p, { x: a.x + share * (b.x - a.x), y: a.y + share * (b.y - a.y) });
}

function isInside(p: Point, corners: Point[]): boolean {
  let inside = false;
  corners.forEach((a, i) => {
    const b = corners[(i + 1) % corners.length]!;
    if ((a.y > p.y) !== (b.y > p.y) && p.x < a.x + (b.x - a.x) * (p.y - a.y) / (b.y - a.y)) inside = !inside;
  });
  return inside;
}

const areaOf = (zone: Zone): number => Math.abs(zone.corners.reduce((sum, a, i) => { const b = zone.corners[(i + 1) % zone.corners.length]!; return sum + a.x * b.y - b.x * a.y; }, 0)) / 2;

export class PlacesTools implements Guest {
  tool: Kind | null = null;
  drawing: Point[] = [];
  hover: Point | null = null;
  laneFrom: number | null = null;
  private held: Held | null = null;

  constructor(private readonly editor: PlacesEditor, private readonly view: View, private readonly snap: Snap,
    private readonly changed: () => void, private readonly say: (words: string) => void) {}

  take(tool: Kind | null): void {
    this.tool = this.tool === tool ? null : tool;
    [this.drawing, this.laneFrom, this.held] = [[], null, null];
    this.editor.preview = null;
    this.say(this.tool === null ? '' : this.tool === 'keep_out' || this.tool === 'speed_zone' ? 'Click its corners; Enter, or a click on the first one, closes it; Escape ends'
      : this.tool === 'edge' ? 'Click where the lane begins, then where it ends: places, nodes, or the floor for a new node; Escape ends' : 'Click where it is; Escape ends');
    this.changed();
  }

  /** Takes the last corner back. */
  takeBack(): void {
    this.drawing = this.drawing.slice(0, -1);
    this.changed();
  }

  private round(p: Point): Point {
    const step = this.snap.on ? this.snap.gridM : 0.001;
    return { x: tidy(Math.round(p.x / step) * step), y: tidy(Math.round(p.y / step) * step) };
  }

  // -- new items ----------------------------------------------------------------------------------------------

  click(at: Point): void {
    const p = this.round(at);
    if (this.tool === null) return this.editor.select(this.itemAt(at)?.key ?? null);
    if (this.tool === 'place' || this.tool === 'node') return this.addSpot(this.tool, p);
    if (this.tool === 'edge') return this.clickLane(at, p);
    const first = this.drawing[0];
    if (first && this.drawing.length > 2 && far(this.view.toScreen(first), this.view.toScreen(at)) < nearPx) return this.close();
    if (this.drawing.some((other) => far(other, p) < 1e-9)) return;
    this.drawing = [...this.drawing, p];
    this.changed();
  }

  addSpot(kind: 'place' | 'node', p: Point): void {
    this.editor.add({ key: this.editor.key(), kind, name: this.editor.freeName(kind), x: p.x, y: p.y, yawDeg: null });
  }

  addZone(kind: 'keep_out' | 'speed_zone', corners: Point[]): void {
    this.editor.add({ key: this.editor.key(), kind, name: this.editor.freeName(kind), corners, maxMps: kind === 'speed_zone' ? usualMps : null });
  }

  /** Ends the polygon that is being drawn. */
  close(): void {
    if (this.tool !== 'keep_out' && this.tool !== 'speed_zone') return;
    if (this.drawing.length < 3) return this.say('A zone needs three corners');
    const [kind, corners] = [this.tool, this.drawing];
    this.take(null);
    this.addZone(kind, corners);
  }

  private clickLane(at: Point, p: Point): void {
    const hit = this.spotAt(this.view.toScreen(at));
    const spot: Spot = hit ?? { key: this.editor.key(), kind: 'node', name: this.editor.freeName('node'), x: p.x, y: p.y, yawDeg: null };
    const from = this.laneFrom;
    const isNew = hit ? [] : [spot];
    this.laneFrom = spot.key;
    const isThere = this.editor.state.items.some((i) => isLane(i) && ((i.from === from && i.to === spot.key) || (!i.oneWay && i.to === from && i.from === spot.key)));
    if (from === null || from === spot.key || isThere) return isNew.length > 0 ? this.editor.add(...isNew) : this.editor.select(spot.key);
    this.editor.add(...isNew, { key: this.editor.key(), kind: 'edge', from, to: spot.key, oneWay: false, maxMps: null });
  }

  // -- what is there ------------------------------------------------------------------------------------------

  private spotAt(screen: Point): Spot | undefined {
    return this.editor.state.items.filter(isSpot).find((s) => far(this.view.toScreen(s), screen) < nearPx);
  }

  private itemAt(at: Point): Item | undefined {
    const screen = this.view.toScreen(at);
    const ends = (key: number) => this.view.toScreen(this.editor.spot(key)!);
    return this.spotAt(screen) ?? this.editor.state.items.filter(isLane).find((l) => distanceTo(screen, ends(l.from), ends(l.to)) < 8)
      ?? this.editor.state.items.filter(isZone).filter((z) => isInside(at, z.corners)).sort((a, b) => areaOf(a) - areaOf(b))[0];
  }

  press(screen: Point): boolean {
    if (this.tool !== null) return false;
    this.held = this.heldAt(screen);
    return this.held !== null;
  }

  private heldAt(screen: Point): Held | null {
    const chosen = this.editor.find(this.editor.selected);
    if (chosen && isZone(chosen)) {
      const points = chosen.corners.map((p) => this.view.toScreen(p));
      const index = points.findIndex((p) => far(p, screen) < nearPx);
      if (index >= 0) {
        this.editor.select(chosen.key, index);
        return { kind: 'corner', zone: chosen, index };
      }
      const side = points.findIndex((p, i) => { const next = points[(i + 1) % points.length]!; return far({ x: (p.x + next.x) / 2, y: (p.y + next.y) / 2 }, screen) < nearPx; });
      if (side >= 0) return { kind: 'corner', zone: { ...chosen, corners: chosen.corners.toSpliced(side + 1, 0, this.round(this.view.toMap(screen))) }, index: side + 1 };
    }
    if (chosen?.kind === 'place' && far(headOf(this.view, this.view.toScreen(chosen), chosen.yawDeg ?? 0), screen) < nearPx) return { kind: 'heading', spot: chosen };
    const spot = this.spotAt(screen);
    if (spot) {
      this.editor.select(spot.key);
      return { kind: 'spot', spot };
    }
    if (chosen && isZone(chosen) && isInside(this.view.toMap(screen), chosen.corners)) return { kind: 'zone', zone: chosen, from: this.view.toMap(screen) };
    return null;
  }

  drag(screen: Point): void {
    const held = this.held;
    const at = this.round(this.view.toMap(screen));
    if (!held) return;
    if (held.kind === 'corner') this.editor.preview = { ...held.zone, corners: held.zone.corners.with(held.index, at) };
    else if (held.kind === 'spot') this.editor.preview = { ...held.spot, ...at };
    else if (held.kind === 'heading') this.editor.preview = { ...held.spot, yawDeg: this.headingTo(held.spot, screen) };
    else {
      const by = this.round({ x: this.view.toMap(screen).x - held.from.x, y: this.view.toMap(screen).y - held.from.y });
      this.editor.preview = { ...held.zone, corners: held.zone.corners.map((p) => ({ x: tidy(p.x + by.x), y: tidy(p.y + by.y) })) };
    }
    this.changed();
  }

  private headingTo(spot: Spot, screen: Point): number {
    const p = this.view.toMap(screen);
    const step = this.snap.on ? this.snap.angleDeg : 1;
    return tidy(Math.round(degrees(Math.atan2(p.y - spot.y, p.x - spot.x)) / step) * step);
  }

  release(): void {
    const held = this.held;
    this.held = null;
    if (this.editor.preview) {
      if (held?.kind === 'corner') this.editor.corner = held.index;
      this.editor.change(this.editor.preview);
    }
  }

  /** Moves what is selected, or the chosen corner of it. */
  nudge(x: number, y: number): void {
    const item = this.editor.find(this.editor.selected);
    const moved = (p: Point): Point => ({ x: tidy(p.x + x), y: tidy(p.y + y) });
    if (item && isSpot(item)) this.editor.change({ ...item, ...moved(item) });
    if (item && isZone(item)) this.editor.change({ ...item, corners: item.corners.map((p, i) => this.editor.corner === null || this.editor.corner === i ? moved(p) : p) });
  }
}
