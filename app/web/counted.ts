// The page's copy of what its worker counts: how many markers a robot sees from each cell.
import type { Site } from './api.js';
import { enoughMarkers, reachM } from './coverage.js';
import type { Box } from './coverage.js';
import type { Answer, FromWorker, Patch, Question, ToWorker } from './coverage_worker.js';
import type { Filling } from './fill.js';
import type { Floor } from './floor.js';
import { centerOf } from './geometry.js';
import type { Marker, Point } from './geometry.js';

interface Open { done: (answer: Answer) => void; fail: (error: Error) => void; progress: (share: number) => void }

export class CountedCoverage {
  readonly counts: Uint16Array;
  /** After counts in these boxes have changed. */
  onCounted: (boxes: Box[]) => void = () => {};
  private readonly worker = new Worker('/coverage_worker.js', { type: 'module' });
  private readonly sent = new Map<number, Marker>();
  private readonly open = new Map<number, Open>();
  private asked = 0;
  private readonly floorCells: number;
  private one = 0;
  private enough = 0;

  constructor(readonly floor: Floor, private readonly camera: Site['coverage'], fail: (error: unknown) => void) {
    this.counts = new Uint16Array(floor.cells.length);
    let cells = 0;
    for (let i = 0; i < this.counts.length; ++i) if (floor.canStand(i)) ++cells;
    this.floorCells = cells;
    this.worker.onmessage = ({ data }: MessageEvent<FromWorker>) => this.take(data);
    this.worker.onerror = (event) => {
      for (const open of this.open.values()) open.fail(new Error(event.message));
      this.open.clear();
      fail(new Error(`Coverage cannot be counted: ${event.message}`));
    };
    this.post({ start: { info: floor.info, cells: floor.cells, roomM: floor.roomM, heights: floor.heights, camera } });
  }

  private post(message: ToWorker): void { this.worker.postMessage(message); }

  reachM(z: number): number { return reachM(this.camera, z); }

  /** Has the worker count markers that are new, removed or moved. */
  update(markers: Iterable<Marker>): void {
    const gone = new Set(this.sent.keys());
    const put: Marker[] = [];
    for (const marker of markers) {
      gone.delete(marker.key);
      const known = this.sent.get(marker.key);
      if (known && known.x === marker.x && known.y === marker.y && known.z === marker.z && known.yawDeg === marker.yawDeg) continue;
      this.sent.set(marker.key, marker);
      put.push(marker);
    }
    for (const key of gone) this.sent.delete(key);
    if (put.length > 0 || gone.size > 0) this.post({ put, gone: [...gone] });
  }

  /** Shares of the floor where the robot can be with at least one and at least two markers in view. */
  shares(): { one: number; two: number } {
    return this.floorCells === 0 ? { one: 1, two: 1 } : { one: this.one / this.floorCells, two: this.enough / this.floorCells };
  }

  /** As soon as all markers are counted. */
  async settled(): Promise<void> { await this.ask({ ask: 'settled' }); }

  /** The position of a marker at this height that serves the most blind cells; null when there are none. */
  async suggestion(z: number, progress: (share: number) => void): Promise<Point | null> { return await this.ask({ ask: 'suggestion', z }, progress) as Point | null; }

  /** The position of a marker that is well seen about a spot and serves the most cells that see too few; null when there is none. */
  async suggestionNear(spot: Point, z: number): Promise<Point | null> { return await this.ask({ ask: 'near', spot, z }) as Point | null; }

  /** Positions so that every position sees `wanted` markers. */
  async fillGaps(z: number, wanted: number, progress: (share: number) => void): Promise<Filling> {
    return await this.ask({ ask: 'fill', z, wanted, present: [...this.sent.values()].map(centerOf) }, progress) as Filling;
  }

  private ask(question: Question, progress: (share: number) => void = () => {}): Promise<Answer> {
    return new Promise((done, fail) => {
      const number = ++this.asked;
      this.open.set(number, { done, fail, progress });
      this.post({ number, question });
    });
  }

  private take(message: FromWorker): void {
    if ('patches' in message) {
      for (const patch of message.patches) this.apply(patch);
      this.onCounted(message.patches.map((patch) => patch.box));
    } else if ('share' in message) {
      this.open.get(message.number)?.progress(message.share);
    } else {
      this.open.get(message.number)?.done(message.answer);
      this.open.delete(message.number);
    }
  }

  private apply({ box, counts }: Patch): void {
    const across = this.floor.info.columns;
    for (let i = 0; i < counts.length; ++i) {
      const cell = (box.row + Math.floor(i / box.columns)) * across + box.column + i % box.columns;
      const [before, after] = [this.counts[cell]!, counts[i]!];
      if (before === after) continue;
      this.counts[cell] = after;
      if (!this.floor.canStand(cell)) continue;
      this.one += Number(after >= 1) - Number(before >= 1);
      this.enough += Number(after >= enoughMarkers) - Number(before >= enoughMarkers);
    }
  }
}
