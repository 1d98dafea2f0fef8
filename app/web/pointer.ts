// Pointer gestures on the stage: pan, zoom, select, drag, rotate, marquee.
import { centerOf, degrees, tidy, transform, wrapDeg } from './geometry.js';
import type { Marker, Point } from './geometry.js';
import { isOn } from './marker_paint.js';
import type { Stage } from './stage.js';

export interface Snap { on: boolean; gridM: number; angleDeg: number }

/** Handles clicks and drags on the map instead of the editor: in screen coordinates, but map coordinates for a click. */
export interface Guest {
  press(screen: Point): boolean;
  drag(screen: Point): void;
  release(): void;
  click(at: Point, also: boolean): void;
}

type Gesture =
  | { kind: 'guest'; guest: Guest }
  | { kind: 'pan' }
  | { kind: 'marquee' }
  | { kind: 'move'; before: Marker[]; leader: Marker; from: Point }
  | { kind: 'rotate'; before: Marker[]; pivot: Point; fromDeg: number };

const clickSlackPx = 4;

export class Pointer {
  snap: Snap = { on: true, gridM: 0.05, angleDeg: 15 };
  /** Set while a point on the map is requested: receives the next click. */
  pick: ((at: Point, marker: Marker | null) => void) | null = null;
  private pickOver: () => void = () => {};
  guest: Guest | null = null;
  onHover: (at: Point | null) => void = () => {};
  onDrag: () => void = () => {};

  private gesture: Gesture | null = null;
  private down: Point = { x: 0, y: 0 };
  private last: Point = { x: 0, y: 0 };
  private moved = false;
  private readonly fingers = new Map<number, Point>();

  constructor(private readonly stage: Stage) {
    const element = stage.element;
    element.addEventListener('pointerdown', (e) => this.press(e));
    element.addEventListener('pointermove', (e) => this.move(e));
    element.addEventListener('pointerup', (e) => this.release(e));
    element.addEventListener('pointercancel', (e) => { this.fingers.delete(e.pointerId); this.cancel(); });
    element.addEventListener('pointerleave', () => this.onHover(null));
    element.addEventListener('wheel', (e) => {
      e.preventDefault();
      stage.view.zoomAt(this.at(e), Math.exp(-e.deltaY * (e.deltaMode === 1 ? 0.05 : 0.0015)));
      stage.redraw();
    }, { passive: false });
  }

  /** Requests points; `over`: called when it ends, whoever ends it. One request at a time. */
  beginPick(pick: (at: Point, marker: Marker | null) => void, over: () => void): void {
    this.endPick();
    [this.pick, this.pickOver] = [pick, over];
  }

  endPick(): void {
    const over = this.pickOver;
    [this.pick, this.pickOver] = [null, () => {}];
    over();
  }

  /** Restores the state before the gesture. */
  cancel(): void {
    this.gesture = null;
    this.stage.marquee = null;
    this.stage.editor.preview.clear();
    this.onDrag();
  }

  markerAt(screen: Point): Marker | null {
    const { editor, view } = this.stage;
    const p = view.toMap(screen);
    let found: Marker | null = null;
    for (const marker of editor.shown()) {
      if (isOn(marker, p, 9 / view.pixelsPerM) && (!found || editor.selection.has(marker.key))) found = marker;
    }
    return found;
  }

  private at(e: MouseEvent): Point {
    const box = this.stage.element.getBoundingClientRect();
    return { x: e.clientX - box.left, y: e.clientY - box.top };
  }

  private press(e: PointerEvent): void {
    const { editor, view, element } = this.stage;
    this.fingers.set(e.pointerId, this.at(e));
    if (this.fingers.size === 2) return this.cancel();
    this.down = this.last = this.at(e);
    this.moved = false;
    element.setPointerCapture(e.pointerId);
    element.focus({ preventScroll: true });
    const marker = this.markerAt(this.down);
    if (this.pick && e.button === 0) {
      this.pick(view.toMap(this.down), marker);
      return;
    }
    if (this.guest) {
      this.gesture = e.button === 0 && this.guest.press(this.down) ? { kind: 'guest', guest: this.guest } : { kind: 'pan' };
      return;
    }
    const handle = this.stage.rotateHandle();
    if (e.button !== 0) {
      this.gesture = { kind: 'pan' };
    } else if (handle && Math.hypot(handle.x - this.down.x, handle.y - this.down.y) < 11) {
      const before = editor.chosen();
      const pivot = editor.pivot(before);
      this.gesture = { kind: 'rotate', before, pivot, fromDeg: this.angleAbout(pivot, this.down) };
    } else if (marker) {
      if (e.shiftKey || e.ctrlKey || e.metaKey) this.toggle(marker.key);
      else if (!editor.selection.has(marker.key)) editor.select([marker.key]);
      const before = editor.chosen();
      const leader = before.find((m) => m.key === marker.key);
      this.gesture = leader ? { kind: 'move', before, leader, from: view.toMap(this.down) } : null;
    } else {
      this.gesture = { kind: e.shiftKey ? 'marquee' : 'pan' };
    }
  }

