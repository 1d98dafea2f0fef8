// Points, poses and the marker's pattern. Lengths in metres; angles in degrees where a name says so.

export interface Point { x: number; y: number }
export interface Pose extends Point { yawDeg: number }

/** A marker as in the registry: position of dot O, and the direction O to X counter-clockwise from above. */
export interface Marker extends Pose { key: number; id: number; z: number }

export const pitchM = 0.04;
export const dotRadiusM = 0.01;
export const sideM = 3 * pitchM;
export const idCount = 4096;

const bits = [
  [0x000, 0x020, 0x200, 0x000], [0x002, 0x010, 0x100, 0x800],
  [0x001, 0x008, 0x080, 0x400], [0x000, 0x004, 0x040, 0x000]];

/** The fifteen cells of the face that can hold a dot, with the bit of the ID that says whether one does. */
export const dotPlaces: { row: number; column: number; bit: number | 'corner' }[] = bits.flatMap((columns, row) =>
  columns.map((bit, column) => ({ row, column, bit: bit !== 0 ? bit : 'corner' as const })))
  .filter(({ row, column }) => row !== 0 || column !== 3);

export interface Dot { row: number; column: number; corner: '' | 'O' | 'X' | 'Y' }

/** The dots as on the printed face, seen from below: row 0 on top, Y top left, O bottom left, X bottom right. */
export function dotsOf(id: number): Dot[] {
  return dotPlaces.filter(({ bit }) => bit === 'corner' || (id & bit) !== 0).map(({ row, column, bit }) =>
    ({ row, column, corner: bit !== 'corner' ? '' : row === 0 ? 'Y' : column === 0 ? 'O' : 'X' }));
}

export const radians = (deg: number): number => deg * Math.PI / 180;
export const degrees = (rad: number): number => rad * 180 / Math.PI;

/** The same direction in (-180, 180], without rounding residue. */
export function wrapDeg(deg: number): number {
  const wrapped = ((deg % 360) + 360) % 360;
  return tidy(wrapped > 180 ? wrapped - 360 : wrapped);
}

/** Rounded to a nanometre or a nanodegree: 0.3, not 0.30000000000000004. */
export const tidy = (value: number): number => Math.round(value * 1e9) / 1e9 + 0;

/** A point of frame b in frame a. */
export function transform(aFromB: Pose, p: Point): Point {
  const c = Math.cos(radians(aFromB.yawDeg));
  const s = Math.sin(radians(aFromB.yawDeg));
  return { x: aFromB.x + c * p.x - s * p.y, y: aFromB.y + s * p.x + c * p.y };
}

export function inverse(aFromB: Pose): Pose {
  const turned = transform({ x: 0, y: 0, yawDeg: -aFromB.yawDeg }, { x: -aFromB.x, y: -aFromB.y });
  return { ...turned, yawDeg: wrapDeg(-aFromB.yawDeg) };
}

export const isIdentity = (pose: Pose): boolean => pose.x === 0 && pose.y === 0 && pose.yawDeg === 0;

/** The centre of a marker's square: from above its y axis points to yaw - 90 degrees. */
export function centerOf(marker: Pose): Point {
  return transform(marker, { x: sideM / 2, y: -sideM / 2 });
}

/** Least-squares pose that maps `from` points onto `to` points, and the residual of each pair. */
export function fitPairs(pairs: { from: Point; to: Point }[]): { pose: Pose; residualsM: number[] } | null {
  if (pairs.length < 2) return null;
  const mean = (pick: (p: { from: Point; to: Point }) => number): number =>
    pairs.reduce((sum, pair) => sum + pick(pair), 0) / pairs.length;
  const from = { x: mean((p) => p.from.x), y: mean((p) => p.from.y) };
  const to = { x: mean((p) => p.to.x), y: mean((p) => p.to.y) };
  let dot = 0;
  let cross = 0;
  for (const p of pairs) {
    const ax = p.from.x - from.x, ay = p.from.y - from.y, bx = p.to.x - to.x, by = p.to.y - to.y;
    dot += ax * bx + ay * by;
    cross += ax * by - ay * bx;
  }
  if (Math.hypot(dot, cross) < 1e-9) return null;
  const turn = { x: 0, y: 0, yawDeg: degrees(Math.atan2(cross, dot)) };
  const turned = transform(turn, from);
  const pose = { x: tidy(to.x - turned.x), y: tidy(to.y - turned.y), yawDeg: wrapDeg(turn.yawDeg) };
  const residualsM = pairs.map((p) => {
    const at = transform(pose, p.from);
    return Math.hypot(at.x - p.to.x, at.y - p.to.y);
  });
  return { pose, residualsM };
}
