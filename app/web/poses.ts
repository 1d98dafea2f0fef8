// Poses at a point in time.
import type { Row } from './api.js';
import { wrapDeg } from './geometry.js';

/** The pose at a time, interpolated between rows; the first or the last one beyond the ends. */
export function poseAt(rows: Row[], time: number): Row | null {
  if (rows.length === 0) return null;
  let low = 0;
  let high = rows.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (rows[middle]![0] <= time) low = middle;
    else high = middle - 1;
  }
  const a = rows[low]!;
  const b = rows[Math.min(low + 1, rows.length - 1)]!;
  const share = b[0] > a[0] ? Math.min(1, Math.max(0, (time - a[0]) / (b[0] - a[0]))) : 0;
  return [time, a[1] + share * (b[1] - a[1]), a[2] + share * (b[2] - a[2]), wrapDeg(a[3] + share * wrapDeg(b[3] - a[3]))];
}
