// Poses at a point in time.
import type { Row } from './api.js';
import { wrapDeg } from './geometry.js';

/** The index of the last of `count` rising values that is not greater; 0 before the first. */
export function lastNotAfter(count: number, valueAt: (i: number) => number, value: number): number {
  let low = 0;
  let high = count - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (valueAt(middle) <= value) low = middle;
    else high = middle - 1;
  }
  return low;
}

/** The pose at a time, interpolated between rows; the first or the last one beyond the ends. */
export function poseAt(rows: Row[], time: number): Row | null {
  if (rows.length === 0) return null;
  const low = lastNotAfter(rows.length, (i) => rows[i]![0], time);
  const a = rows[low]!;
  const b = rows[Math.min(low + 1, rows.length - 1)]!;
  const share = b[0] > a[0] ? Math.min(1, Math.max(0, (time - a[0]) / (b[0] - a[0]))) : 0;
  return [time, a[1] + share * (b[1] - a[1]), a[2] + share * (b[2] - a[2]), wrapDeg(a[3] + share * wrapDeg(b[3] - a[3]))];
}
