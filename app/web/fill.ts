// The fewest markers such that every position sees enough of them. This is set cover, which is NP-hard; the
// greedy algorithm (Chvatal 1979) needs at most H(n) times the optimum, and here about as many as a person
// would.
import type { Coverage } from './coverage.js';
import type { Marker, Point } from './geometry.js';
import { centerOf, sideM } from './geometry.js';

const stepM = 0.3;
const yieldAfterMs = 30;

interface Candidate { at: Point; cells: Int32Array; gain: number }

export interface Filling { places: Point[]; blindM2: number }

/** Positions for markers at this height so that every position on the floor sees `wanted` markers, existing ones included.
 *  Cells that no candidate can see remain, and are reported. Yields at intervals, with the completed share. */
export async function fillGaps(coverage: Coverage, z: number, wanted: number, present: Iterable<Marker>,
  progress: (share: number) => Promise<void>): Promise<Filling> {
  const missing = Int16Array.from(coverage.counts, (count, i) => coverage.floor.canStand(i) ? Math.max(0, wanted - count) : 0);
  const taken = [...present].map(centerOf);
  const candidates = await allCandidates(coverage, z, missing, taken, progress);
  const chosen = greedy(candidates, missing);
  const kept = withoutRedundant(chosen, coverage, wanted);
  const cellM2 = coverage.floor.info.resolution_m ** 2;
  return { places: kept.map((c) => c.at), blindM2: missing.reduce((sum, m) => sum + (m > 0 ? 1 : 0), 0) * cellM2 };
}

const gainOf = (cells: Int32Array, missing: Int16Array): number => {
  let gain = 0;
  for (const cell of cells) if (missing[cell]! > 0) ++gain;
  return gain;
};

async function allCandidates(coverage: Coverage, z: number, missing: Int16Array, taken: Point[],
  progress: (share: number) => Promise<void>): Promise<Candidate[]> {
  const { columns, rows, resolution_m: r } = coverage.floor.info;
  const stride = Math.max(1, Math.round(stepM / r));
  const candidates: Candidate[] = [];
  let last = performance.now();
  for (let row = stride >> 1; row < rows; row += stride) {
    for (let column = stride >> 1; column < columns; column += stride) {
      const index = row * columns + column;
      if (!coverage.floor.isFree(index)) continue;
      const at = coverage.floor.centerOfCell(index);
      if (taken.some((p) => Math.hypot(p.x - at.x, p.y - at.y) < 2 * sideM)) continue;
      const cells = coverage.visibleFrom(at, z);
      const gain = gainOf(cells, missing);
      if (gain > 0) candidates.push({ at, cells, gain });
    }
    if (performance.now() - last < yieldAfterMs) continue;
    await progress(row / rows);
    last = performance.now();
  }
  return candidates;
}

/** Repeatedly takes the candidate with the largest gain. Gains only shrink, so a candidate whose updated gain is not below
 *  the others' old ones is the best (lazy evaluation, Minoux 1978). */
function greedy(candidates: Candidate[], missing: Int16Array): Candidate[] {
  const chosen: Candidate[] = [];
  const open = candidates.sort((a, b) => a.gain - b.gain);  // the best is last
  while (open.length > 0) {
    const best = open.pop()!;
    const gain = gainOf(best.cells, missing);
    if (gain === 0) continue;
    if (open.length > 0 && gain < open.at(-1)!.gain) {
      best.gain = gain;
      insert(open, best);
      continue;
    }
    for (const cell of best.cells) if (missing[cell]! > 0) --missing[cell]!;
    chosen.push(best);
  }
  return chosen;
}

function insert(sorted: Candidate[], candidate: Candidate): void {
  let low = 0, high = sorted.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (sorted[middle]!.gain < candidate.gain) low = middle + 1;
    else high = middle;
  }
  sorted.splice(low, 0, candidate);
}

/** Drops markers that later choices have made redundant. */
function withoutRedundant(chosen: Candidate[], coverage: Coverage, wanted: number): Candidate[] {
  const counts = Int16Array.from(coverage.counts);
  for (const { cells } of chosen) for (const cell of cells) ++counts[cell]!;
  return chosen.filter(({ cells }) => {
    const needed = cells.some((cell) => counts[cell]! <= wanted && coverage.floor.canStand(cell));
    if (!needed) for (const cell of cells) --counts[cell]!;
    return needed;
  });
}
