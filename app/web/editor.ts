// The document being edited: markers and alignment, with undo.
import { centerOf, inverse, isIdentity, tidy, transform, wrapDeg } from './geometry.js';
import type { Marker, Point, Pose } from './geometry.js';

/** One undoable step: each marker before and after; undefined where it does not exist. */
interface Step {
  markers: { key: number; before: Marker | undefined; after: Marker | undefined }[];
  alignment?: { before: Pose; after: Pose };
}

export interface Registry {
  alignment: { x_m: number; y_m: number; yaw_deg: number };
  markers: { id: number; x_m: number; y_m: number; z_m: number; yaw_deg: number }[];
}

export class Editor {
  markers = new Map<number, Marker>();
  alignment: Pose = { x: 0, y: 0, yawDeg: 0 };
  selection = new Set<number>();
  /** Drawn instead of the markers with these keys while something is dragged. */
  preview = new Map<number, Marker>();
  onChange: () => void = () => {};

  private done: Step[] = [];
  private undone: Step[] = [];
  private savedAt: Step | undefined;
  private nextKey = 1;

  /** Loads a document and clears the undo history. */
  load(registry: Registry): void {
    this.markers.clear();
    this.selection.clear();
    this.preview.clear();
    this.done = [];
    this.undone = [];
    this.alignment = { x: registry.alignment.x_m, y: registry.alignment.y_m, yawDeg: registry.alignment.yaw_deg };
    for (const m of registry.markers) this.put(this.fresh(m.id, m.x_m, m.y_m, m.z_m, m.yaw_deg));
    this.markSaved();
  }

  registry(): Registry { return this.registryOf([...this.markers.values()]); }

  /** The same with dragged markers at their present position. */
  draft(): Registry {
    return this.registryOf([...this.markers.values()].map((marker) => {
      const dragged = this.preview.get(marker.key);
      return dragged ? this.fromMap(dragged) : marker;
    }));
  }

  private registryOf(markers: Marker[]): Registry {
    const a = this.alignment;
    return {
      alignment: { x_m: a.x, y_m: a.y, yaw_deg: a.yawDeg },
      markers: markers.map((m) => ({ id: m.id, x_m: m.x, y_m: m.y, z_m: m.z, yaw_deg: m.yawDeg })),
    };
  }

  /** A new marker, not yet in the document, given in the registry's frame. */
  fresh(id: number, x: number, y: number, z: number, yawDeg: number): Marker {
    return { key: this.nextKey++, id, x: tidy(x), y: tidy(y), z: tidy(z), yawDeg: wrapDeg(yawDeg) };
  }

  /** The marker in the map frame. */
  onMap(marker: Marker): Marker {
    if (isIdentity(this.alignment)) return marker;
    const at = transform(this.alignment, marker);
    return { ...marker, ...at, yawDeg: wrapDeg(marker.yawDeg + this.alignment.yawDeg) };
  }

  /** The registry's marker for one in the map frame. */
  fromMap(marker: Marker): Marker {
    const at = isIdentity(this.alignment) ? marker : transform(inverse(this.alignment), marker);
    return {
      ...marker, x: tidy(at.x), y: tidy(at.y), z: tidy(marker.z),
      yawDeg: wrapDeg(marker.yawDeg - this.alignment.yawDeg),
    };
  }

  /** All markers in the map frame, with dragged ones at their present position. */
  * shown(): Generator<Marker> {
    for (const marker of this.markers.values()) yield this.preview.get(marker.key) ?? this.onMap(marker);
  }

  chosen(): Marker[] {
    return [...this.selection].map((key) => this.markers.get(key)).filter((m) => m !== undefined)
      .map((m) => this.onMap(m));
  }

  /** Centre of rotation of a selection: dot O of a single marker, the mean centre of several. */
  pivot(markers: Marker[]): Point {
    if (markers.length === 1) return { x: markers[0]!.x, y: markers[0]!.y };
    const middles = markers.map(centerOf);
    return {
      x: middles.reduce((sum, p) => sum + p.x, 0) / middles.length,
      y: middles.reduce((sum, p) => sum + p.y, 0) / middles.length,
    };
  }

  /** Replaces markers by others with the same keys, given in the map frame. */
  change(markersOnMap: Marker[]): void {
    this.perform(markersOnMap.map((m) => ({ key: m.key, before: this.markers.get(m.key), after: this.fromMap(m) }))
      .filter((c) => c.before !== undefined && !sameMarker(c.before, c.after)));
  }

  add(markers: Marker[]): void {
    this.perform(markers.map((m) => ({ key: m.key, before: undefined, after: m })));
    this.select(markers.map((m) => m.key));
  }

  remove(keys: Iterable<number>): void {
    this.perform([...keys].map((key) => ({ key, before: this.markers.get(key), after: undefined }))
      .filter((c) => c.before !== undefined));
  }

  /** What there is with these added, in the alignment of what there is; one takes the place of that with its ID. */
  joined(registry: Registry): Registry {
    const others = new Editor();
    others.load(registry);
    const come = [...others.shown()].map((m) => this.fromMap(m));
    const ids = new Set(come.map((m) => m.id));
    return this.registryOf([...[...this.markers.values()].filter((m) => !ids.has(m.id)), ...come]);
  }

  /** Replaces everything in one step: an import, a merge, another user's version. */
  replaceAll(registry: Registry): void {
    const gone = [...this.markers.values()].map((m) => ({ key: m.key, before: m, after: undefined }));
    const come = registry.markers.map((m) => this.fresh(m.id, m.x_m, m.y_m, m.z_m, m.yaw_deg))
      .map((m) => ({ key: m.key, before: undefined, after: m }));
    const a = registry.alignment;
    this.perform([...gone, ...come], { x: a.x_m, y: a.y_m, yawDeg: a.yaw_deg });
  }

  align(alignment: Pose): void { this.perform([], alignment); }

  undo(): void { this.shift(this.done, this.undone, 'before'); }
  redo(): void { this.shift(this.undone, this.done, 'after'); }
  get canUndo(): boolean { return this.done.length > 0; }
  get canRedo(): boolean { return this.undone.length > 0; }

  get dirty(): boolean { return this.done.at(-1) !== this.savedAt; }
  markSaved(): void {
    this.savedAt = this.done.at(-1);
    this.onChange();
  }

  select(keys: Iterable<number>): void {
    this.selection = new Set(keys);
    this.onChange();
  }

  private perform(markers: Step['markers'], alignment?: Pose): void {
    if (markers.length === 0 && alignment === undefined) return this.onChange();
    const step: Step = { markers };
    if (alignment !== undefined) step.alignment = { before: this.alignment, after: alignment };
    this.undone = [];
    this.done.push(step);
    this.apply(step, 'after');
  }

  private shift(from: Step[], to: Step[], side: 'before' | 'after'): void {
    const step = from.pop();
    if (step === undefined) return;
    to.push(step);
    this.apply(step, side);
  }

  private apply(step: Step, side: 'before' | 'after'): void {
    for (const change of step.markers) {
      const now = change[side];
      if (now === undefined) this.markers.delete(change.key);
      else this.put(now);
    }
    if (step.alignment) this.alignment = step.alignment[side];
    for (const key of this.selection) if (!this.markers.has(key)) this.selection.delete(key);
    this.preview.clear();
    this.onChange();
  }

  private put(marker: Marker): void { this.markers.set(marker.key, marker); }
}

function sameMarker(a: Marker, b: Marker | undefined): boolean {
  return b !== undefined && a.id === b.id && a.x === b.x && a.y === b.y && a.z === b.z && a.yawDeg === b.yawDeg;
}
