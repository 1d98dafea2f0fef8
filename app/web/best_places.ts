// Where markers serve best. Places are compared by gain: the cells that a marker there serves. What a marker could serve if
// nothing were in the way bounds its gain from above and costs little, so that places are looked at from the highest
// bound down, and most never (lazy evaluation: Minoux 1978).
import { enoughMarkers } from './coverage.js';
import type { Coverage } from './coverage.js';
import { sideM } from './geometry.js';
import type { Point } from './geometry.js';

const stepM = 0.3;
const aboutSpotM = 0.25;  // a spot stands for what is around it

/** Yields now and then to what else waits, with the share that is done. */
export type Breathe = (share: number) => Promise<void>;

/** Cells for which a marker's cells are to be counted: 1 or 0 each. */
export type Wanted = (cell: number) => number;

export const strideOf = (coverage: Coverage): number => Math.max(1, Math.round(stepM / coverage.floor.info.resolution_m));

/** A place for a marker: index of the cell below its centre. */
export interface Place { cell: number; bound: number }

/** All places on a lattice of 30 cm above free floor that could serve anyone, by wanted cells within reach. */
export function boundedPlaces(coverage: Coverage, z: number, wanted: Wanted, taken: Point[] = []): Place[] {
  const { floor } = coverage;
  const { columns, rows } = floor.info;
  const sums = rowSums(coverage, wanted);
  const closed = cellsTaken(coverage, taken);
  const reach = coverage.reach(z);
  const far = Math.floor(reach);
  const halfWidths = Array.from({ length: 2 * far + 1 }, (_, i) => Math.floor(Math.sqrt(reach * reach - (i - far) ** 2)));
  const stride = strideOf(coverage);
  const places: Place[] = [];
  for (let row = stride >> 1; row < rows; row += stride) {
    for (let column = stride >> 1; column < columns; column += stride) {
      const cell = row * columns + column;
      if (!floor.isFree(cell) || closed[cell] === 1) continue;
      let bound = 0;
      for (let r = Math.max(0, row - far); r <= Math.min(rows - 1, row + far); ++r) {
        const half = halfWidths[r - row + far]!;
        bound += sums[r * (columns + 1) + Math.min(columns, column + half + 1)]! - sums[r * (columns + 1) + Math.max(0, column - half)]!;
      }
      if (bound > 0) places.push({ cell, bound });
    }
  }
  return places;
}

/** For each row, the wanted cells before each column: columns + 1 values. */
function rowSums(coverage: Coverage, wanted: Wanted): Uint32Array {
  const { columns, rows } = coverage.floor.info;
  const sums = new Uint32Array(rows * (columns + 1));
  for (let row = 0; row < rows; ++row) {
    let sum = 0;
    for (let column = 0; column < columns; ++column) {
      sum += wanted(row * columns + column);
      sums[row * (columns + 1) + column + 1] = sum;
    }
  }
  return sums;
}

/** 1 where a marker's centre would be nearer than two sides to a marker that hangs. */
function cellsTaken(coverage: Coverage, taken: Point[]): Uint8Array {
  const { columns, rows, resolution_m } = coverage.floor.info;
  const closed = new Uint8Array(columns * rows);
  const near = 2 * sideM / resolution_m;
  for (const at of taken.map((p) => coverage.floor.toGrid(p))) {
    for (let row = Math.max(0, Math.floor(at.y - near)); row < Math.min(rows, at.y + near); ++row) {
      for (let column = Math.max(0, Math.floor(at.x - near)); column < Math.min(columns, at.x + near); ++column) {
        if (Math.hypot(column + 0.5 - at.x, row + 0.5 - at.y) < near) closed[row * columns + column] = 1;
      }
    }
  }
  return closed;
}

export function gainOf(cells: Int32Array, wanted: Wanted): number {
  let gain = 0;
  for (const cell of cells) gain += wanted(cell);
  return gain;
}

/** The position of a marker at this height that serves the most blind cells; null when there are none. */
export async function suggestion(coverage: Coverage, z: number, breathe: Breathe): Promise<Point | null> {
  const { floor } = coverage;
  const isBlind: Wanted = (cell) => coverage.counts[cell] === 0 && floor.canStand(cell) ? 1 : 0;
  const places = boundedPlaces(coverage, z, isBlind).sort((a, b) => b.bound - a.bound);
  let best: Point | null = null;
  let bestGain = 0;
  for (const [i, { cell, bound }] of places.entries()) {
    if (bound <= bestGain) break;
    const at = floor.centerOfCell(cell);
    const gain = gainOf(coverage.visibleFrom(at, z), isBlind);
    if (gain > bestGain) [best, bestGain] = [at, gain];
    await breathe(i / places.length);
  }
  return best;
}

/** The position of a marker at this height that is well seen from a spot and about it, and serves the most cells that see fewer than two;
 *  null when there is none. */
export function suggestionNear(coverage: Coverage, spot: Point, z: number): Point | null {
  const { floor } = coverage;
  const { columns, rows, resolution_m: r } = floor.info;
  const at = floor.toGrid(spot);
  const reachM = coverage.reach(z) * r;
  const reach = Math.max(reachM - aboutSpotM, 0.5 * reachM) / r;
  const stride = strideOf(coverage);
  const isPoor: Wanted = (cell) => coverage.counts[cell]! < enoughMarkers ? 1 : 0;
  let best: Point | null = null;
  let bestGain = -1;
  for (let row = Math.max(0, Math.floor(at.y - reach)); row < Math.min(rows, at.y + reach); row += stride) {
    for (let column = Math.max(0, Math.floor(at.x - reach)); column < Math.min(columns, at.x + reach); column += stride) {
      const there = { x: column + 0.5, y: row + 0.5 };
      const apart = Math.hypot(there.x - at.x, there.y - at.y);
      if (apart > reach || !floor.isFree(row * columns + column) || !floor.sees(at, coverage.camera.camera_height_m, there, z)) continue;
      const middle = floor.centerOfCell(row * columns + column);
      const gain = gainOf(coverage.visibleFrom(middle, z), isPoor) - apart / (1 + reach);
      if (gain > bestGain) [best, bestGain] = [middle, gain];
    }
  }
  return best;
}
