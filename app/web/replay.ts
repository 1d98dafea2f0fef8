// Plays back a run folder on the map that it was driven on: track, robot pose over time, plots, events and camera pictures,
// with a time bar; a second run beside it.
import { getRun, getRuns, pictureOfRun } from './api.js';
import type { Row, Run, Site } from './api.js';
import { button, byId, el, positive } from './dom.js';
import { HeatLayer } from './heat_layer.js';
import type { HeatActions } from './heat_layer.js';
import { DrivePlots } from './plots.js';
import { lastNotAfter, poseAt } from './poses.js';
import { drawEllipse, drawRobot, drawWay, inkNow } from './robot_paint.js';
import { linkTo } from './run_link.js';
import type { RunLink } from './run_link.js';
import { RunEvents } from './run_events.js';
import { RunList } from './run_list.js';
import { columnsOf, covarianceAt } from './run_plots.js';
import { sceneOf } from './run_scene.js';
import { showSummary } from './run_summary.js';
import type { Stage } from './stage.js';

const lookEveryMs = 2000;
const speeds = ['0.2', '1', '2', '5', '10', '50'];

export class Replay {
  time = 0;
  run: Run | null = null;
  second: Run | null = null;
  onClose: () => void = () => {};
  private opened = false;
  private watching = 0;
  private listed = '';
  private asked = '';  // the run that was chosen last: answers about runs chosen before it come too late
  private askedBeside: string | null = null;
  private playing = false;
  private lastFrame = 0;
  private plots: DrivePlots | null = null;
  private columns: (number | null)[][] = [[]];
  private shownPicture = '';
  private wanted: RunLink | null = null;
  private readonly list = new RunList({ open: (name) => { this.load(name).catch(this.fail); }, beside: (name) => { this.loadSecond(name).catch(this.fail); } });
  private readonly events = new RunEvents((time) => this.settleAt(time));
  private readonly heat: HeatLayer;
  private readonly runs = el('select', { 'aria-label': 'Run' });
  private readonly slider = el('input', { type: 'range', min: '0', step: '0.01', value: '0', 'aria-label': 'Time' });
  private readonly speed = el('select', { 'aria-label': 'Speed' }, ...speeds.map((s) => el('option', { value: s }, `${s} ×`)));
  private readonly play = button('Play', 'Play or pause (P; the space bar too while no robot is connected)', () => this.toggle());
  private readonly words = el('output', { id: 'replay-words' });
  private readonly noPicture = el('p', { class: 'faint' }, 'No pictures: lodestar replay --pictures 2 keeps two per second');
  private readonly picture = el('img', { id: 'replay-picture', alt: 'Camera picture of that time', hidden: '' });

  constructor(private readonly stage: Stage, private readonly site: Site, heatActions: HeatActions, private readonly fail: (error: unknown) => void) {
    this.heat = new HeatLayer(stage, heatActions);
    byId('replay').append(this.runs, this.play, this.slider, this.speed, this.words,
      button('Close', 'Close the playback', () => this.onClose()));
    byId('picture-box').append(this.picture, this.noPicture);
    this.speed.value = '1';
    this.runs.addEventListener('change', () => { this.load(this.runs.value).catch(this.fail); });
    this.slider.addEventListener('input', () => this.goTo(this.slider.valueAsNumber));
    this.slider.addEventListener('change', () => this.keepLink());
    addEventListener('keydown', (e) => this.key(e));
    stage.painters.push((c) => this.paint(c));
  }

  /** Shows the bar with the latest run, or the one that is wanted, or reports that there is none; new runs are added as they
   *  appear. */
  async open(wanted: RunLink | null = null): Promise<string> {
    this.opened = true;
    this.wanted = wanted;
    clearInterval(this.watching);
    this.watching = setInterval(() => { this.look().catch(this.fail); }, lookEveryMs);
    await this.look();
    return this.run ? '' : 'No run folders yet: replay -o and the drives of this console write them to --runs FOLDER';
  }

  private async look(): Promise<void> {
    const runs = await getRuns();
    const listed = JSON.stringify(runs);
    if (!this.opened || listed === this.listed) return;
    this.listed = listed;
    this.list.show(runs);
    const names = runs.filter((run) => run.goals !== null).map((run) => run.name);
    if (names.length === 0) return;
    this.heat.load().catch(this.fail);
    const { wanted } = this;
    if (wanted && !names.includes(wanted.run)) this.fail(new Error(`There is no run '${wanted.run}' any more`));
    const chosen = this.run?.name ?? (wanted && names.includes(wanted.run) ? wanted.run : names.at(-1)!);
    this.runs.replaceChildren(...names.map((name) => el('option', { value: name }, name)));
    this.runs.value = chosen;
    if (this.run) return;
    byId('replay').hidden = byId('replay-plots').hidden = false;
    this.plots ??= new DrivePlots(byId('replay-plots'), (time) => this.settleAt(time));
    const isShown = await this.load(chosen);
    this.wanted = null;
    if (!isShown || wanted?.run !== chosen) return;
    if (wanted.at !== null) this.settleAt(wanted.at);
    if (wanted.beside !== null && names.includes(wanted.beside)) await this.loadSecond(wanted.beside);
  }

