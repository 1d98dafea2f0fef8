// What a new site's page shows beside its steps: the plan, on which two points give the scale, then the map, which can be
// drawn on. Wheel and pinch zoom; the middle or the right button, and two fingers, move the picture.
import { coloursNow, pixelOf } from './colours.js';
import { byId, el } from './dom.js';
import type { Point } from './geometry.js';
import { floor, outside, wall } from './map_paint.js';
import type { Cell, MapPaint } from './map_paint.js';
import { View } from './view.js';

export type Tool = 'line' | 'rectangle' | 'fill';
const pxPerUnit = 100;  // of a plan: the view is made for metres
const fewCells = 20_000;  // are painted one by one
const brushCells = 3;   // of what erases: walls are one cell wide

export class NewStage {
  readonly view = new View();
  readonly canvas = el('canvas', { id: 'new-canvas' });
  points: Point[] = [];  // pixels of the plan, from its upper left corner
  tool: Tool = 'line';
  value: Cell = wall;
  drawable = true;  // or else it is only looked at
  onPoints: () => void = () => {};
  onStroke: () => void = () => {};
  private plan: { image: ImageBitmap; width: number; height: number } | null = null;
  private paint: MapPaint | null = null;
  private readonly tiles = el('canvas');
  private from: Point | null = null;
  private at: Point | null = null;
  private readonly fingers = new Map<number, Point>();

  constructor() {
    byId('stage').append(this.canvas);
    new ResizeObserver(() => this.resize()).observe(byId('stage'));
    new MutationObserver(() => this.changeColours()).observe(document.documentElement, { attributeFilter: ['data-theme'] });
    this.listen();
  }

  showPlan(image: ImageBitmap, width: number, height: number): void {
    this.plan = { image, width, height };
    this.paint = null;
    this.points = [];
    this.fit();
  }

  showMap(paint: MapPaint): void {
    this.paint = paint;
    this.plan = null;
    [this.tiles.width, this.tiles.height] = [paint.columns, paint.rows];
    this.paintAll(this.tiles.getContext('2d')!, paint);
    paint.onChange = () => { this.redraw(); this.onStroke(); };
    this.fit();
  }

  private changeColours(): void {
    if (this.paint === null) return;
    this.paintAll(this.tiles.getContext('2d')!, this.paint);
    this.redraw();
  }

  fit(): void {
    this.resize();
    if (this.plan) this.view.fit([{ x: 0, y: 0 }, { x: this.plan.width / pxPerUnit, y: -this.plan.height / pxPerUnit }], 0.01);
    if (this.paint) this.view.fit([{ x: 0, y: 0 }, { x: this.paint.columns, y: this.paint.rows }]);
    this.redraw();
  }

  private resize(): void {
    const { clientWidth, clientHeight } = byId('stage');
    const density = devicePixelRatio;
    [this.view.width, this.view.height] = [clientWidth, clientHeight];
    [this.canvas.width, this.canvas.height] = [clientWidth * density, clientHeight * density];
    this.canvas.style.width = `${clientWidth}px`;
    this.canvas.style.height = `${clientHeight}px`;
    this.redraw();
  }

  redraw(): void {
    const c = this.canvas.getContext('2d')!;
    c.setTransform(devicePixelRatio, 0, 0, devicePixelRatio, 0, 0);
    c.clearRect(0, 0, this.view.width, this.view.height);
    if (this.plan) this.paintPlan(c, this.plan);
    if (this.paint) this.paintMap(c, this.paint);
  }

  private paintPlan(c: CanvasRenderingContext2D, plan: NonNullable<NewStage['plan']>): void {
    const corner = this.view.toScreen({ x: 0, y: 0 });
    const scale = this.view.pixelsPerM / pxPerUnit;
    c.drawImage(plan.image, corner.x, corner.y, plan.width * scale, plan.height * scale);
    c.strokeStyle = c.fillStyle = '#c2185b';
    c.lineWidth = 2;
    const drawn = this.points.map((p) => this.view.toScreen({ x: p.x / pxPerUnit, y: -p.y / pxPerUnit }));
    for (const p of drawn) {
      c.beginPath();
      c.arc(p.x, p.y, 6, 0, 2 * Math.PI);
      c.moveTo(p.x - 10, p.y); c.lineTo(p.x + 10, p.y);
      c.moveTo(p.x, p.y - 10); c.lineTo(p.x, p.y + 10);
      c.stroke();
    }
    if (drawn.length === 2) {
      c.beginPath();
      c.moveTo(drawn[0]!.x, drawn[0]!.y);
      c.lineTo(drawn[1]!.x, drawn[1]!.y);
      c.stroke();
    }
  }

