// The three layers: floor (map and coverage), ceiling (markers), overlay (selection, handles, pointers).
import { coloursNow } from './colours.js';
import type { Colours } from './colours.js';
import type { CountedCoverage } from './counted.js';
import type { Box } from './coverage.js';
import type { Floor } from './floor.js';
import type { Editor } from './editor.js';
import { FloorPaint } from './floor_paint.js';
import { font } from './fonts.js';
import { centerOf, pitchM, sideM } from './geometry.js';
import type { Marker, Point } from './geometry.js';
import type { Layers } from './layers.js';
import { drawFromAbove } from './marker_paint.js';
import type { View } from './view.js';

const fineFromPx = 26;   // side of a marker from which its dots are drawn
const labelFromPx = 14;
const handleDistancePx = 46;
const manyMarkers = 1500;  // from this many on, a pan shifts the drawn layers and redraws them at its end

export class Stage {
  marquee: { a: Point; b: Point } | null = null;
  pins: { at: Point; label: string }[] = [];
  /** Drawing callbacks for the overlay. */
  painters: ((c: CanvasRenderingContext2D) => void)[] = [];
  showsSelection = true;
  /** Shown in place of the site's map and markers: those that a run was driven on. */
  scene: { floor: FloorPaint; markers: Marker[] } | null = null;
  readonly floorPaint: FloorPaint;
  private shift: Point = { x: 0, y: 0 };
  private readonly floorLayer: CanvasRenderingContext2D;
  private readonly ceilingLayer: CanvasRenderingContext2D;
  private readonly overlayLayer: CanvasRenderingContext2D;
  private wanted = false;
  private ceilingWanted = false;
  private overlayWanted = false;

  constructor(readonly element: HTMLElement, readonly view: View, readonly editor: Editor,
    readonly floor: Floor, readonly coverage: CountedCoverage, readonly layers: Layers) {
    const context = (id: string) => (document.getElementById(id) as HTMLCanvasElement).getContext('2d')!;
    [this.floorLayer, this.ceilingLayer, this.overlayLayer] = [context('floor'), context('ceiling'), context('overlay')];
    this.floorPaint = new FloorPaint(floor, coverage.counts, layers);
    this.paintRaster();
    new ResizeObserver(() => this.resize()).observe(element);
    this.resize();
  }

  get colours(): Colours { return coloursNow(); }

  resize(): void {
    const ratio = window.devicePixelRatio || 1;
    [this.view.width, this.view.height] = [this.element.clientWidth, this.element.clientHeight];
    for (const layer of [this.floorLayer, this.ceilingLayer, this.overlayLayer]) {
      layer.canvas.width = this.view.width * ratio;
      layer.canvas.height = this.view.height * ratio;
      layer.canvas.style.width = `${this.view.width}px`;
      layer.canvas.style.height = `${this.view.height}px`;
      layer.setTransform(ratio, 0, 0, ratio, 0, 0);
    }
    this.redraw();
  }

  /** Moves the view under the pointer. */
  pan(dx: number, dy: number): void {
    this.view.panBy(dx, dy);
    if (this.editor.markers.size < manyMarkers) return this.redraw();
    this.shiftLayers({ x: this.shift.x + dx, y: this.shift.y + dy });
  }

  private shiftLayers(by: Point): void {
    if (by.x === this.shift.x && by.y === this.shift.y) return;
    this.shift = by;
    for (const layer of [this.floorLayer, this.ceilingLayer, this.overlayLayer]) {
      layer.canvas.style.transform = `translate(${by.x}px, ${by.y}px)`;
    }
  }

  /** Call when theme or the floor's colouring has changed. */
  paintRaster(): void {
    this.floorPaint.paint();
    this.scene?.floor.paint();
  }

  /** Where the coverage has changed. */
  paintCounted(boxes: Box[]): void {
    this.floorPaint.paintCounted(boxes);
    this.redrawDragged();
  }

  /** Draws everything with the next frame. */
  redraw(): void {
    this.ceilingWanted = true;
    this.redrawDragged();
  }

  /** The same during a drag: with very many markers, only the moving ones are redrawn. */
  redrawDragged(): void {
    this.ceilingWanted ||= this.editor.markers.size < manyMarkers;
    if (this.wanted) return;
    this.wanted = true;
    requestAnimationFrame(() => {
      this.wanted = false;
      this.shiftLayers({ x: 0, y: 0 });
      (this.scene?.floor ?? this.floorPaint).draw(this.floorLayer, this.view);
      if (this.ceilingWanted) this.drawCeiling();
      this.drawOverlay();
      this.ceilingWanted = false;
    });
  }

  /** The same for the overlay alone, for moving content. */
  redrawOverlay(): void {
    if (this.wanted || this.overlayWanted) return;
    this.overlayWanted = true;
    requestAnimationFrame(() => {
      this.overlayWanted = false;
      if (this.shift.x === 0 && this.shift.y === 0) this.drawOverlay();
    });
  }

