// How many markers a robot sees from each free cell, however it has turned: those within the narrowest side of
// its camera's view, with no occupied cell on the way.
import type { MapInfo, Site } from './api.js';
import { centerOf, inverse, transform } from './geometry.js';
import type { Marker, Point, Pose } from './geometry.js';

const occupiedFrom = 50;
const enoughMarkers = 2;

export interface Gap { at: Point; areaM2: number; low: Point; high: Point }

export class Floor {
  readonly origin: Pose;
  private readonly gridFromMap: Pose;

  constructor(readonly info: MapInfo, readonly cells: Int8Array) {
    this.origin = { x: info.origin.x_m, y: info.origin.y_m, yawDeg: info.origin.yaw_deg };
    this.gridFromMap = inverse(this.origin);
  }

  isFree(index: number): boolean {
    const value = this.cells[index]!;
    return value >= 0 && value < occupiedFrom;
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

  /** Is nothing between a marker and a cell? What the marker itself hangs over leaves it in sight: it does not
   *  reach the ceiling. All else that is occupied is taken to. */
  sees(cell: Point, marker: Point): boolean {
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

  /** How far from below itself a marker at this height is seen. */
  reachM(z: number): number {
    const c = this.site.coverage;
    return Math.max(0, (z - c.camera_height_m) * c.reach_per_m - c.margin_m);
  }

  /** Brings the counts up to date; only markers that are new, gone or moved cost anything. */
  update(markers: Iterable<Marker>): void {
    const gone = new Set(this.seenFrom.keys());
    for (const marker of markers) {
      gone.delete(marker.key);
      const known = this.seenFrom.get(marker.key);
      if (known && known.marker.x === marker.x && known.marker.y === marker.y && known.marker.z === marker.z &&
        known.marker.yawDeg === marker.yawDeg) continue;
      if (known) this.count(known.cells, -1);
      const cells = this.cellsThatSee(centerOf(marker), this.reachM(marker.z));
      this.count(cells, 1);
      this.seenFrom.set(marker.key, { marker, cells });
    }
    for (const key of gone) {
      this.count(this.seenFrom.get(key)!.cells, -1);
      this.seenFrom.delete(key);
    }
  }

  /** Shares of the free floor: sees one marker at least, two at least. */
  shares(): { one: number; two: number } {
    let free = 0, one = 0, two = 0;
    for (let i = 0; i < this.counts.length; ++i) {
      if (!this.floor.isFree(i)) continue;
      ++free;
      if (this.counts[i]! >= 1) ++one;
      if (this.counts[i]! >= enoughMarkers) ++two;
    }
    return { one: free ? one / free : 1, two: free ? two / free : 1 };
  }

  /** Connected free places that see nothing, the largest first; specks are left out. */
  gaps(leastM2 = 0.1): Gap[] {
    const { columns, resolution_m: r } = this.floor.info;
    const visited = new Uint8Array(this.counts.length);
    const gaps: Gap[] = [];
    for (let start = 0; start < this.counts.length; ++start) {
      if (visited[start] || !this.isBlind(start)) continue;
      const open = [start];
      visited[start] = 1;
      const cells: number[] = [];
      while (open.length > 0) {
        const cell = open.pop()!;
        cells.push(cell);
        const column = cell % columns;
        for (const next of [column > 0 ? cell - 1 : -1, column < columns - 1 ? cell + 1 : -1, cell - columns, cell + columns]) {
          if (next < 0 || next >= visited.length || visited[next] || !this.isBlind(next)) continue;
          visited[next] = 1;
          open.push(next);
        }
      }
      if (cells.length * r * r >= leastM2) gaps.push(this.gapOf(cells, r));
    }
    return gaps.sort((a, b) => b.areaM2 - a.areaM2);
  }

  /** Where one more marker at this height would let the most blind cells see; null when none are blind. */
  suggestion(z: number): Point | null {
    const { columns, rows, resolution_m: r } = this.floor.info;
    const stride = Math.max(1, Math.round(0.3 / r));
    const reach = this.reachM(z);
    let best: Point | null = null;
    let bestGain = 0;
    for (let row = stride >> 1; row < rows; row += stride) {
      for (let column = stride >> 1; column < columns; column += stride) {
        const index = row * columns + column;
        if (!this.floor.isFree(index)) continue;
        const at = this.floor.centerOfCell(index);
        const gain = this.cellsThatSee(at, reach).filter((cell) => this.counts[cell] === 0).length;
        if (gain > bestGain) [best, bestGain] = [at, gain];
      }
    }
    return best;
  }

  private isBlind(index: number): boolean { return this.counts[index] === 0 && this.floor.isFree(index); }

  private gapOf(cells: number[], r: number): Gap {
    const points = cells.map((cell) => this.floor.centerOfCell(cell));
    const low = { x: Infinity, y: Infinity }, high = { x: -Infinity, y: -Infinity };
    for (const p of points) {
      low.x = Math.min(low.x, p.x); low.y = Math.min(low.y, p.y);
      high.x = Math.max(high.x, p.x); high.y = Math.max(high.y, p.y);
    }
    return { at: points[points.length >> 1]!, areaM2: cells.length * r * r, low, high };
  }

  private count(cells: Int32Array, by: number): void { for (const cell of cells) this.counts[cell]! += by; }

  private cellsThatSee(middle: Point, reachM: number): Int32Array {
    const { columns, rows, resolution_m: r } = this.floor.info;
    const at = this.floor.toGrid(middle);
    const reach = reachM / r;
    const cells: number[] = [];
    for (let row = Math.max(0, Math.floor(at.y - reach)); row < Math.min(rows, at.y + reach); ++row) {
      for (let column = Math.max(0, Math.floor(at.x - reach)); column < Math.min(columns, at.x + reach); ++column) {
        const cell = { x: column + 0.5, y: row + 0.5 };
        if ((cell.x - at.x) ** 2 + (cell.y - at.y) ** 2 > reach * reach) continue;
        const index = row * columns + column;
        if (this.floor.isFree(index) && this.floor.sees(cell, at)) cells.push(index);
      }
    }
    return Int32Array.from(cells);
  }
}
