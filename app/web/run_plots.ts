// Plot data of a run: steps, fixes and errors on a common time axis.
import type { Row, Run } from './api.js';
import { lastNotAfter, poseAt } from './poses.js';

const mostRows = 1500;
const seenForS = 0.5;
const covarianceFrom = 10;  // columns of steps.csv

/** Rows of time, 3 sigma (mm), error (mm), commanded, driven (m/s), confidence, markers, as for DrivePlots. */
export function columnsOf(run: Run): (number | null)[][] {
  const columns: (number | null)[][] = Array.from({ length: 7 }, () => []);
  const stride = Math.max(1, Math.ceil(run.steps.length / mostRows));
  let fix = -1;
  for (let i = 0; i < run.steps.length; i += stride) {
    const [time, x, y, , sigma, , commanded, , driven] = run.steps[i]! as [number, number, number, number, number, number, number, number, number];
    while (fix + 1 < run.fixes.length && run.fixes[fix + 1]![0]! <= time) ++fix;
    const seen = fix >= 0 && time - run.fixes[fix]![0]! < seenForS ? run.fixes[fix]! : null;
    const error = errorAt(run.truth, time, x, y);
    const row = [time, 3000 * sigma, error, commanded, driven, seen?.[4] ?? null, seen ? seen.length - 6 : 0];
    columns.forEach((column, at) => column.push(row[at]!));
  }
  return columns;
}

function errorAt(truth: Row[], time: number, x: number, y: number): number | null {
  if (truth.length === 0 || time < truth[0]![0] || time > truth.at(-1)![0]) return null;
  const pose = poseAt(truth, time)!;
  return 1000 * Math.hypot(pose[1] - x, pose[2] - y);
}

/** Of the position at a time, as xx, xy, yy (m²); null of runs that did not keep it. */
export function covarianceAt(run: Run, time: number): [number, number, number] | null {
  const step = run.steps[lastNotAfter(run.steps.length, (i) => run.steps[i]![0]!, time)];
  if (!step || step.length < covarianceFrom + 3) return null;
  return [step[covarianceFrom]!, step[covarianceFrom + 1]!, step[covarianceFrom + 2]!];
}