  leave(): void {
    this.opened = false;
    clearInterval(this.watching);
    this.listed = this.asked = '';
    this.run = this.second = this.askedBeside = null;
    this.playing = false;
    this.stage.scene = null;
    byId('replay').hidden = byId('replay-plots').hidden = true;
    linkTo(null);
    this.stage.redraw();
  }

  goTo(time: number): void {
    this.time = Math.min(this.end(), Math.max(this.start(), time));
    this.slider.value = String(this.time);
    this.words.textContent = this.report();
    this.plots?.tell(lastNotAfter(this.columns[0]!.length, (i) => this.columns[0]![i]!, this.time), true);
    this.events.mark(this.time);
    this.showPicture();
    this.stage.redrawOverlay();
  }

  /** Of the robot standing at a time that somebody chose: the address leads there. */
  private settleAt(time: number): void {
    this.goTo(time);
    this.keepLink();
  }

  private keepLink(): void {
    if (this.run) linkTo({ run: this.run.name, at: this.time, beside: this.second?.name ?? null });
  }

  /** Shows a run from its start; one that is shown already stays at its time. False when another was chosen meanwhile. */
  private async load(name: string): Promise<boolean> {
    this.asked = name;
    const run = await getRun(name);
    const { scene, words } = await sceneOf(run, this.stage, this.site);
    if (this.asked !== name) return false;
    const time = this.run?.name === name ? this.time : null;
    this.run = run;
    if (this.second?.name === name) this.second = this.askedBeside = null;
    this.stage.scene = scene;
    this.runs.value = name;
    this.list.mark(name, this.second?.name ?? null);
    this.events.show(run, this.start());
    [this.slider.min, this.slider.max] = [String(Math.floor(100 * this.start()) / 100), String(this.end())];
    this.columns = columnsOf(run);
    this.plots?.set(this.columns);
    showSummary(run, words);
    this.stage.redraw();
    this.settleAt(time ?? this.start());
    return true;
  }

  private async loadSecond(name: string | null): Promise<void> {
    this.askedBeside = name;
    const run = name === null ? null : await getRun(name);
    if (this.askedBeside !== name) return;
    this.second = run;
    this.list.mark(this.run?.name ?? '', name);
    this.settleAt(this.time);
  }

  /** Stamps continue from drive to drive, so a run does not start at zero. */
  private start(): number { return this.run?.estimate[0]?.[0] ?? 0; }
  private end(): number { return Math.max(this.run?.estimate.at(-1)?.[0] ?? 0, this.run?.truth.at(-1)?.[0] ?? 0); }

  private key(e: KeyboardEvent): void {
    const onControl = e.target instanceof HTMLElement && e.target.closest('button, input, select, dialog') !== null;
    if (!this.run || onControl) return;
    const step = e.shiftKey ? 5 : 0.5;
    if (e.key === ' ' || e.key === 'p') this.toggle();
    else if (e.key === 'ArrowLeft') this.settleAt(this.time - step);
    else if (e.key === 'ArrowRight') this.settleAt(this.time + step);
    else return;
    e.preventDefault();
  }

  private toggle(): void {
    this.playing = !this.playing;
    this.play.textContent = this.playing ? 'Pause' : 'Play';
    if (this.playing && this.time >= this.end()) this.goTo(this.start());
    this.lastFrame = performance.now();
    if (!this.playing) this.keepLink();
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
    const at = lastNotAfter(names.length, (i) => parseFloat(names[i]!), this.time);
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
    const error = truth ? `; error ${(1000 * Math.hypot(estimate[1] - truth[1], estimate[2] - truth[2])).toFixed(1)} mm` : '';
    const other = this.secondNow();
    return place + error + (other ? `; ${this.second!.name} is ${Math.hypot(estimate[1] - other[1], estimate[2] - other[2]).toFixed(2)} m away` : '');
  }

  /** Where the second run was as long after its start. */
  private secondNow(): Row | null {
    const begun = this.second?.estimate[0]?.[0];
    return begun === undefined ? null : poseAt(this.second!.estimate, begun + this.time - this.start());
  }

  private paint(c: CanvasRenderingContext2D): void {
    if (!this.run) return;
    const colours = inkNow();
    const { view } = this.stage;
    this.heat.paint(c);
    const points = (rows: Row[]) => rows.map(([, x, y]) => ({ x, y }));
    drawWay(c, view, points(this.run.truth), colours.truth, 1.5, [4, 4]);
    drawWay(c, view, points(this.run.estimate), colours.track, 2);
    const pose = poseAt(this.run.estimate, this.time);
    const covariance = covarianceAt(this.run, this.time);
    if (pose && covariance) drawEllipse(c, view, { x: pose[1], y: pose[2] }, covariance, colours.goal);
    const other = this.secondNow();
    if (this.second) drawWay(c, view, points(this.second.estimate), colours.preview, 2, [8, 4]);
    if (other) drawRobot(c, view, { x: other[1], y: other[2], yawDeg: other[3] }, this.site.robot, colours.preview);
    if (pose) drawRobot(c, view, { x: pose[1], y: pose[2], yawDeg: pose[3] }, this.site.robot, colours.robot);
  }
}
