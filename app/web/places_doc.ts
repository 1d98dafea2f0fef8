// What people name on a map: zones, places, nodes and lanes, as a document with undo. Lengths in metres.
import { tidy } from './geometry.js';
import type { Point } from './geometry.js';

export interface Zone { key: number; kind: 'keep_out' | 'speed_zone'; name: string; corners: Point[]; maxMps: number | null }
export interface Spot extends Point { key: number; kind: 'place' | 'node'; name: string; yawDeg: number | null }
/** From and to are keys of spots, so that a lane follows when they are renamed. */
export interface Lane { key: number; kind: 'edge'; from: number; to: number; oneWay: boolean; maxMps: number | null }
export type Item = Zone | Spot | Lane;
export type Kind = Item['kind'];

export const listOfKind: Record<Kind, ListName> = { place: 'places', node: 'nodes', edge: 'edges', keep_out: 'keep_out', speed_zone: 'speed_zones' };
export const kindWords: Record<Kind, string> = { place: 'Place', node: 'Node', edge: 'Lane', keep_out: 'Keep-out', speed_zone: 'Speed zone' };

/** places.yaml as the server hands it out. */
export interface PlacesDocument {
  format: string; version: number;
  places: { name: string; x_m: number; y_m: number; yaw_deg?: number }[];
  nodes: { name: string; x_m: number; y_m: number }[];
  edges: { from: string; to: string; one_way?: boolean; max_mps?: number }[];
  keep_out: { name?: string; corners_m: [number, number][] }[];
  speed_zones: { name?: string; corners_m: [number, number][]; max_mps: number }[];
  missions: NamedMission[];
}
/** Names alone, or with what is done at each stop; all of it `repeat` times. */
export interface NamedMission { name: string; places?: string[]; stops?: { place: string; wait_s?: number; action?: string }[]; repeat?: number }
export const stopsOf = (mission: NamedMission): { place: string; wait_s?: number; action?: string }[] => mission.stops ?? (mission.places ?? []).map((place) => ({ place }));

/** "round: A (5 s) → B (pick), 2 times" without the name. */
export function missionWords(mission: NamedMission): string {
  const stops = stopsOf(mission).map((stop) => `${stop.place}${stop.wait_s === undefined ? '' : ` (${stop.wait_s} s)`}${stop.action === undefined ? '' : ` (${stop.action})`}`);
  return `${stops.join(' → ')}${mission.repeat === undefined ? '' : `, ${mission.repeat} times`}`;
}
export type ListName = 'places' | 'nodes' | 'edges' | 'keep_out' | 'speed_zones';

export interface Stop { readonly place: number; readonly waitS: number; readonly action: string }
/** Places are keys of spots, so that a mission follows when they are renamed. */
export interface MissionItem { readonly key: number; readonly name: string; readonly stops: readonly Stop[]; readonly repeat: number }
export interface State { readonly items: readonly Item[]; readonly missions: readonly MissionItem[] }

export const isZone = (item: Item): item is Zone => item.kind === 'keep_out' || item.kind === 'speed_zone';
export const isSpot = (item: Item): item is Spot => item.kind === 'place' || item.kind === 'node';
export const isLane = (item: Item): item is Lane => item.kind === 'edge';

export class PlacesEditor {
  state: State = { items: [], missions: [] };
  selected: number | null = null;
  corner: number | null = null;  // of the selected zone
  /** Drawn instead of the item with its key while it is dragged. */
  preview: Item | null = null;
  onChange: () => void = () => {};

  private done: State[] = [];
  private undone: State[] = [];
  private saved: State = this.state;
  private nextKey = 1;

  load(document: PlacesDocument): void {
    [this.done, this.undone] = [[], []];
    this.state = this.saved = this.read(document);
    this.select(null);
  }

