// Hamming distances of IDs, and the safest free ones: the rules of `lodestar markers check`.
import { dotPlaces, idCount } from './geometry.js';

const viewCount = 8;
const mostDistance = 16;
const leastCodedDots = 2;  // five dots with O, X and Y: fewer are easily confused with clutter

/** Bit 4 row + column for each dot. */
function patternOf(id: number): number {
  let pattern = 0;
  for (const { row, column, bit } of dotPlaces) if (bit === 'corner' || (id & bit) !== 0) pattern |= 1 << (4 * row + column);
  return pattern;
}

function moved(pattern: number, to: (row: number, column: number) => [number, number]): number {
  let result = 0;
  for (let row = 0; row < 4; ++row) {
    for (let column = 0; column < 4; ++column) {
      if ((pattern >> (4 * row + column) & 1) === 0) continue;
      const [r, c] = to(row, column);
      result |= 1 << (4 * r + c);
    }
  }
  return result;
}

/** The eight views of the pattern: rotated by quarter turns, and each of these mirrored. */
function viewsOf(id: number): number[] {
  const views: number[] = [];
  const upright = patternOf(id);
  for (const first of [upright, moved(upright, (r, c) => [3 - c, 3 - r])]) {
    let view = first;
    for (let turn = 0; turn < 4; ++turn) {
      views.push(view);
      view = moved(view, (r, c) => [3 - c, r]);
    }
  }
  return views;
}

const bitCounts = new Uint8Array(1 << 16);
for (let i = 1; i < bitCounts.length; ++i) bitCounts[i] = bitCounts[i >> 1]! + (i & 1);

const views = new Uint16Array(idCount * viewCount);
for (let id = 0; id < idCount; ++id) views.set(viewsOf(id), id * viewCount);

/** Number of cells (dots missed or glints added) that must be misread to take one ID for the other, rotated or mirrored in
 *  any way; of an ID with itself: to read it in a wrong orientation. */
export function idDistance(a: number, b: number): number {
  let least = mostDistance;
  for (let view = a === b ? 1 : 0; view < viewCount; ++view) {
    least = Math.min(least, bitCounts[views[a * viewCount]! ^ views[b * viewCount + view]!]!);
  }
  return least;
}

export interface Proposal { id: number; distance: number }

/** Keeps for each ID its distance to all IDs taken, so that each further choice is fast. */
export class IdPicker {
  private readonly nearest = new Uint8Array(idCount);

  constructor(taken: Iterable<number>) {
    for (let id = 0; id < idCount; ++id) {
      this.nearest[id] = bitCounts[id]! < leastCodedDots ? 0 : idDistance(id, id);
    }
    for (const id of new Set(taken)) this.take(id);
  }

  take(taken: number): void {
    for (let id = 0; id < idCount; ++id) {
      if (this.nearest[id]! > 0) this.nearest[id] = Math.min(this.nearest[id]!, id === taken ? 0 : idDistance(id, taken));
    }
  }

  /** Largest distance to all others first; among equals the smallest ID. */
  proposals(count: number): Proposal[] {
    const found: Proposal[] = [];
    for (let distance = mostDistance; distance >= 0 && found.length < count; --distance) {
      for (let id = 0; id < idCount && found.length < count; ++id) {
        if (this.nearest[id] === distance && (distance > 0 || bitCounts[id]! >= leastCodedDots)) found.push({ id, distance });
      }
    }
    return found;
  }

  /** Takes and returns the safest ID. */
  next(): number {
    const id = this.proposals(1)[0]!.id;
    this.take(id);
    return id;
  }
}
