// Counts coverage and searches places for markers beside the page, which never waits for it.
import type { Heights, MapInfo, Site } from './api.js';
import { suggestion, suggestionNear } from './best_places.js';
import type { Breathe } from './best_places.js';
import { Coverage } from './coverage.js';
import type { Box } from './coverage.js';
import { fillGaps } from './fill.js';
import type { Filling } from './fill.js';
import { Floor } from './floor.js';
import type { Marker, Point } from './geometry.js';

export interface Start { info: MapInfo; cells: Int8Array; roomM: number; heights: Heights | null; camera: Site['coverage'] }
export type Question = { ask: 'suggestion'; z: number } | { ask: 'near'; spot: Point; z: number } | { ask: 'fill'; z: number; wanted: number; present: Point[] }
  | { ask: 'settled' };
export type ToWorker = { start: Start } | { put: Marker[]; gone: number[] } | { number: number; question: Question };

/** Counts row by row. */
export interface Patch { box: Box; counts: Uint16Array }
export type Answer = Point | Filling | null;
export type FromWorker = { patches: Patch[] } | { number: number; share: number } | { number: number; answer: Answer };

const countForMs = 30, breatheAfterMs = 30;

class CoverageWorker {
  private readonly coverage: Coverage;
  private readonly waiting = new Map<number, Marker | null>();  // by key; null: gone
  private counting = false;
  private searching: Promise<void> = Promise.resolve();

  constructor(start: Start, private readonly send: (message: FromWorker, moved?: Transferable[]) => void) {
    this.coverage = new Coverage(new Floor(start.info, start.cells, start.roomM, start.heights), start.camera);
  }

  take(message: Exclude<ToWorker, { start: Start }>): void {
    if ('question' in message) {
      this.searching = this.searching.then(() => this.answer(message.number, message.question));
      return;
    }
    for (const key of message.gone) this.waiting.set(key, null);
    for (const marker of message.put) this.waiting.set(marker.key, marker);
    void this.count();
  }

  /** What is waiting, a part at a time. */
  private async count(): Promise<void> {
    if (this.counting) return;
    this.counting = true;
    while (this.waiting.size > 0) {
      this.countSome();
      await turn();
    }
    this.counting = false;
  }

  private countSome(): void {
    const until = performance.now() + countForMs;
    const changed: Box[] = [];
    for (const [key, marker] of this.waiting) {
      this.waiting.delete(key);
      changed.push(...marker ? this.coverage.put(marker) : this.coverage.remove(key));
      if (performance.now() > until) break;
    }
    const patches = changed.map((box) => ({ box, counts: this.countsIn(box) }));
    this.send({ patches }, patches.map((patch) => patch.counts.buffer));
  }

  private countsIn({ column, row, columns, rows }: Box): Uint16Array {
    const across = this.coverage.floor.info.columns;
    const counts = new Uint16Array(columns * rows);
    for (let r = 0; r < rows; ++r) counts.set(this.coverage.counts.subarray((row + r) * across + column, (row + r) * across + column + columns), r * columns);
    return counts;
  }

  private async answer(number: number, question: Question): Promise<void> {
    while (this.waiting.size > 0) await turn();
    let last = performance.now();
    const breathe: Breathe = async (share) => {
      if (performance.now() - last < breatheAfterMs) return;
      this.send({ number, share });
      await turn();
      last = performance.now();
    };
    this.send({ number, answer: await this.found(question, breathe) });
  }

  private async found(question: Question, breathe: Breathe): Promise<Answer> {
    switch (question.ask) {
      case 'settled': return null;
      case 'suggestion': return await suggestion(this.coverage, question.z, breathe);
      case 'near': return suggestionNear(this.coverage, question.spot, question.z);
      case 'fill': return await fillGaps(this.coverage, question.z, question.wanted, question.present, breathe);
    }
  }
}

/** Messages that have arrived are taken. */
const turn = (): Promise<void> => new Promise((done) => setTimeout(done));

const scope = globalThis as unknown as { onmessage: (event: MessageEvent<ToWorker>) => void; postMessage(message: FromWorker, moved?: Transferable[]): void };
let worker: CoverageWorker | null = null;
scope.onmessage = ({ data }) => {
  if ('start' in data) worker = new CoverageWorker(data.start, (message, moved) => scope.postMessage(message, moved ?? []));
  else worker?.take(data);
};