  /** The centre of the marker with this ID. */
  placeOfId(id: number): Point | null {
    for (const marker of this.editor.shown()) if (marker.id === id) return centerOf(marker);
    return null;
  }

  private drawCeiling(): void {
    const { view, ceilingLayer: c, colours } = this;
    c.clearRect(0, 0, view.width, view.height);
    if (!this.layers.shown.markers) return;
    const sidePx = (sideM + 2 * pitchM / 2) * view.pixelsPerM;
    c.font = font(11);
    c.textAlign = 'center';
    const few = this.editor.markers.size < 400;
    for (const marker of this.scene?.markers ?? this.editor.shown()) {
      const middle = view.toScreen(centerOf(marker));
      if (middle.x < -sidePx || middle.y < -sidePx || middle.x > view.width + sidePx || middle.y > view.height + sidePx) continue;
      const chosen = this.showsSelection && this.editor.selection.has(marker.key);
      if (sidePx < 5 && !few) {
        c.fillStyle = chosen ? colours.chosen : colours.ink;
        c.fillRect(middle.x - 1.5, middle.y - 1.5, 3, 3);
        continue;
      }
      drawFromAbove(c, marker, view, chosen ? colours.chosen : colours.marker, colours.dot, sidePx < fineFromPx);
      if (this.layers.shown.ids && (sidePx > labelFromPx || few)) {
        c.strokeStyle = colours.paper;
        c.lineWidth = 3;
        c.lineJoin = 'round';
        c.fillStyle = chosen ? colours.chosen : colours.ink;
        const below = middle.y + Math.max(sidePx * 0.75, 14) + 8;
        c.strokeText(String(marker.id), middle.x, below);  // a rim, so that IDs can be read on walls
        c.fillText(String(marker.id), middle.x, below);
      }
    }
    c.textAlign = 'start';
  }

  /** Screen position of the handle that rotates the selection. */
  rotateHandle(): Point | null {
    const chosen = this.draggedSelection();
    if (chosen.length === 0) return null;
    const pivot = this.view.toScreen(this.editor.pivot(chosen));
    const angle = chosen.length === 1 ? this.view.angleOf(chosen[0]!.yawDeg) : -Math.PI / 2;
    const distance = handleDistancePx + (chosen.length === 1 ? sideM * this.view.pixelsPerM : 0);
    return { x: pivot.x + distance * Math.cos(angle), y: pivot.y + distance * Math.sin(angle) };
  }

  draggedSelection(): Marker[] {
    if (!this.showsSelection) return [];
    return this.editor.chosen().map((m) => this.editor.preview.get(m.key) ?? m);
  }

  drawOverlay(): void {
    const { view, overlayLayer: c, colours } = this;
    c.clearRect(0, 0, view.width, view.height);
    c.strokeStyle = c.fillStyle = colours.chosen;
    c.lineWidth = 1.5;
    const chosen = this.draggedSelection();
    for (const marker of this.layers.shown.reach && chosen.length <= 60 ? chosen : []) {
      const middle = view.toScreen(centerOf(marker));
      c.globalAlpha = 0.6;
      c.beginPath();
      c.arc(middle.x, middle.y, this.coverage.reachM(marker.z) * view.pixelsPerM, 0, 2 * Math.PI);
      c.setLineDash([5, 5]);
      c.stroke();
      c.setLineDash([]);
      c.globalAlpha = 1;
    }
    if (this.editor.markers.size >= manyMarkers) this.drawMoving(c);
    const handle = this.rotateHandle();
    if (handle) {
      const pivot = view.toScreen(this.editor.pivot(chosen));
      c.beginPath();
      c.moveTo(pivot.x, pivot.y); c.lineTo(handle.x, handle.y);
      c.stroke();
      c.beginPath();
      c.arc(handle.x, handle.y, 7, 0, 2 * Math.PI);
      c.fill();
    }
    for (const paint of this.painters) paint(c);
    c.strokeStyle = c.fillStyle = colours.chosen;
    this.drawPins(c);
    if (this.marquee) {
      const { a, b } = this.marquee;
      c.strokeRect(Math.min(a.x, b.x), Math.min(a.y, b.y), Math.abs(a.x - b.x), Math.abs(a.y - b.y));
    }
  }

  /** Draws the dragged markers when the ceiling layer is not redrawn. */
  private drawMoving(c: CanvasRenderingContext2D): void {
    const { view, colours } = this;
    for (const marker of this.editor.preview.values()) drawFromAbove(c, marker, view, colours.chosen, colours.dot, true);
  }

  private drawPins(c: CanvasRenderingContext2D): void {
    c.font = font(13, 'bold');
    for (const pin of this.pins) {
      const at = this.view.toScreen(pin.at);
      c.beginPath();
      c.moveTo(at.x - 9, at.y); c.lineTo(at.x + 9, at.y); c.moveTo(at.x, at.y - 9); c.lineTo(at.x, at.y + 9);
      c.stroke();
      c.fillText(pin.label, at.x + 8, at.y - 6);
    }
  }
}