  private toggle(key: number): void {
    const keys = new Set(this.stage.editor.selection);
    if (!keys.delete(key)) keys.add(key);
    this.stage.editor.select(keys);
  }

  private move(e: PointerEvent): void {
    const now = this.at(e);
    const { view } = this.stage;
    if (this.fingers.size > 1) return this.pinch(e.pointerId, now);
    this.onHover(view.toMap(now));
    const gesture = this.gesture;
    if (!gesture) return;
    if (!this.moved && Math.hypot(now.x - this.down.x, now.y - this.down.y) < clickSlackPx) return;
    this.moved = true;
    const snapping = this.snap.on && !e.altKey;
    switch (gesture.kind) {
      case 'guest':
        gesture.guest.drag(now);
        break;
      case 'pan':
        this.stage.pan(now.x - this.last.x, now.y - this.last.y);
        break;
      case 'marquee':
        this.stage.marquee = { a: this.down, b: now };
        this.stage.redraw();
        break;
      case 'move':
        this.preview(this.movedBy(gesture.before, gesture.leader, gesture.from, view.toMap(now), snapping));
        break;
      case 'rotate':
        this.preview(this.rotatedBy(gesture.before, gesture.pivot,
          this.angleAbout(gesture.pivot, now) - gesture.fromDeg, snapping));
        break;
    }
    this.last = now;
  }

  /** Two fingers zoom about the middle between them, and pan. */
  private pinch(id: number, now: Point): void {
    const before = this.fingers.get(id);
    const other = [...this.fingers].find(([key]) => key !== id)?.[1];
    if (!before || !other) return;
    this.fingers.set(id, now);
    this.moved = true;
    const middle = { x: (now.x + other.x) / 2, y: (now.y + other.y) / 2 };
    this.stage.pan((now.x - before.x) / 2, (now.y - before.y) / 2);
    this.stage.view.zoomAt(middle, Math.hypot(now.x - other.x, now.y - other.y) / Math.max(1, Math.hypot(before.x - other.x, before.y - other.y)));
    this.stage.redraw();
  }

  private movedBy(before: Marker[], leader: Marker, from: Point, to: Point, snapping: boolean): Marker[] {
    const grid = this.snap.gridM;
    const place = (value: number) => snapping ? Math.round(value / grid) * grid : value;
    const dx = place(leader.x + to.x - from.x) - leader.x;
    const dy = place(leader.y + to.y - from.y) - leader.y;
    return before.map((m) => ({ ...m, x: rounded(m.x + dx, snapping), y: rounded(m.y + dy, snapping) }));
  }

  private rotatedBy(before: Marker[], pivot: Point, byDeg: number, snapping: boolean): Marker[] {
    const step = this.snap.angleDeg;
    const alone = before.length === 1 ? before[0]!.yawDeg : 0;  // one marker snaps to a yaw, several to a rotation angle
    const turn = snapping ? Math.round((alone + byDeg) / step) * step - alone : Math.round(byDeg * 10) / 10;
    return turned(before, pivot, turn);
  }

  private preview(markers: Marker[]): void {
    this.stage.editor.preview = new Map(markers.map((m) => [m.key, m]));
    this.onDrag();
  }

  private release(e: PointerEvent): void {
    const { editor, marquee } = this.stage;
    this.fingers.delete(e.pointerId);
    const gesture = this.gesture;
    this.gesture = null;
    this.stage.marquee = null;
    if (gesture?.kind === 'marquee' && marquee) this.chooseWithin(marquee.a, marquee.b, editor.selection);
    else if (gesture && editor.preview.size > 0) editor.change([...editor.preview.values()]);
    else if (gesture?.kind === 'guest') gesture.guest.release();
    else if (gesture?.kind === 'pan' && !this.moved && e.button === 0) this.clickOnFloor(e.shiftKey);
    this.stage.redraw();
  }

  private clickOnFloor(also: boolean): void {
    if (this.guest) this.guest.click(this.stage.view.toMap(this.down), also);
    else this.stage.editor.select([]);
  }

  private chooseWithin(a: Point, b: Point, also: Set<number>): void {
    const inside: number[] = [];
    for (const marker of this.stage.editor.shown()) {
      const p = this.stage.view.toScreen(centerOf(marker));
      if ((p.x - a.x) * (p.x - b.x) <= 0 && (p.y - a.y) * (p.y - b.y) <= 0) inside.push(marker.key);
    }
    this.stage.editor.select([...also, ...inside]);
  }

  private angleAbout(pivot: Point, screen: Point): number {
    const p = this.stage.view.toMap(screen);
    return degrees(Math.atan2(p.y - pivot.y, p.x - pivot.x));
  }
}

/** Rounds free drags to a millimetre; snapped values stay exact. */
const rounded = (value: number, exact: boolean): number => exact ? tidy(value) : Math.round(value * 1000) / 1000;

export function turned(markers: Marker[], pivot: Point, byDeg: number): Marker[] {
  return markers.map((m) => {
    const at = transform({ ...pivot, yawDeg: byDeg }, { x: m.x - pivot.x, y: m.y - pivot.y });
    return { ...m, x: tidy(at.x), y: tidy(at.y), yawDeg: wrapDeg(m.yawDeg + byDeg) };
  });
}
