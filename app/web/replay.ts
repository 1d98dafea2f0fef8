// A run folder on the map: its track, the robot at a time, and a bar to scrub through it.
import { getRun, getRuns } from './api.js';
import type { Row, Run } from './api.js';
import { button, byId, el } from './dom.js';
import { wrapDeg } from './geometry.js';
import type { Stage } from './stage.js';

const speeds = ['1', '2', '5', '10', '50'];

/** The pose at a time, between the rows before and after it; the first or the last one beyond the ends. */
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

export class Replay {
  time = 0;
  run: Run | null = null;
  onClose: () => void = () => {};
  private playing = false;
  private lastFrame = 0;
  private readonly runs = el('select', { 'aria-label': 'Run' });
  private readonly slider = el('input', { type: 'range', min: '0', step: '0.01', value: '0', 'aria-label': 'Time' });
  private readonly speed = el('select', { 'aria-label': 'Speed' }, ...speeds.map((s) => el('option', { value: s }, `${s} ×`)));
  private readonly play = button('Play', 'Play or pause', () => this.toggle());
  private readonly words = el('output', { id: 'replay-words' });

  constructor(private readonly stage: Stage, private readonly robotRadiusM: number, private readonly fail: (error: unknown) => void) {
    byId('replay').append(this.runs, this.play, this.slider, this.speed, this.words,
      button('Close', 'Leave the replay', () => this.onClose()));
    this.runs.addEventListener('change', () => { this.load(this.runs.value).catch(this.fail); });
    this.slider.addEventListener('input', () => this.goTo(this.slider.valueAsNumber));
    stage.painters.push((c) => this.paint(c));
  }

  /** Shows the bar with the latest run, or says that there is none. */
  async open(): Promise<string> {
    const names = await getRuns();
    if (names.length === 0) return 'No run folders: start the server with --runs FOLDER, as replay -o leaves them';
    this.runs.replaceChildren(...names.map((name) => el('option', { value: name }, name)));
    this.runs.value = names.at(-1)!;
    byId('replay').hidden = false;
    await this.load(this.runs.value);
    return '';
  }

  leave(): void {
    this.run = null;
    this.playing = false;
    byId('replay').hidden = true;
    this.stage.redraw();
  }

  goTo(time: number): void {
    this.time = Math.min(this.end(), Math.max(0, time));
    this.slider.value = String(this.time);
    this.words.textContent = this.report();
    this.stage.redraw();
  }

  private async load(name: string): Promise<void> {
    this.run = await getRun(name);
    this.slider.max = String(this.end());
    this.goTo(0);
  }

  private end(): number { return Math.max(this.run?.estimate.at(-1)?.[0] ?? 0, this.run?.truth.at(-1)?.[0] ?? 0); }

  private toggle(): void {
    this.playing = !this.playing;
    this.play.textContent = this.playing ? 'Pause' : 'Play';
    if (this.playing && this.time >= this.end()) this.goTo(0);
    this.lastFrame = performance.now();
    if (this.playing) requestAnimationFrame((now) => this.advance(now));
  }

  private advance(now: number): void {
    if (!this.playing) return;
    this.goTo(this.time + Number(this.speed.value) * Math.max(0, now - this.lastFrame) / 1000);
    this.lastFrame = now;
    if (this.time >= this.end()) this.toggle();
    else requestAnimationFrame((next) => this.advance(next));
  }

  private report(): string {
    const estimate = poseAt(this.run?.estimate ?? [], this.time);
    const truth = poseAt(this.run?.truth ?? [], this.time);
    if (!estimate) return '';
    const place = `${this.time.toFixed(1)} of ${this.end().toFixed(1)} s: ${estimate[1].toFixed(3)}, ${estimate[2].toFixed(3)} m, ${estimate[3].toFixed(1)}°`;
    if (!truth) return place;
    return `${place}; off by ${(1000 * Math.hypot(estimate[1] - truth[1], estimate[2] - truth[2])).toFixed(1)} mm`;
  }

  private paint(c: CanvasRenderingContext2D): void {
    if (!this.run) return;
    c.lineWidth = 2;
    c.strokeStyle = '#c33cc0';
    this.paintTrack(c, this.run.estimate);
    const pose = poseAt(this.run.estimate, this.time);
    if (!pose) return;
    const at = this.stage.view.toScreen({ x: pose[1], y: pose[2] });
    const radius = Math.max(6, this.robotRadiusM * this.stage.view.pixelsPerM);
    const angle = this.stage.view.angleOf(pose[3]);
    c.fillStyle = 'rgb(195 60 192 / 45%)';
    c.beginPath();
    c.arc(at.x, at.y, radius, 0, 2 * Math.PI);
    c.fill();
    c.moveTo(at.x, at.y);
    c.lineTo(at.x + radius * Math.cos(angle), at.y + radius * Math.sin(angle));
    c.stroke();
  }

  private paintTrack(c: CanvasRenderingContext2D, rows: Row[]): void {
    c.beginPath();
    for (const row of rows) {
      const p = this.stage.view.toScreen({ x: row[1], y: row[2] });
      c.lineTo(p.x, p.y);
    }
    c.stroke();
  }
}
