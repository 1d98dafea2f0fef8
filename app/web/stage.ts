// The three layers: floor (map and coverage), ceiling (markers), overlay (selection, handles, pointers).
import type { Coverage, Floor } from './coverage.js';
import { centerOf, dotRadiusM, dotsOf, pitchM, sideM, transform } from './geometry.js';
import type { Marker, Point } from './geometry.js';
import type { Editor } from './editor.js';
import type { Layers } from './layers.js';
import type { View } from './view.js';

const fineFromPx = 26;   // side of a marker from which its dots are drawn
const labelFromPx = 14;
const handleDistancePx = 46;
const badTint = [214, 60, 50], doubtTint = [232, 176, 40], goodTint = [46, 150, 80];
const goodDeviationM = 0.005, badDeviationM = 0.02;
const manyMarkers = 1500;  // from here on a pan moves the drawn layers, and draws them anew at its end

interface Colours { free: number[]; wall: number[]; unknown: number[]; marker: string; dot: string; chosen: string; ink: string; paper: string; route: string }
const light: Colours = { free: [255, 255, 255], wall: [52, 60, 72], unknown: [205, 210, 217], marker: '#1c2430', dot: '#ffffff', chosen: '#0b5fce', ink: '#1c2430', paper: '#ffffff', route: '#7a3fb0' };
const dark: Colours = { free: [40, 47, 58], wall: [150, 161, 176], unknown: [22, 27, 34], marker: '#0a0d12', dot: '#dfe6f0', chosen: '#7fb2ff', ink: '#e7ebf2', paper: '#12161d', route: '#d9a8ff' };

export class Stage {
  /** Metres a cell; nothing yet, or not seen from there. */
  deviations: Float32Array | null = null;
  marquee: { a: Point; b: Point } | null = null;
  pins: { at: Point; label: string }[] = [];
  /** What others draw on the overlay. */
  painters: ((c: CanvasRenderingContext2D) => void)[] = [];
  private shift: Point = { x: 0, y: 0 };
  private readonly floorLayer: CanvasRenderingContext2D;
  private readonly ceilingLayer: CanvasRenderingContext2D;
  private readonly overlayLayer: CanvasRenderingContext2D;
  private readonly raster = document.createElement('canvas');
  private tints: { none: number[]; one: number[]; more: number[] } = { none: [], one: [], more: [] };
  private wanted = false;
  private ceilingWanted = false;
  private overlayWanted = false;

  constructor(readonly element: HTMLElement, readonly view: View, readonly editor: Editor,
    readonly floor: Floor, readonly coverage: Coverage, readonly layers: Layers) {
    const context = (id: string) => (document.getElementById(id) as HTMLCanvasElement).getContext('2d')!;
    [this.floorLayer, this.ceilingLayer, this.overlayLayer] = [context('floor'), context('ceiling'), context('overlay')];
    this.raster.width = floor.info.columns;
    this.raster.height = floor.info.rows;
    new ResizeObserver(() => this.resize()).observe(element);
    this.resize();
  }

  get colours(): Colours { return document.documentElement.dataset['theme'] === 'dark' ? dark : light; }

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
    this.paintRaster();
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

  /** Draws everything with the next frame. */
  redraw(): void {
    this.ceilingWanted = true;
    this.redrawDragged();
  }

  /** The same while something is dragged: of very many markers only those that move, over where all were. */
  redrawDragged(): void {
    this.ceilingWanted ||= this.editor.markers.size < manyMarkers;
    if (this.wanted) return;
    this.wanted = true;
    requestAnimationFrame(() => {
      this.wanted = false;
      this.shiftLayers({ x: 0, y: 0 });
      this.drawFloor();
      if (this.ceilingWanted) this.drawCeiling();
      this.drawOverlay();
      this.ceilingWanted = false;
    });
  }

  /** The same for the overlay alone: for what moves. */
  redrawOverlay(): void {
    if (this.wanted || this.overlayWanted) return;
    this.overlayWanted = true;
    requestAnimationFrame(() => {
      this.overlayWanted = false;
      if (this.shift.x === 0 && this.shift.y === 0) this.drawOverlay();
    });
  }

  /** The middle of the marker with an ID. */
  placeOfId(id: number): Point | null {
    for (const marker of this.editor.shown()) if (marker.id === id) return centerOf(marker);
    return null;
  }