  private paintMap(c: CanvasRenderingContext2D, paint: MapPaint): void {
    const tiles = this.tiles.getContext('2d')!;
    if (paint.changed.length > fewCells) this.paintAll(tiles, paint);
    for (const index of paint.changed.splice(0)) {
      tiles.fillStyle = `rgb(${inkOf(paint.cells[index]!).join(' ')})`;
      tiles.fillRect(index % paint.columns, paint.rows - 1 - Math.floor(index / paint.columns), 1, 1);
    }
    const corner = this.view.toScreen({ x: 0, y: paint.rows });
    c.imageSmoothingEnabled = false;
    c.drawImage(this.tiles, corner.x, corner.y, paint.columns * this.view.pixelsPerM, paint.rows * this.view.pixelsPerM);
    if (this.tool !== 'rectangle' || !this.from || !this.at) return;
    const a = this.view.toScreen(this.from), b = this.view.toScreen(this.at);
    c.strokeStyle = '#c2185b';
    c.strokeRect(a.x, a.y, b.x - a.x, b.y - a.y);
  }

  private paintAll(tiles: CanvasRenderingContext2D, paint: MapPaint): void {
    const picture = new ImageData(paint.columns, paint.rows);
    const pixels = new Uint32Array(picture.data.buffer);
    const [onWall, onFloor, unknown] = [pixelOf(inkOf(wall)), pixelOf(inkOf(floor)), pixelOf(inkOf(outside))];
    for (let row = 0; row < paint.rows; ++row) {
      for (let column = 0; column < paint.columns; ++column) {
        const cell = paint.cells[row * paint.columns + column];
        pixels[(paint.rows - 1 - row) * paint.columns + column] = cell === wall ? onWall : cell === floor ? onFloor : unknown;
      }
    }
    tiles.putImageData(picture, 0, 0);
    paint.changed.length = 0;
  }

  private placeOf(e: PointerEvent | WheelEvent): Point {
    const box = this.canvas.getBoundingClientRect();
    return { x: e.clientX - box.left, y: e.clientY - box.top };
  }

  /** The stage below has gestures of its own. */
  private listen(): void {
    for (const name of ['pointerdown', 'pointermove', 'pointerup', 'pointercancel', 'wheel', 'dblclick'] as const) this.canvas.addEventListener(name, (e) => e.stopPropagation());
    this.canvas.addEventListener('pointerdown', (e) => this.press(e));
    this.canvas.addEventListener('pointermove', (e) => this.drag(e));
    for (const name of ['pointerup', 'pointercancel'] as const) this.canvas.addEventListener(name, (e) => this.release(e));
    this.canvas.addEventListener('contextmenu', (e) => e.preventDefault());
    this.canvas.addEventListener('wheel', (e) => {
      e.preventDefault();
      this.view.zoomAt(this.placeOf(e), Math.exp(-e.deltaY / 500));
      this.redraw();
    }, { passive: false });
  }

  private press(e: PointerEvent): void {
    this.canvas.setPointerCapture(e.pointerId);
    this.fingers.set(e.pointerId, this.placeOf(e));
    if (this.fingers.size > 1 || e.button !== 0) return this.stopPainting();
    const at = this.view.toMap(this.placeOf(e));
    if (this.plan) return this.addPoint({ x: at.x * pxPerUnit, y: -at.y * pxPerUnit });
    if (!this.paint || !this.drawable) return;
    this.from = this.at = at;
    this.paint.begin(this.value);
    if (this.tool === 'fill') this.paint.fill(at);
    if (this.tool === 'line') this.paint.line(at, at, this.width);
  }

  private get width(): number { return this.value === wall ? 1 : brushCells; }

  private drag(e: PointerEvent): void {
    const before = this.fingers.get(e.pointerId);
    if (!before) return;
    const now = this.placeOf(e);
    this.fingers.set(e.pointerId, now);
    if (this.from && this.paint) {
      const at = this.view.toMap(now);
      if (this.tool === 'line') this.paint.line(this.at!, at, this.width);
      this.at = at;
      return this.redraw();
    }
    const other = [...this.fingers].find(([id]) => id !== e.pointerId)?.[1];
    if (other) {
      const apart = (p: Point) => Math.max(10, Math.hypot(p.x - other.x, p.y - other.y));
      this.view.zoomAt({ x: (now.x + other.x) / 2, y: (now.y + other.y) / 2 }, apart(now) / apart(before));
    }
    if (other || e.buttons > 1 || !this.drawable) this.view.panBy((now.x - before.x) / (other ? 2 : 1), (now.y - before.y) / (other ? 2 : 1));
    this.redraw();
  }

  private release(e: PointerEvent): void {
    this.fingers.delete(e.pointerId);
    if (!this.from || !this.paint) return;
    if (this.tool === 'rectangle' && e.type === 'pointerup') this.paint.rectangle(this.from, this.at!);
    this.stopPainting();
  }

  private stopPainting(): void {
    const { paint } = this;
    const painted = this.from !== null;
    this.from = this.at = null;
    if (painted) paint?.end();  // which redraws
  }

  private addPoint(at: Point): void {
    this.points = this.points.length === 2 ? [at] : [...this.points, at];
    this.onPoints();
    this.redraw();
  }
}

/** Red, green and blue. */
const inkOf = (cell: number): number[] => {
  const { wall: onWall, free, unknown } = coloursNow();
  return cell === wall ? onWall : cell === floor ? free : unknown;
};

export const valueNamed = (name: string): Cell => name === 'wall' ? wall : name === 'floor' ? floor : outside;
