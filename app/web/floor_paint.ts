// The floor: the map's cells, coloured by coverage or deviation, and a scale bar.
import { coloursNow } from './colours.js';
import type { Coverage, Floor } from './coverage.js';
import type { Layers } from './layers.js';
import type { View } from './view.js';

const badTint = [214, 60, 50], doubtTint = [232, 176, 40], goodTint = [46, 150, 80];
const hatchCells = 5;  // from one line of the hatching to the next
const goodDeviationM = 0.005, badDeviationM = 0.02;

export class FloorPaint {
  /** Metres per cell; null before the first result, NaN where no marker is seen. */
  deviations: Float32Array | null = null;
  private readonly raster = document.createElement('canvas');
  private colours = coloursNow();
  private tints: { none: number[]; hatch: number[]; one: number[]; more: number[] } = { none: [], hatch: [], one: [], more: [] };

  constructor(private readonly floor: Floor, private readonly coverage: Coverage, private readonly layers: Layers) {
    this.raster.width = floor.info.columns;
    this.raster.height = floor.info.rows;
  }

  /** Recomputes the cells' colours; call when coverage or theme has changed. */
  paint(): void {
    this.colours = coloursNow();
    const { columns, rows } = this.floor.info;
    const context = this.raster.getContext('2d')!;
    this.tints = { none: this.tinted(badTint, 0.42), hatch: this.tinted(badTint, 1), one: this.tinted(doubtTint, 0.3), more: this.tinted(goodTint, 0.3) };
    const image = context.createImageData(columns, rows);
    for (let row = 0; row < rows; ++row) {
      for (let column = 0; column < columns; ++column) {
        const colour = this.colourOf(row * columns + column, (row + column) % hatchCells === 0);
        const at = 4 * ((rows - 1 - row) * columns + column);
        for (let i = 0; i < 3; ++i) image.data[at + i] = colour[i]!;
        image.data[at + 3] = 255;
      }
    }
    context.putImageData(image, 0, 0);
  }

  /** Gaps are hatched: their red and the green of what is covered look alike to many. */
  private colourOf(index: number, hatched: boolean): number[] {
    const value = this.floor.cells[index]!;
    if (value < 0) return this.colours.unknown;
    if (value >= 50) return this.colours.wall;
    if (this.layers.floor === 'plain' || !this.floor.canStand(index)) return this.colours.free;
    if (this.layers.floor === 'deviation') return this.tinted(deviationTint(this.deviations?.[index] ?? 0), 0.45);
    const count = this.coverage.counts[index]!;
    return count === 0 ? hatched ? this.tints.hatch : this.tints.none : count === 1 ? this.tints.one : this.tints.more;
  }

  private tinted(tint: number[], share: number): number[] {
    return this.colours.free.map((c, i) => c * (1 - share) + tint[i]! * share);
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

/** Interpolates from green (good) to yellow (bad); red where no marker is seen. */
function deviationTint(sigmaM: number): number[] {
  if (!(sigmaM > 0)) return badTint;
  const share = Math.min(1, Math.max(0, (sigmaM - goodDeviationM) / (badDeviationM - goodDeviationM)));
  return goodTint.map((c, i) => c + share * (doubtTint[i]! - c));
}
