// Plays back a run folder on the map: track, robot pose over time, plots and camera pictures, with a time
// bar.
import { getRun, getRuns, pictureOfRun } from './api.js';
import type { Row, Run } from './api.js';
import { button, byId, el, positive } from './dom.js';
import { DrivePlots } from './plots.js';
import { poseAt } from './poses.js';
import { drawRobot, drawWay, inkNow } from './robot_paint.js';
import type { RobotShape } from './robot_paint.js';
import { columnsOf, lastNotAfter } from './run_plots.js';
import { showSummary } from './run_summary.js';
import type { Stage } from './stage.js';

const lookEveryMs = 2000;
const speeds = ['0.2', '1', '2', '5', '10', '50'];

export class Replay {
  time = 0;
  run: Run | null = null;
  onClose: () => void = () => {};
  private opened = false;
  private watching = 0;
  private listed = '';
  private playing = false;
  private lastFrame = 0;
  private plots: DrivePlots | null = null;
  private columns: (number | null)[][] = [[]];
  private shownPicture = '';
  private readonly runs = el('select', { 'aria-label': 'Run' });
  private readonly slider = el('input', { type: 'range', min: '0', step: '0.01', value: '0', 'aria-label': 'Time' });
  private readonly speed = el('select', { 'aria-label': 'Speed' }, ...speeds.map((s) => el('option', { value: s }, `${s} ×`)));
  private readonly play = button('Play', 'Play or pause (P; the space bar too while no robot is connected)', () => this.toggle());
  private readonly words = el('output', { id: 'replay-words' });
  private readonly noPicture = el('p', { class: 'faint' }, 'No pictures: lodestar replay --pictures 2 keeps two per second');
  private readonly picture = el('img', { id: 'replay-picture', alt: 'Camera picture of that time', hidden: '' });

  constructor(private readonly stage: Stage, private readonly robot: RobotShape, private readonly fail: (error: unknown) => void) {
    byId('replay').append(this.runs, this.play, this.slider, this.speed, this.words,
      button('Close', 'Close the playback', () => this.onClose()));
    byId('picture-box').append(this.picture, this.noPicture);
    this.speed.value = '1';
    this.runs.addEventListener('change', () => { this.load(this.runs.value).catch(this.fail); });
    this.slider.addEventListener('input', () => this.goTo(this.slider.valueAsNumber));
    addEventListener('keydown', (e) => this.key(e));
    stage.painters.push((c) => this.paint(c));
  }

  /** Shows the bar with the latest run, or reports that there is none; new runs are added as they appear. */
  async open(): Promise<string> {
    this.opened = true;
    clearInterval(this.watching);
    this.watching = setInterval(() => { this.look().catch(this.fail); }, lookEveryMs);
    await this.look();
    return this.run ? '' : 'No run folders yet: replay -o and the drives of this console write them to --runs FOLDER';
  }

  private async look(): Promise<void> {
    const names = await getRuns();
    if (!this.opened || names.length === 0 || names.join() === this.listed) return;
    this.listed = names.join();
    const chosen = this.run?.name ?? names.at(-1)!;
    this.runs.replaceChildren(...names.map((name) => el('option', { value: name }, name)));
    this.runs.value = chosen;
    if (this.run) return;
    byId('replay').hidden = byId('replay-plots').hidden = false;
    this.plots ??= new DrivePlots(byId('replay-plots'), (time) => this.goTo(time));
    await this.load(chosen);
  }

  leave(): void {
    this.opened = false;
    clearInterval(this.watching);
    this.listed = '';
    this.run = null;
    this.playing = false;
    byId('replay').hidden = byId('replay-plots').hidden = true;
    this.stage.redraw();
  }

  goTo(time: number): void {
    this.time = Math.min(this.end(), Math.max(this.start(), time));
    this.slider.value = String(this.time);
    this.words.textContent = this.report();
    this.plots?.tell(lastNotAfter(this.columns[0]!, this.time), true);
    this.showPicture();
    this.stage.redrawOverlay();
  }

  private async load(name: string): Promise<void> {
    this.run = await getRun(name);
    [this.slider.min, this.slider.max] = [String(Math.floor(100 * this.start()) / 100), String(this.end())];
    this.columns = columnsOf(this.run);
    this.plots?.set(this.columns);
    showSummary(this.run);
    this.goTo(this.start());
  }

  /** Stamps continue from drive to drive, so a run does not start at zero. */
  private start(): number { return this.run?.estimate[0]?.[0] ?? 0; }
  private end(): number { return Math.max(this.run?.estimate.at(-1)?.[0] ?? 0, this.run?.truth.at(-1)?.[0] ?? 0); }

  private key(e: KeyboardEvent): void {
    const onControl = e.target instanceof HTMLElement && e.target.closest('button, input, select, dialog') !== null;
    if (!this.run || onControl) return;
    const step = e.shiftKey ? 5 : 0.5;
    if (e.key === ' ' || e.key === 'p') this.toggle();
    else if (e.key === 'ArrowLeft') this.goTo(this.time - step);
    else if (e.key === 'ArrowRight') this.goTo(this.time + step);
    else return;
    e.preventDefault();
  }

  private toggle(): void {
    this.playing = !this.playing;
    this.play.textContent = this.playing ? 'Pause' : 'Play';
    if (this.playing && this.time >= this.end()) this.goTo(this.start());
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

  /** Shows the last picture taken before the present time. */
  private showPicture(): void {
    const names = this.run?.pictures ?? [];
    const at = lastNotAfter(names.map((name) => parseFloat(name)), this.time);
    this.picture.hidden = names.length === 0;
    this.noPicture.hidden = names.length > 0;
    const name = names[at];
    if (!name || !this.run || name === this.shownPicture) return;
    this.shownPicture = name;
    this.picture.src = pictureOfRun(this.run.name, name);
    this.picture.dataset['time'] = String(parseFloat(name));
  }

  private report(): string {
    const estimate = poseAt(this.run?.estimate ?? [], this.time);
    const truth = poseAt(this.run?.truth ?? [], this.time);
    if (!estimate) return '';
    const place = `${this.time.toFixed(1)} of ${this.end().toFixed(1)} s: ${estimate[1].toFixed(3)}, ${estimate[2].toFixed(3)} m, ${positive(estimate[3].toFixed(1))}°`;
    if (!truth) return place;
    return `${place}; error ${(1000 * Math.hypot(estimate[1] - truth[1], estimate[2] - truth[2])).toFixed(1)} mm`;
  }

  private paint(c: CanvasRenderingContext2D): void {
    if (!this.run) return;
    const colours = inkNow();
    const { view } = this.stage;
    const points = (rows: Row[]) => rows.map(([, x, y]) => ({ x, y }));
    drawWay(c, view, points(this.run.truth), colours.truth, 1.5, [4, 4]);
    drawWay(c, view, points(this.run.estimate), colours.track, 2);
    const pose = poseAt(this.run.estimate, this.time);
    if (pose) drawRobot(c, view, { x: pose[1], y: pose[2], yawDeg: pose[3] }, this.robot, colours.robot);
  }
}
