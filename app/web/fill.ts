// The fewest markers such that every position sees enough of them. This is set cover, which is NP-hard; the
// greedy algorithm (Chvatal 1979) needs at most H(n) times the optimum, and here about as many as a person
// would.
import { boundedPlaces, gainOf } from './best_places.js';
import type { Breathe, Place, Wanted } from './best_places.js';
import type { Coverage } from './coverage.js';
import type { Point } from './geometry.js';

const kept = 4000;  // places whose cells are remembered: some 50 MB

export interface Filling { places: Point[]; blindM2: number }

/** Positions for markers at this height so that every position on the floor sees `wanted` markers, existing ones included.
 *  Cells that no candidate can see remain, and are reported. */
export async function fillGaps(coverage: Coverage, z: number, wanted: number, present: Point[], breathe: Breathe): Promise<Filling> {
  const { floor } = coverage;
  const missing = new Int16Array(coverage.counts.length);
  for (let cell = 0; cell < missing.length; ++cell) missing[cell] = floor.canStand(cell) ? Math.max(0, wanted - coverage.counts[cell]!) : 0;
  const cells = new VisibleCells(coverage, z);
  const chosen = await greedy(boundedPlaces(coverage, z, (cell) => missing[cell]! > 0 ? 1 : 0, present), cells, missing, breathe);
  const needed = withoutRedundant(chosen, cells, coverage, wanted);
  let blind = 0;
  for (const left of missing) if (left > 0) ++blind;
  return { places: needed.map((cell) => floor.centerOfCell(cell)), blindM2: blind * floor.info.resolution_m ** 2 };
}

/** What is seen from places, the latest remembered. */
class VisibleCells {
  private readonly known = new Map<number, Int32Array>();

  constructor(private readonly coverage: Coverage, private readonly z: number) {}

  from(cell: number): Int32Array {
    const cells = this.known.get(cell) ?? this.coverage.visibleFrom(this.coverage.floor.centerOfCell(cell), this.z);
    this.known.delete(cell);
    this.known.set(cell, cells);  // the newest is last
    if (this.known.size > kept) this.known.delete(this.known.keys().next().value!);
    return cells;
  }
}

/** Repeatedly takes the place with the largest gain. Gains only shrink, so a place whose updated gain is not below
 *  the others' bounds is the best. */
async function greedy(places: Place[], cells: VisibleCells, missing: Int16Array, breathe: Breathe): Promise<number[]> {
  const isMissing: Wanted = (cell) => missing[cell]! > 0 ? 1 : 0;
  const heap = new Heap(places);
  const chosen: number[] = [];
  for (let most = heap.size; heap.size > 0;) {
    const best = heap.pop();
    const gain = gainOf(cells.from(best.cell), isMissing);
    await breathe(1 - heap.size / most);
    if (gain === 0) continue;
    if (heap.size > 0 && gain < heap.top.bound) {
      heap.push({ cell: best.cell, bound: gain });
      continue;
    }
    for (const cell of cells.from(best.cell)) if (missing[cell]! > 0) --missing[cell]!;
    chosen.push(best.cell);
  }
  return chosen;
}

/** A binary heap; the highest bound is on top. */
class Heap {
  private readonly all: Place[] = [];

  constructor(places: Place[]) { for (const place of places) this.push(place); }

  get size(): number { return this.all.length; }
  get top(): Place { return this.all[0]!; }

  push(place: Place): void {
    let at = this.all.push(place) - 1;
    for (let above = (at - 1) >> 1; at > 0 && this.all[above]!.bound < place.bound; above = (at - 1) >> 1) {
      this.all[at] = this.all[above]!;
      at = above;
    }
    this.all[at] = place;
  }

  pop(): Place {
    const top = this.top;
    const last = this.all.pop()!;
    if (this.size === 0) return top;
    let at = 0;
    for (let below = 1; below < this.size; below = 2 * at + 1) {
      if (below + 1 < this.size && this.all[below + 1]!.bound > this.all[below]!.bound) ++below;
      if (this.all[below]!.bound <= last.bound) break;
      this.all[at] = this.all[below]!;
      at = below;
    }
    this.all[at] = last;
    return top;
  }
}

/** Drops markers that later choices have made redundant. */
function withoutRedundant(chosen: number[], cells: VisibleCells, coverage: Coverage, wanted: number): number[] {
  const counts = Int16Array.from(coverage.counts);
  for (const place of chosen) for (const cell of cells.from(place)) ++counts[cell]!;
  return chosen.filter((place) => {
    const seen = cells.from(place);
    const needed = seen.some((cell) => counts[cell]! <= wanted && coverage.floor.canStand(cell));
    if (!needed) for (const cell of seen) --counts[cell]!;
    return needed;
  });
}
