// Arranges markers in arrays, in lines and along walls. All poses in the map frame; lengths in metres.
import type { Floor } from './floor.js';
import { centerOf, radians, sideM, tidy, transform, wrapDeg } from './geometry.js';
import type { Marker, Point, Pose } from './geometry.js';

const millimetre = (value: number): number => tidy(Math.round(value * 1000) / 1000);

/** The marker moved to another centre. */
export function withMiddle(marker: Marker, middle: Point, yawDeg = marker.yawDeg): Marker {
  const o = transform({ ...middle, yawDeg }, { x: -sideM / 2, y: sideM / 2 });
  return { ...marker, x: millimetre(o.x), y: millimetre(o.y), yawDeg: wrapDeg(yawDeg) };
}

export interface ArrayShape { rows: number; columns: number; stepX: number; stepY: number; turnDeg: number }

/** Offsets of the copies of a group, without the group itself: row by row, along axes rotated by turnDeg. */
export function arrayOffsets(shape: ArrayShape): Point[] {
  const offsets: Point[] = [];
  for (let row = 0; row < shape.rows; ++row) {
    for (let column = 0; column < shape.columns; ++column) {
      if (row === 0 && column === 0) continue;
      offsets.push(transform({ x: 0, y: 0, yawDeg: shape.turnDeg }, { x: column * shape.stepX, y: row * shape.stepY }));
    }
  }
  return offsets;
}

/** Puts the centres at equal spacing on the straight line between the two that are farthest apart along x or y. */
export function distributed(markers: Marker[]): Marker[] {
  if (markers.length < 3) return markers;
  const middles = markers.map((marker) => ({ marker, at: centerOf(marker) }));
  const extent = (pick: (p: Point) => number) => Math.max(...middles.map((m) => pick(m.at))) - Math.min(...middles.map((m) => pick(m.at)));
  const along = extent((p) => p.x) >= extent((p) => p.y) ? (p: Point) => p.x : (p: Point) => p.y;
  middles.sort((a, b) => along(a.at) - along(b.at));
  const first = middles[0]!.at, last = middles.at(-1)!.at;
  return middles.map(({ marker }, i) => {
    const share = i / (middles.length - 1);
    if (share === 0 || share === 1) return marker;
    return withMiddle(marker, { x: first.x + share * (last.x - first.x), y: first.y + share * (last.y - first.y) });
  });
}

/** The nearest wall along the axes of the grid: distance and direction; null when there is none within mostM. */
export function nearestWall(floor: Floor, at: Point, mostM = 20): { distanceM: number; directionDeg: number } | null {
  const { resolution_m: r } = floor.info;
  const cell = floor.toGrid(at);
  for (let step = 1; step * r <= mostM; ++step) {
    for (const [dx, dy, deg] of [[1, 0, 0], [0, 1, 90], [-1, 0, 180], [0, -1, -90]] as const) {
      const column = Math.floor(cell.x) + dx * step, row = Math.floor(cell.y) + dy * step;
      if (!floor.isWall(column, row)) continue;
      const edge = dx + dy > 0 ? (dx ? column : row) : (dx ? column : row) + 1;  // of the wall's cell, towards us
      return { distanceM: Math.abs(edge - (dx ? cell.x : cell.y)) * r, directionDeg: wrapDeg(floor.origin.yawDeg + deg) };
    }
  }
  return null;
}

/** The centre at this distance from the nearest wall, the yaw rounded to the grid's axes. */
export function toWall(floor: Floor, marker: Marker, distanceM: number): Marker {
  const middle = centerOf(marker);
  const wall = nearestWall(floor, middle);
  if (!wall) return marker;
  const by = wall.distanceM - distanceM;
  const direction = radians(wall.directionDeg);
  const axis = floor.origin.yawDeg;
  const yawDeg = axis + 90 * Math.round((marker.yawDeg - axis) / 90);
  return withMiddle(marker, { x: middle.x + by * Math.cos(direction), y: middle.y + by * Math.sin(direction) }, yawDeg);
}

/** All translated by `by`, and rotated about a pivot. */
export function movedBy(markers: Marker[], by: { x: number; y: number; z: number; yawDeg: number }, pivot: Point): Marker[] {
  const turn: Pose = { ...pivot, yawDeg: by.yawDeg };
  return markers.map((m) => {
    const at = transform(turn, { x: m.x - pivot.x, y: m.y - pivot.y });
    return { ...m, x: tidy(at.x + by.x), y: tidy(at.y + by.y), z: tidy(m.z + by.z), yawDeg: wrapDeg(m.yawDeg + by.yawDeg) };
  });
}