  /** The cells' colours; to be called when coverage or theme has changed. */
  paintRaster(): void {
    const { columns, rows } = this.floor.info;
    const context = this.raster.getContext('2d')!;
    this.tints = { none: this.tinted(badTint, 0.42), one: this.tinted(doubtTint, 0.3), more: this.tinted(goodTint, 0.3) };
    const image = context.createImageData(columns, rows);
    for (let row = 0; row < rows; ++row) {
      for (let column = 0; column < columns; ++column) {
        const colour = this.colourOf(row * columns + column);
        const at = 4 * ((rows - 1 - row) * columns + column);
        for (let i = 0; i < 3; ++i) image.data[at + i] = colour[i]!;
        image.data[at + 3] = 255;
      }
    }
    context.putImageData(image, 0, 0);
  }

  private colourOf(index: number): number[] {
    const value = this.floor.cells[index]!;
    if (value < 0) return this.colours.unknown;
    if (value >= 50) return this.colours.wall;
    if (this.layers.floor === 'plain' || !this.floor.canStand(index)) return this.colours.free;
    if (this.layers.floor === 'deviation') return this.tinted(deviationTint(this.deviations?.[index] ?? 0), 0.45);
    const count = this.coverage.counts[index]!;
    return count === 0 ? this.tints.none : count === 1 ? this.tints.one : this.tints.more;
  }

  private tinted(tint: number[], share: number): number[] {
    return this.colours.free.map((c, i) => c * (1 - share) + tint[i]! * share);
  }

  private drawFloor(): void {
    const { view, floor, floorLayer: c } = this;
    c.clearRect(0, 0, view.width, view.height);
    if (!this.layers.shown.map) return this.drawScale(c);
    c.save();
    const corner = view.toScreen(floor.origin);
    const scale = view.pixelsPerM * floor.info.resolution_m;
    c.translate(corner.x, corner.y);
    c.rotate(view.angleOf(floor.origin.yawDeg));
    c.imageSmoothingEnabled = false;
    c.drawImage(this.raster, 0, -floor.info.rows * scale, floor.info.columns * scale, floor.info.rows * scale);
    c.restore();
    this.drawScale(c);
  }

  private drawScale(c: CanvasRenderingContext2D): void {
    const metres = [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50].find((m) => m * this.view.pixelsPerM > 60) ?? 100;
    c.fillStyle = c.strokeStyle = this.colours.ink;
    c.lineWidth = 2;
    c.beginPath();
    c.moveTo(12, 26); c.lineTo(12 + metres * this.view.pixelsPerM, 26);
    c.stroke();
    c.font = '12px system-ui, sans-serif';
    c.fillText(`${metres} m`, 14, 20);
  }

  private drawCeiling(): void {
    const { view, ceilingLayer: c, colours } = this;
    c.clearRect(0, 0, view.width, view.height);
    if (!this.layers.shown.markers) return;
    const sidePx = (sideM + 2 * pitchM / 2) * view.pixelsPerM;
    c.font = '11px system-ui, sans-serif';
    c.textAlign = 'center';
    const few = this.editor.markers.size < 400;
    for (const marker of this.editor.shown()) {
      const middle = view.toScreen(centerOf(marker));
      if (middle.x < -sidePx || middle.y < -sidePx || middle.x > view.width + sidePx || middle.y > view.height + sidePx) continue;
      const chosen = this.editor.selection.has(marker.key);
      if (sidePx < 5 && !few) {
        c.fillStyle = chosen ? colours.chosen : colours.ink;
        c.fillRect(middle.x - 1.5, middle.y - 1.5, 3, 3);
        continue;
      }
      drawFromAbove(c, marker, view, chosen ? colours.chosen : colours.marker, colours.dot, sidePx < fineFromPx);
      if (this.layers.shown.ids && (sidePx > labelFromPx || few)) {
        c.fillStyle = chosen ? colours.chosen : colours.ink;
        c.fillText(String(marker.id), middle.x, middle.y + Math.max(sidePx * 0.75, 14) + 8);
      }
    }
    c.textAlign = 'start';
  }

  /** Where the handle to rotate the selection is, on the screen. */
  rotateHandle(): Point | null {
    const chosen = this.draggedSelection();
    if (chosen.length === 0) return null;
    const pivot = this.view.toScreen(this.editor.pivot(chosen));
    const angle = chosen.length === 1 ? this.view.angleOf(chosen[0]!.yawDeg) : -Math.PI / 2;
    const distance = handleDistancePx + (chosen.length === 1 ? sideM * this.view.pixelsPerM : 0);
    return { x: pivot.x + distance * Math.cos(angle), y: pivot.y + distance * Math.sin(angle) };
  }

