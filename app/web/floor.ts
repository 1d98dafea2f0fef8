// The floor as cells of the map: where the robot can be, and what is in the line of sight to the ceiling.
import type { Deviations, Heights, MapInfo } from './api.js';
import { inverse, transform } from './geometry.js';
import type { Point, Pose } from './geometry.js';

const occupiedFrom = 50;

export class Floor {
  readonly origin: Pose;
  private readonly gridFromMap: Pose;
  private readonly roomy: Uint8Array;  // 1 where the robot's centre can be

  /** With `heights`, of an OctoMap, these hide markers; without, everything occupied on the map is taken to reach the
   *  ceiling. */
  constructor(readonly info: MapInfo, readonly cells: Int8Array, readonly roomM: number, readonly heights: Heights | null = null) {
    this.origin = { x: info.origin.x_m, y: info.origin.y_m, yawDeg: info.origin.yaw_deg };
    this.gridFromMap = inverse(this.origin);
    this.roomy = this.placesWithRoom(roomM / info.resolution_m);
  }

  isFree(index: number): boolean {
    const value = this.cells[index]!;
    return value >= 0 && value < occupiedFrom;
  }

  isWall(column: number, row: number): boolean {
    const { columns, rows } = this.info;
    return column >= 0 && row >= 0 && column < columns && row < rows && this.cells[row * columns + column]! >= occupiedFrom;
  }

  /** Can the robot's centre be there by the planners' rule: far enough from every cell that is not free? */
  canStand(index: number): boolean { return this.roomy[index] === 1; }

  private placesWithRoom(radius: number): Uint8Array {
    const { columns, rows } = this.info;
    const free = new Uint8Array(columns * rows);
    for (let i = 0; i < free.length; ++i) free[i] = this.isFree(i) ? 1 : 0;
    const room = free.slice();
    const reach = Math.floor(radius);
    const halfWidths = Array.from({ length: 2 * reach + 1 }, (_, i) => Math.floor(Math.sqrt(Math.max(0, radius * radius - (i - reach) ** 2))));
    const isFreeAt = (column: number, row: number) => column >= 0 && row >= 0 && column < columns && row < rows && free[row * columns + column] === 1;
    for (let row = -1; row <= rows; ++row) {
      for (let column = -1; column <= columns; ++column) {  // beyond its border the map is not free
        if (isFreeAt(column, row)) continue;
        if (!isFreeAt(column + 1, row) && !isFreeAt(column - 1, row) && !isFreeAt(column, row + 1) && !isFreeAt(column, row - 1)) continue;
        for (let r = Math.max(0, row - reach); r <= Math.min(rows - 1, row + reach); ++r) {
          const half = halfWidths[r - row + reach]!;
          const [low, high] = [Math.max(0, column - half), Math.min(columns - 1, column + half)];
          if (low <= high) room.fill(0, r * columns + low, r * columns + high + 1);
        }
      }
    }
    return room;
  }

  /** Is nothing in this rectangle of cells, limits included, that could hide a marker? */
  isClear(lowColumn: number, lowRow: number, highColumn: number, highRow: number): boolean {
    const { columns, rows } = this.info;
    if (lowColumn < 0 || lowRow < 0 || highColumn >= columns || highRow >= rows) return false;
    const bands = this.heights?.bands;
    for (let row = lowRow; row <= highRow; ++row)
      for (let i = row * columns + lowColumn; i <= row * columns + highColumn; ++i)
        if (bands ? bands[i] !== 0 : this.cells[i]! >= occupiedFrom) return false;
    return true;
  }

  /** One value per cell, in metres, from values for every stride-th; NaN where there is none. */
  spread(coarse: Deviations): Float32Array {
    const { columns, rows } = this.info;
    const spread = new Float32Array(columns * rows);
    for (let row = 0, i = 0; row < rows; ++row) {
      const from = Math.floor(row / coarse.stride) * coarse.columns;
      for (let column = 0; column < columns; ++column, ++i) spread[i] = (coarse.sigma_mm[from + Math.floor(column / coarse.stride)] ?? NaN) / 1000;
    }
    return spread;
  }

  /** In cells, with fractions. */
  toGrid(p: Point): Point {
    const at = transform(this.gridFromMap, p);
    return { x: at.x / this.info.resolution_m, y: at.y / this.info.resolution_m };
  }

  centerOfCell(index: number): Point {
    const { columns, resolution_m: r } = this.info;
    return transform(this.origin, { x: (index % columns + 0.5) * r, y: (Math.floor(index / columns) + 0.5) * r });
  }

  corners(): Point[] {
    const { columns, rows, resolution_m: r } = this.info;
    return [[0, 0], [columns, 0], [columns, rows], [0, rows]]
      .map(([x, y]) => transform(this.origin, { x: x! * r, y: y! * r }));
  }

  /** Is the line of sight from a camera above a cell to a marker free? */
  sees(cell: Point, cameraZ: number, marker: Point, markerZ: number): boolean {
    return this.heights ? this.seesPast(this.heights, cell, cameraZ, marker, markerZ) : this.seesOnMap(cell, marker);
  }

  /** By heights: cells within touch_m of the camera or of the marker, such as the ceiling, do not count. */
  private seesPast(heights: Heights, cell: Point, cameraZ: number, marker: Point, markerZ: number): boolean {
    const { columns, rows, resolution_m: r } = this.info;
    const lengthM = Math.hypot((cell.x - marker.x) * r, (cell.y - marker.y) * r, markerZ - cameraZ);
    const steps = Math.ceil(2 * lengthM / Math.min(r, heights.step_m));
    for (let i = 1; i < steps; ++i) {
      const t = i / steps;
      if (Math.min(t, 1 - t) * lengthM <= heights.touch_m) continue;
      const column = Math.floor(cell.x + t * (marker.x - cell.x));
      const row = Math.floor(cell.y + t * (marker.y - cell.y));
      if (column < 0 || row < 0 || column >= columns || row >= rows) continue;
      const band = Math.floor((cameraZ + t * (markerZ - cameraZ) - heights.low_m) / heights.step_m);
      if (band >= 0 && band < 32 && (heights.bands[row * columns + column]! >>> band & 1) === 1) return false;
    }
    return true;
  }

  /** On the flat map. Occupied cells directly below the marker do not hide it: they do not reach the ceiling. All other
   *  occupied cells are taken to. */
  private seesOnMap(cell: Point, marker: Point): boolean {
    const { columns, rows } = this.info;
    const steps = Math.ceil(Math.hypot(cell.x - marker.x, cell.y - marker.y));
    let over = true;
    for (let i = 0; i < steps; ++i) {
      const t = i / steps;
      const column = Math.floor(marker.x + t * (cell.x - marker.x));
      const row = Math.floor(marker.y + t * (cell.y - marker.y));
      if (column < 0 || row < 0 || column >= columns || row >= rows) return false;
      const occupied = this.cells[row * columns + column]! >= occupiedFrom;
      if (occupied && !over) return false;
      over &&= occupied;
    }
    return true;
  }
}
