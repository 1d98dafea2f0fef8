// The floor: the map's cells, coloured by coverage or deviation, and a scale bar.
import { coloursNow, pixelOf } from './colours.js';
import type { Box } from './coverage.js';
import type { Floor } from './floor.js';
import { font } from './fonts.js';
import type { Layers } from './layers.js';
import type { View } from './view.js';

// Yellow and blue differ to everybody, in lightness too; red is hatched besides.
const badTint = [214, 60, 50], doubtTint = [232, 176, 40], goodTint = [0, 100, 140];
const oneShare = 0.3, moreShare = 0.5, noneShare = 0.42, sigmaShare = 0.45;
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

/** A tint over the floor. */
const over = (free: number[], tint: number[], share: number): number[] => free.map((c, i) => c * (1 - share) + tint[i]! * share);

function paletteOf(): Palette {
  const { unknown, wall, free } = coloursNow();
  const tinted = (tint: number[], share: number) => pixelOf(over(free, tint, share));
  return { unknown: pixelOf(unknown), wall: pixelOf(wall), free: pixelOf(free), none: tinted(badTint, noneShare), hatch: tinted(badTint, 1),
    one: tinted(doubtTint, oneShare), more: tinted(goodTint, moreShare), unseen: tinted(badTint, sigmaShare),
    sigmas: Uint32Array.from({ length: sigmaSteps + 1 }, (_, i) => tinted(goodTint.map((c, k) => c + i / sigmaSteps * (doubtTint[k]! - c)), sigmaShare)) };
}

export type FloorKey = 'none' | 'one' | 'more' | 'free' | 'good' | 'bad' | 'unseen';

/** What a legend shows of the floor's colours: CSS backgrounds, exactly as they are painted. */
export function floorSwatch(key: FloorKey): string {
  const { free } = coloursNow();
  const css = (tint: number[], share: number) => `rgb(${over(free, tint, share).map(Math.round).join(' ')})`;
  switch (key) {
    case 'none': return `repeating-linear-gradient(-45deg, ${css(badTint, 1)} 0 2px, ${css(badTint, noneShare)} 2px 5px)`;
    case 'one': return css(doubtTint, oneShare);
    case 'more': return css(goodTint, moreShare);
    case 'free': return css(free, 0);
    case 'good': return css(goodTint, sigmaShare);
    case 'bad': return css(doubtTint, sigmaShare);
    case 'unseen': return css(badTint, sigmaShare);
  }
}

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

  /** Gaps are hatched: their red and the colours of what is covered look alike to some. */
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

  /** From blue (good) to yellow (bad); red where no marker is seen. */
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
    c.font = font(12);
    c.fillText(`${metres} m`, 14, 20);
  }
}
