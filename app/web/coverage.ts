// Number of markers a robot sees at every heading from each cell where it can be: those within the narrowest
// side of its camera's view, with nothing occupied in between.
import type { Deviations, Heights, MapInfo, Site } from './api.js';
import { centerOf, inverse, transform } from './geometry.js';
import type { Marker, Point, Pose } from './geometry.js';

const occupiedFrom = 50;
const enoughMarkers = 2;
const aboutSpotM = 0.25;  // a spot stands for what is around it

export class Floor {
  readonly origin: Pose;
  private readonly gridFromMap: Pose;
  private readonly roomy: Uint8Array;  // 1 where the robot's centre can be

  /** With `heights`, of an OctoMap, these hide markers; without, everything occupied on the map is taken to reach the
   *  ceiling. */
  constructor(readonly info: MapInfo, readonly cells: Int8Array, roomM: number, readonly heights: Heights | null = null) {
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
    const room = Uint8Array.from(this.cells, (_, i) => this.isFree(i) ? 1 : 0);
    const reach = Math.floor(radius);
    const isEdge = (column: number, row: number) => [[1, 0], [-1, 0], [0, 1], [0, -1]].some(([dx, dy]) => {
      const [c, r] = [column + dx!, row + dy!];
      return c >= 0 && r >= 0 && c < columns && r < rows && this.isFree(r * columns + c);
    });
    for (let row = -1; row <= rows; ++row) {
      for (let column = -1; column <= columns; ++column) {  // beyond its border the map is not free
        const inside = row >= 0 && column >= 0 && row < rows && column < columns;
        if ((inside && this.isFree(row * columns + column)) || !isEdge(column, row)) continue;
        for (let r = Math.max(0, row - reach); r <= Math.min(rows - 1, row + reach); ++r) {
          for (let c = Math.max(0, column - reach); c <= Math.min(columns - 1, column + reach); ++c) {
            if ((r - row) ** 2 + (c - column) ** 2 <= radius * radius) room[r * columns + c] = 0;
          }
        }
      }
    }
    return room;
  }

  /** One value per cell, in metres, from values for every stride-th; NaN where there is none. */
  spread(coarse: Deviations): Float32Array {
    const { columns } = this.info;
    return Float32Array.from(this.cells, (_, i) => {
      const column = Math.floor(i % columns / coarse.stride), row = Math.floor(Math.floor(i / columns) / coarse.stride);
      return (coarse.sigma_mm[row * coarse.columns + column] ?? NaN) / 1000;
    });
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

export class Coverage {
  counts: Uint16Array;
  private readonly seenFrom = new Map<number, { marker: Marker; cells: Int32Array }>();

  constructor(readonly floor: Floor, readonly site: Site) { this.counts = new Uint16Array(floor.cells.length); }

  /** Horizontal distance within which a marker at this height is seen. */
  reachM(z: number): number {
    const c = this.site.coverage;
    return Math.max(0, (z - c.camera_height_m) * c.reach_per_m - c.margin_m);
  }

  /** Updates the counts; costs time only for markers that are new, removed or moved. */
  update(markers: Iterable<Marker>): void {
    const gone = new Set(this.seenFrom.keys());
    for (const marker of markers) {
      gone.delete(marker.key);
      const known = this.seenFrom.get(marker.key);
      if (known && known.marker.x === marker.x && known.marker.y === marker.y && known.marker.z === marker.z &&
        known.marker.yawDeg === marker.yawDeg) continue;
      if (known) this.count(known.cells, -1);
      const cells = this.visibleFrom(centerOf(marker), marker.z);
      this.count(cells, 1);
      this.seenFrom.set(marker.key, { marker, cells });
    }
    for (const key of gone) {
      this.count(this.seenFrom.get(key)!.cells, -1);
      this.seenFrom.delete(key);
    }
  }

  /** Shares of the floor where the robot can be with at least one and at least two markers in view. */
  shares(): { one: number; two: number } {
    let free = 0, one = 0, two = 0;
    for (let i = 0; i < this.counts.length; ++i) {
      if (!this.floor.canStand(i)) continue;
      ++free;
      if (this.counts[i]! >= 1) ++one;
      if (this.counts[i]! >= enoughMarkers) ++two;
    }
    return { one: free ? one / free : 1, two: free ? two / free : 1 };
  }

  /** The position of a marker at this height that serves the most blind cells; null when there are none. */
  suggestion(z: number): Point | null {
    const { columns, rows, resolution_m: r } = this.floor.info;
    const stride = Math.max(1, Math.round(0.3 / r));
    let best: Point | null = null;
    let bestGain = 0;
    for (let row = stride >> 1; row < rows; row += stride) {
      for (let column = stride >> 1; column < columns; column += stride) {
        const index = row * columns + column;
        if (!this.floor.isFree(index)) continue;
        const at = this.floor.centerOfCell(index);
        const gain = this.visibleFrom(at, z).filter((cell) => this.counts[cell] === 0).length;
        if (gain > bestGain) [best, bestGain] = [at, gain];
      }
    }
    return best;
  }

  /** The position of a marker at this height that is well seen from a spot and about it, and serves the most cells that see fewer than two;
   *  null when there is none. */
  suggestionNear(spot: Point, z: number): Point | null {
    const { columns, rows, resolution_m: r } = this.floor.info;
    const at = this.floor.toGrid(spot);
    const reach = Math.max(this.reachM(z) - aboutSpotM, 0.5 * this.reachM(z)) / r;
    const stride = Math.max(1, Math.round(0.3 / r));
    let best: Point | null = null;
    let bestGain = -1;
    for (let row = Math.max(0, Math.floor(at.y - reach)); row < Math.min(rows, at.y + reach); row += stride) {
      for (let column = Math.max(0, Math.floor(at.x - reach)); column < Math.min(columns, at.x + reach); column += stride) {
        const there = { x: column + 0.5, y: row + 0.5 };
        const apart = Math.hypot(there.x - at.x, there.y - at.y);
        if (apart > reach || !this.floor.isFree(row * columns + column) || !this.floor.sees(at, this.site.coverage.camera_height_m, there, z)) continue;
        const middle = this.floor.centerOfCell(row * columns + column);
        const gain = this.visibleFrom(middle, z).filter((cell) => this.counts[cell]! < enoughMarkers).length - apart / (1 + reach);
        if (gain > bestGain) [best, bestGain] = [middle, gain];
      }
    }
    return best;
  }

  private count(cells: Int32Array, by: number): void { for (const cell of cells) this.counts[cell]! += by; }

  /** The cells where the robot can be that see a marker with this centre. */
  visibleFrom(middle: Point, z: number): Int32Array {
    const { columns, rows, resolution_m: r } = this.floor.info;
    const at = this.floor.toGrid(middle);
    const reach = this.reachM(z) / r;
    const cameraZ = this.site.coverage.camera_height_m;
    const cells: number[] = [];
    for (let row = Math.max(0, Math.floor(at.y - reach)); row < Math.min(rows, at.y + reach); ++row) {
      for (let column = Math.max(0, Math.floor(at.x - reach)); column < Math.min(columns, at.x + reach); ++column) {
        const cell = { x: column + 0.5, y: row + 0.5 };
        if ((cell.x - at.x) ** 2 + (cell.y - at.y) ** 2 > reach * reach) continue;
        const index = row * columns + column;
        if (this.floor.canStand(index) && this.floor.sees(cell, cameraZ, at, z)) cells.push(index);
      }
    }
    return Int32Array.from(cells);
  }
}
