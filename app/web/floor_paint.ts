// The floor: the map's cells, coloured by coverage or deviation, and a scale bar.
import { coloursNow } from './colours.js';
import type { Box } from './coverage.js';
import type { Floor } from './floor.js';
import type { Layers } from './layers.js';
import type { View } from './view.js';

const badTint = [214, 60, 50], doubtTint = [232, 176, 40], goodTint = [46, 150, 80];
const hatchCells = 5;  // from one line of the hatching to the next
const goodDeviationM = 0.005, badDeviationM = 0.02;
const stripeRows = 256;
const sigmaSteps = 255;

/** As pixels of an image. */
interface Palette {
  unknown: number; wall: number; free: number; none: number; hatch: number; one: number; more: number;
  unseen: number;       // no marker at some heading
  sigmas: Uint32Array;  // of deviations, from good to bad
}

function paletteOf(): Palette {
  const { unknown, wall, free } = coloursNow();
  const tinted = (tint: number[], share: number) => pixelOf(free.map((c, i) => c * (1 - share) + tint[i]! * share));
  return { unknown: pixelOf(unknown), wall: pixelOf(wall), free: pixelOf(free), none: tinted(badTint, 0.42), hatch: tinted(badTint, 1),
    one: tinted(doubtTint, 0.3), more: tinted(goodTint, 0.3), unseen: tinted(badTint, 0.45),
    sigmas: Uint32Array.from({ length: sigmaSteps + 1 }, (_, i) => tinted(goodTint.map((c, k) => c + i / sigmaSteps * (doubtTint[k]! - c)), 0.45)) };
}

/** Opaque; the bytes are in the order of an image's on whatever machine. */
const pixelOf = (colour: number[]): number => new Uint32Array(Uint8ClampedArray.from([...colour.slice(0, 3), 255]).buffer)[0]!;

export class FloorPaint {
  /** Metres per cell; null before the first result, NaN where no marker is seen. */
  deviations: Float32Array | null = null;
  private readonly raster = document.createElement('canvas');
  private palette: Palette = paletteOf();

  /** `counts`: markers in view from each cell. */
  constructor(private readonly floor: Floor, private readonly counts: Uint16Array, private readonly layers: Layers) {
    this.raster.width = floor.info.columns;
    this.raster.height = floor.info.rows;
  }

  /** Colours all cells anew; call when theme or colouring have changed. */
  paint(): void {
    this.palette = paletteOf();
    const { columns, rows } = this.floor.info;
    for (let row = 0; row < rows; row += stripeRows) this.paintBox({ column: 0, row, columns, rows: Math.min(stripeRows, rows - row) });
  }

  /** The same where counts have changed. */
  paintCounted(boxes: Box[]): void {
    if (this.layers.floor === 'coverage') for (const box of boxes) this.paintBox(box);
  }

  private paintBox(box: Box): void {
    if (box.columns === 0 || box.rows === 0) return;
    const image = new ImageData(box.columns, box.rows);
    const pixels = new Uint32Array(image.data.buffer);
    for (let r = 0, at = 0; r < box.rows; ++r) {
      const row = box.row + box.rows - 1 - r;  // y is up on the map, down in the image
      for (let column = box.column; column < box.column + box.columns; ++column, ++at) pixels[at] = this.colourOf(row, column);
    }
    this.raster.getContext('2d')!.putImageData(image, box.column, this.floor.info.rows - box.row - box.rows);
  }

  /** Gaps are hatched: their red and the green of what is covered look alike to many. */
  private colourOf(row: number, column: number): number {
    const { palette, floor } = this;
    const index = row * floor.info.columns + column;
    const value = floor.cells[index]!;
    if (value < 0) return palette.unknown;
    if (value >= 50) return palette.wall;
    if (this.layers.floor === 'plain' || !floor.canStand(index)) return palette.free;
    if (this.layers.floor === 'deviation') return this.colourOfSigma(this.deviations?.[index] ?? 0);
    const count = this.counts[index]!;
    return count === 0 ? (row + column) % hatchCells === 0 ? palette.hatch : palette.none : count === 1 ? palette.one : palette.more;
  }

  /** From green (good) to yellow (bad); red where no marker is seen. */
  private colourOfSigma(sigmaM: number): number {
    if (!(sigmaM > 0)) return this.palette.unseen;
    const share = Math.min(1, Math.max(0, (sigmaM - goodDeviationM) / (badDeviationM - goodDeviationM)));
    return this.palette.sigmas[Math.round(share * sigmaSteps)]!;
  }

  draw(c: CanvasRenderingContext2D, view: View): void {
    c.clearRect(0, 0, view.width, view.height);
    if (this.layers.shown.map) this.drawCells(c, view);
    this.drawScale(c, view);
  }

  private drawCells(c: CanvasRenderingContext2D, view: View): void {
    const { floor } = this;
    c.save();
    const corner = view.toScreen(floor.origin);
    const scale = view.pixelsPerM * floor.info.resolution_m;
    c.translate(corner.x, corner.y);
    c.rotate(view.angleOf(floor.origin.yawDeg));
    c.imageSmoothingEnabled = false;
    c.drawImage(this.raster, 0, -floor.info.rows * scale, floor.info.columns * scale, floor.info.rows * scale);
    c.restore();
  }

  private drawScale(c: CanvasRenderingContext2D, view: View): void {
    const metres = [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50].find((m) => m * view.pixelsPerM > 60) ?? 100;
    c.fillStyle = c.strokeStyle = coloursNow().ink;
    c.lineWidth = 2;
    c.beginPath();
    c.moveTo(12, 26); c.lineTo(12 + metres * view.pixelsPerM, 26);
    c.stroke();
    c.font = '12px system-ui, sans-serif';
    c.fillText(`${metres} m`, 14, 20);
  }
}