  key(): number { return this.nextKey++; }
  get dirty(): boolean { return this.state !== this.saved && JSON.stringify(this.document()) !== JSON.stringify(this.documentOf(this.saved)); }
  get canUndo(): boolean { return this.done.length > 0; }
  get canRedo(): boolean { return this.undone.length > 0; }
  markSaved(): void { this.saved = this.state; this.onChange(); }

  shown(): Item[] { return this.state.items.map((item) => item.key === this.preview?.key ? this.preview : item); }
  find(key: number | null): Item | undefined { return this.state.items.find((item) => item.key === key); }
  spot(key: number): Spot | undefined { const item = this.shown().find((i) => i.key === key); return item && isSpot(item) ? item : undefined; }
  get chosen(): Item | undefined { return this.shown().find((item) => item.key === this.selected); }

  select(key: number | null, corner: number | null = null): void {
    [this.selected, this.corner, this.preview] = [key, corner, null];
    this.onChange();
  }

  perform(state: State): void {
    this.done.push(this.state);
    this.undone = [];
    this.show(state);
  }

  private show(state: State): void {
    this.state = state;
    this.preview = null;
    const chosen = this.find(this.selected);
    if (!chosen) this.selected = null;
    if (!chosen || !isZone(chosen) || (this.corner ?? 0) >= chosen.corners.length) this.corner = null;
    this.onChange();
  }

  undo(): void { this.shift(this.done, this.undone); }
  redo(): void { this.shift(this.undone, this.done); }
  private shift(from: State[], to: State[]): void {
    const state = from.pop();
    if (state === undefined) return;
    to.push(this.state);
    this.show(state);
  }

  /** Replaces an item by another with the same key. */
  change(item: Item): void {
    if (JSON.stringify(this.find(item.key)) === JSON.stringify(item)) return this.select(this.selected, this.corner);
    this.perform({ ...this.state, items: this.state.items.map((other) => other.key === item.key ? item : other) });
  }

  /** In one step; the last of them becomes the selected one. */
  add(...items: Item[]): void {
    this.selected = items.at(-1)!.key;
    this.corner = null;
    this.perform({ ...this.state, items: [...this.state.items, ...items] });
  }

  /** With its lanes, and the routes over it; in words what went with it. */
  remove(key: number): string {
    const lanes = this.state.items.filter((i) => isLane(i) && (i.from === key || i.to === key));
    const routes = this.state.missions.filter((m) => m.stops.some((stop) => stop.place === key));
    this.perform({ items: this.state.items.filter((i) => i.key !== key && !lanes.includes(i)), missions: this.state.missions.filter((m) => !routes.includes(m)) });
    const with_ = [...(lanes.length > 0 ? [`${lanes.length} of its lanes`] : []), ...routes.map((r) => `the mission ${r.name}`)];
    return with_.length > 0 ? `Deleted, with ${with_.join(' and ')}; undo brings them back` : 'Deleted; undo brings it back';
  }

  replaceAll(document: PlacesDocument): void { this.perform(this.read(document)); }

  /** "Keep-out 2": the first that is free. */
  freeName(kind: Kind): string {
    const names = new Set(this.state.items.map((i) => isLane(i) ? '' : i.name));
    for (let n = 1; ; ++n) {
      const name = kind === 'node' ? `N${n}` : `${kindWords[kind]} ${n}`;
      if (!names.has(name)) return name;
    }
  }

  titleOf(item: Item): string {
    if (isLane(item)) return `${this.spot(item.from)?.name ?? '?'} ${item.oneWay ? '→' : '↔'} ${this.spot(item.to)?.name ?? '?'}`;
    return item.name || kindWords[item.kind];
  }

  // -- the document -------------------------------------------------------------------------------------------

  document(): PlacesDocument { return this.documentOf(this.state); }
  /** The item to which the server's refusal of a document refers. */
  itemAt(list: ListName, index: number): Item | undefined { return this.state.items.filter((item) => listOfKind[item.kind] === list)[index]; }