  draggedSelection(): Marker[] {
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

  /** What is dragged, when the ceiling is not drawn anew for it. */
  private drawMoving(c: CanvasRenderingContext2D): void {
    const { view, colours } = this;
    for (const marker of this.editor.preview.values()) drawFromAbove(c, marker, view, colours.chosen, colours.dot, true);
  }

  private drawPins(c: CanvasRenderingContext2D): void {
    c.font = 'bold 13px system-ui, sans-serif';
    for (const pin of this.pins) {
      const at = this.view.toScreen(pin.at);
      c.beginPath();
      c.moveTo(at.x - 9, at.y); c.lineTo(at.x + 9, at.y); c.moveTo(at.x, at.y - 9); c.lineTo(at.x, at.y + 9);
      c.stroke();
      c.fillText(pin.label, at.x + 8, at.y - 6);
    }
  }
}

/** From good to bad in one step of colour each way; red where nothing is seen. */
function deviationTint(sigmaM: number): number[] {
  if (!(sigmaM > 0)) return badTint;
  const share = Math.min(1, Math.max(0, (sigmaM - goodDeviationM) / (badDeviationM - goodDeviationM)));
  return goodTint.map((c, i) => c + share * (doubtTint[i]! - c));
}

/** A marker as one would see it through the ceiling: mirrored against the printed face. */
function drawFromAbove(c: CanvasRenderingContext2D, marker: Marker, view: View, plate: string, dot: string, coarse: boolean): void {
  const scale = Math.max(view.pixelsPerM, 12 / (sideM + pitchM));  // never smaller than 12 pixels
  const middle = view.toScreen(centerOf(marker));
  c.save();
  c.translate(middle.x, middle.y);
  c.rotate(view.angleOf(marker.yawDeg));
  c.scale(scale, scale);
  const half = sideM / 2 + pitchM / 2;
  c.fillStyle = plate;
  c.fillRect(-half, -half, 2 * half, 2 * half);
  c.fillStyle = dot;
  if (coarse) {  // an arrow from O to X
    c.beginPath();
    c.moveTo(half * 0.8, 0); c.lineTo(-half * 0.6, -half * 0.6); c.lineTo(-half * 0.6, half * 0.6);
    c.fill();
  } else {
    for (const { row, column, corner } of dotsOf(marker.id)) {
      c.beginPath();
      c.arc(column * pitchM - sideM / 2, (3 - row) * pitchM - sideM / 2, dotRadiusM, 0, 2 * Math.PI);
      c.fillStyle = corner === 'O' ? '#ff8a3d' : corner === 'X' ? '#58b7ff' : dot;
      c.fill();
    }
  }
  c.restore();
}

/** The marker's face for the panel: from below as printed, or from above. */
export function drawFace(canvas: HTMLCanvasElement, id: number, fromAbove: boolean): void {
  const c = canvas.getContext('2d')!;
  const step = canvas.width / 5;
  c.clearRect(0, 0, canvas.width, canvas.height);
  c.font = '10px system-ui, sans-serif';
  c.textAlign = 'center';
  c.textBaseline = 'middle';
  for (const { row, column, corner } of dotsOf(id)) {
    const x = step * (column + 1);
    const y = step * ((fromAbove ? 3 - row : row) + 1);
    c.fillStyle = corner === 'O' ? '#ff8a3d' : corner === 'X' ? '#58b7ff' : '#eef2f8';
    c.beginPath();
    c.arc(x, y, step * 0.33, 0, 2 * Math.PI);
    c.fill();
    c.fillStyle = '#10151c';
    c.fillText(corner, x, y);
  }
}

/** Is a point of the map on the marker's plate, or within a few pixels of its middle? */
export function isOn(marker: Marker, p: Point, slackM: number): boolean {
  const o = transform({ x: 0, y: 0, yawDeg: -marker.yawDeg }, { x: p.x - marker.x, y: p.y - marker.y });
  const half = Math.max(sideM / 2 + pitchM / 2, slackM);
  return Math.abs(o.x - sideM / 2) <= half && Math.abs(o.y + sideM / 2) <= half;
}
