// Number of markers a robot sees at every heading from each cell where it can be: those within the narrowest
// side of its camera's view, with nothing occupied in between. Where markers are many it costs seconds, so that the page
// has it counted by a worker: counted.ts.
import type { Site } from './api.js';
import type { Floor } from './floor.js';
import { centerOf } from './geometry.js';
import type { Marker, Point } from './geometry.js';

export const enoughMarkers = 2;

/** Cells of the map: this many columns and rows from a corner on. */
export interface Box { column: number; row: number; columns: number; rows: number }

export class Coverage {
  readonly counts: Uint16Array;
  private readonly seenFrom = new Map<number, { marker: Marker; cells: Int32Array }>();

  constructor(readonly floor: Floor, readonly camera: Site['coverage']) { this.counts = new Uint16Array(floor.cells.length); }

  /** Counts this marker, in place of the one that had its key. Returns the boxes in which counts have changed. */
  put(marker: Marker): Box[] {
    const boxes = this.remove(marker.key);
    const cells = this.visibleFrom(centerOf(marker), marker.z);
    this.count(cells, 1);
    this.seenFrom.set(marker.key, { marker, cells });
    return [...boxes, this.reachOf(marker)];
  }

  remove(key: number): Box[] {
    const known = this.seenFrom.get(key);
    if (!known) return [];
    this.count(known.cells, -1);
    this.seenFrom.delete(key);
    return [this.reachOf(known.marker)];
  }

  private count(cells: Int32Array, by: number): void { for (const cell of cells) this.counts[cell]! += by; }

  private reachOf(marker: Marker): Box { return this.boxAbout(this.floor.toGrid(centerOf(marker)), this.reach(marker.z)); }

  /** In cells. */
  reach(z: number): number { return reachM(this.camera, z) / this.floor.info.resolution_m; }

  private boxAbout(at: Point, reach: number): Box {
    const { columns, rows } = this.floor.info;
    const column = Math.min(columns, Math.max(0, Math.floor(at.x - reach))), row = Math.min(rows, Math.max(0, Math.floor(at.y - reach)));
    return { column, row, columns: Math.max(0, Math.min(columns, Math.ceil(at.x + reach)) - column), rows: Math.max(0, Math.min(rows, Math.ceil(at.y + reach)) - row) };
  }

  /** The cells where the robot can be that see a marker with this centre. */
  visibleFrom(middle: Point, z: number): Int32Array {
    const { floor } = this;
    const at = floor.toGrid(middle);
    const reach = this.reach(z);
    const box = this.boxAbout(at, reach);
    const [endColumn, endRow] = [box.column + box.columns, box.row + box.rows];
    const isClear = floor.isClear(Math.floor(at.x - reach), Math.floor(at.y - reach), Math.ceil(at.x + reach), Math.ceil(at.y + reach));
    const cells: number[] = [];
    for (let row = box.row; row < endRow; ++row) {
      for (let column = box.column; column < endColumn; ++column) {
        const [x, y] = [column + 0.5, row + 0.5];
        if ((x - at.x) ** 2 + (y - at.y) ** 2 > reach * reach) continue;
        const index = row * floor.info.columns + column;
        if (floor.canStand(index) && (isClear || floor.sees({ x, y }, this.camera.camera_height_m, at, z))) cells.push(index);
      }
    }
    return Int32Array.from(cells);
  }
}

/** Horizontal distance within which a marker at this height is seen. */
export const reachM = (camera: Site['coverage'], z: number): number => Math.max(0, (z - camera.camera_height_m) * camera.reach_per_m - camera.margin_m);