  private documentOf(state: State): PlacesDocument {
    const names = new Map(state.items.filter(isSpot).map((s) => [s.key, s.name]));
    const zone = (z: Zone) => ({ ...(z.name === '' ? {} : { name: z.name }), corners_m: z.corners.map((p): [number, number] => [p.x, p.y]) });
    const of = <T extends Item>(kind: Kind): T[] => state.items.filter((i): i is T => i.kind === kind);
    return {
      format: 'lodestar-places', version: 1,
      places: of<Spot>('place').map((p) => ({ name: p.name, x_m: p.x, y_m: p.y, ...(p.yawDeg === null ? {} : { yaw_deg: p.yawDeg }) })),
      nodes: of<Spot>('node').map((n) => ({ name: n.name, x_m: n.x, y_m: n.y })),
      edges: of<Lane>('edge').map((e) => ({ from: names.get(e.from)!, to: names.get(e.to)!, ...(e.oneWay ? { one_way: true } : {}), ...(e.maxMps === null ? {} : { max_mps: e.maxMps }) })),
      keep_out: of<Zone>('keep_out').map(zone),
      speed_zones: of<Zone>('speed_zone').map((z) => ({ ...zone(z), max_mps: z.maxMps! })),
      missions: state.missions.map((m) => missionOf(m, names)),
    };
  }

  private read(document: PlacesDocument): State {
    const place = document.places.map((p): Spot => ({ key: this.key(), kind: 'place', name: p.name, x: p.x_m, y: p.y_m, yawDeg: p.yaw_deg ?? null }));
    const node = document.nodes.map((p): Spot => ({ key: this.key(), kind: 'node', name: p.name, x: p.x_m, y: p.y_m, yawDeg: null }));
    const keys = new Map([...place, ...node].map((s) => [s.name, s.key]));
    const lanes = document.edges.map((e): Lane => ({ key: this.key(), kind: 'edge', from: keys.get(e.from)!, to: keys.get(e.to)!, oneWay: e.one_way ?? false, maxMps: e.max_mps ?? null }));
    const corners = (list: [number, number][]) => list.map(([x, y]) => ({ x: tidy(x), y: tidy(y) }));
    const out = document.keep_out.map((z): Zone => ({ key: this.key(), kind: 'keep_out', name: z.name ?? '', corners: corners(z.corners_m), maxMps: null }));
    const slow = document.speed_zones.map((z): Zone => ({ key: this.key(), kind: 'speed_zone', name: z.name ?? '', corners: corners(z.corners_m), maxMps: z.max_mps }));
    return { items: [...place, ...node, ...lanes, ...out, ...slow], missions: document.missions.map((m) => ({ key: this.key(), name: m.name, repeat: m.repeat ?? 1,
      stops: stopsOf(m).map((stop) => ({ place: keys.get(stop.place)!, waitS: stop.wait_s ?? 0, action: stop.action ?? '' })) })) };
  }

  /** Replaces the mission with its key, or adds it. */
  setMission(mission: MissionItem): void {
    const { missions } = this.state;
    const isThere = missions.some((m) => m.key === mission.key);
    this.perform({ ...this.state, missions: isThere ? missions.map((m) => m.key === mission.key ? mission : m) : [...missions, mission] });
  }

  removeMission(key: number): void { this.perform({ ...this.state, missions: this.state.missions.filter((m) => m.key !== key) }); }
}

/** As the file has it: names alone where nothing is done at the stops. */
export function missionOf(mission: MissionItem, names: Map<number, string>): NamedMission {
  const repeat = mission.repeat > 1 ? { repeat: mission.repeat } : {};
  const name = (stop: Stop) => names.get(stop.place)!;
  if (mission.stops.every((stop) => stop.waitS === 0 && stop.action === '')) return { name: mission.name, places: mission.stops.map(name), ...repeat };
  return { name: mission.name, stops: mission.stops.map((stop) => ({ place: name(stop), ...(stop.waitS > 0 ? { wait_s: stop.waitS } : {}), ...(stop.action === '' ? {} : { action: stop.action }) })), ...repeat };
}
