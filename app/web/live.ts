// The live view: the robot's state, and its goals.
import type { Site } from './api.js';
import { CameraPicture } from './camera_picture.js';
import { button, byId, el } from './dom.js';
import { Goals, goalJson } from './goals.js';
import type { Goal } from './goals.js';
import { LiveSocket } from './live_socket.js';
import type { Hello, Listener, Picture, Preview, State } from './live_socket.js';
import { DrivePanel } from './drive_panel.js';
import { HandDrive } from './hand.js';
import { Places } from './places.js';
import { DrivePlots } from './plots.js';
import type { Guest } from './pointer.js';
import { drawEllipse, drawGoal, drawRobot, drawWay, ellipseOf, inkNow } from './robot_paint.js';
import type { Stage } from './stage.js';
import type { Point } from './geometry.js';
import { SurveyView } from './survey.js';
import type { Survey } from './survey.js';

const holdEveryMs = 250;
const staleAfterMs = 1500;
const keptRows = 1200;       // a minute
const plotEveryMs = 200;
const trackStepM = 0.02;
const mostTrack = 5000;

export class Live implements Guest, Listener {
  hello: Hello | null = null;
  state: State | null = null;
  preview: Preview | null = null;
  readonly goals: Goals;
  readonly camera = new CameraPicture();
  onRobot: () => void = () => {};
  private readonly socket: LiveSocket;
  private readonly panel: DrivePanel;
  private readonly places: Places;
  readonly hand: HandDrive;
  readonly survey: SurveyView;
  private plots: DrivePlots | null = null;
  private path: Point[] = [];
  private track: Point[] = [];
  private columns: (number | null)[][] = Array.from({ length: 7 }, () => []);
  private heardAt = 0;
  private plottedAt = 0;
  private shown = false;
  private surveys = false;
  private wantsControl = false;
  private hasDriven = false;

  constructor(private readonly stage: Stage, private readonly site: Site, private readonly say: (words: string, bad?: boolean) => void) {
    this.goals = new Goals(stage.view);
    this.goals.onChange = () => this.goalsChanged();
    this.panel = new DrivePanel(this);
    this.places = new Places(this.goals, say);
    this.hand = new HandDrive((order) => this.order(order), () => this.releaseControl());
    this.survey = new SurveyView(stage, stage.editor, { say, goTo: (at) => { stage.view.fit([at], 3); stage.redraw(); },
      driveTo: (at) => this.goals.set([{ ...at, yawDeg: null }]) });
    byId('hand').append(this.hand.element);
    byId('camera-box').append(this.camera.element, this.camera.words);
    this.makeControls();
    stage.painters.push((c) => { if (this.shown) this.paint(c); });
    this.socket = new LiveSocket(this);
    setInterval(() => this.beat(), holdEveryMs);
  }

  /** While shown, pictures are requested, and clicks on the map set goals. `surveys`: a survey is shown too. */
  show(shown: boolean, surveys = false): void {
    this.shown = shown;
    this.surveys = surveys;
    if (!shown) this.hand.set(false);
    if (shown) {
      this.plots ??= new DrivePlots(byId('live-plots'));
      this.places.open();
    }
    this.wantPictures();
    this.stage.redraw();
  }

  private wantPictures(): void { if (this.hello?.robot) this.socket.send({ type: 'camera', on: this.shown }); }

  get canDrive(): boolean { return this.hello?.role === 'drive' && this.hello.robot; }
  get atWheel(): boolean { return this.state !== null && this.state.driver === this.hello?.client; }
  get isStale(): boolean { return performance.now() - this.heardAt > staleAfterMs; }

  // -- messages from the robot ------------------------------------------------------------------------------

  onHello(hello: Hello): void {
    const first = this.hello === null;
    this.hello = hello;
    this.wantsControl = false;
    this.wantPictures();
    if (hello.robot) document.body.dataset['robot'] = '';
    if (hello.survey) document.body.dataset['survey'] = '';
    if (first && hello.robot) this.onRobot();
    this.panel.refresh();
  }

  onState(state: State): void {
    this.heardAt = performance.now();
    this.state = state;
    if (state.pose) this.addToTrack({ x: state.pose.x_m, y: state.pose.y_m });
    this.addToPlots(state);
    this.watchControl(state);
    if (!this.shown) return;
    this.panel.refresh();
    this.stage.redrawOverlay();
  }

  onPath(points: [number, number][]): void {
    this.path = points.map(([x, y]) => ({ x, y }));
    this.stage.redrawOverlay();
  }

  onPreview(preview: Preview): void {
    this.preview = preview;
    this.panel.refresh();
    this.stage.redrawOverlay();
  }

  onRefused(what: string, why: string): void {
    if (what === 'take' || what === 'hold') this.wantsControl = false;
    if (what !== 'hold') this.say(`Not done (${what}): ${why}`, true);
  }

  onSurvey(survey: Survey): void { this.survey.set(survey); }

  onPicture(picture: Picture): void { if (this.shown) this.camera.show(picture); }

  onGone(): void {
    this.wantsControl = false;
    if (this.hello?.robot) this.say('The connection to the robot is lost; trying again', true);
    this.panel.refresh();
    this.stage.redrawOverlay();
  }

  private addToTrack(at: Point): void {
    const last = this.track.at(-1);
    if (last && Math.hypot(at.x - last.x, at.y - last.y) < trackStepM) return;
    this.track.push(at);
    if (this.track.length > mostTrack) this.track.splice(0, mostTrack / 10);
  }

  private addToPlots(state: State): void {
    const sigmaMm = state.pose ? 1000 * ellipseOf(state.pose.covariance_m2, 3).long : null;
    const errorMm = state.error_m === null ? null : 1000 * state.error_m;
    const sees = state.seen_s !== null && state.time_s - state.seen_s < 0.5;
    const row = [state.time_s, sigmaMm, errorMm, state.commanded.forward_mps, state.measured?.forward_mps ?? null,
      sees ? state.confidence : null, sees ? state.markers.length : 0];
    this.columns.forEach((column, i) => {
      column.push(row[i]!);
      if (column.length > keptRows) column.shift();
    });
    if (!this.shown || performance.now() - this.plottedAt < plotEveryMs) return;
    this.plottedAt = performance.now();
    this.plots?.set(this.columns);
    this.plots?.tell(this.columns[0]!.length - 1);
  }

  // -- the user's orders ------------------------------------------------------------------------------------

  /** Any client may stop. Without a connection nothing can be sent, and a driver's lease runs out by itself. */
  stop(): void {
    this.say(this.socket.send({ type: 'stop' }) ? 'Stop' : 'No connection: use the button on the robot', true);
  }

  drive(): void {
    if (this.goals.list.length === 0) return;
    this.order({ type: 'go', goals: this.goals.list.map(goalJson) });
    this.hasDriven = false;
  }

  order(message: Record<string, unknown>): void {
    if (!this.atWheel) this.socket.send({ type: 'take' });
    this.wantsControl = true;
    if (!this.socket.send(message)) this.say('No connection to the robot', true);
  }

  releaseControl(): void {
    this.wantsControl = false;
    this.socket.send({ type: 'release' });
  }

  /** Sets the robot's pose to the first goal's position and heading. */
  placeRobot(): void {
    const goal = this.goals.list[0];
    if (goal?.yawDeg == null) return this.say('Set a goal on the map and drag its arrow to the robot\'s heading first', true);
    this.order({ type: 'place', pose: goalJson(goal) });
    this.goals.set([]);
  }

  /** Renews the control lease while this page is visible. */
  private beat(): void {
    if (this.wantsControl && !document.hidden) this.socket.send({ type: 'hold' });
    byId('stale').hidden = !(this.hello?.robot && this.shown && this.isStale);
    if (this.isStale && this.shown) {
      byId('stale').textContent = `No data from the robot for ${((performance.now() - this.heardAt) / 1000).toFixed(0)} s`;
      this.stage.redrawOverlay();
    }
  }

  /** Releases the control lease when the drive is over. */
  private watchControl(state: State): void {
    if (state.moving) this.hasDriven = true;
    if (this.hand.on) this.hasDriven = false;
    if (this.wantsControl && this.hasDriven && !state.moving) {
      this.hasDriven = false;
      this.releaseControl();
      this.goals.set([]);
    }
  }

  private goalsChanged(): void {
    this.preview = null;
    if (this.goals.list.length > 0 && this.canDrive) this.socket.send({ type: 'preview', goals: this.goals.list.map(goalJson) });
    this.panel.refresh();
    this.stage.redrawOverlay();
  }

  private makeControls(): void {
    byId('live-controls').append(
      button('Stop', 'Stop the robot (space bar)', () => this.stop(), { id: 'live-stop' }),
      button('Pause', 'Stop and keep the goal', () => this.order({ type: 'pause' }), { id: 'live-pause' }),
      button('Resume', 'Continue to the goal', () => this.order({ type: 'resume' }), { id: 'live-resume' }),
      button('Clear fault', 'Clear the latched fault of the base, if its cause is gone', () => this.order({ type: 'clear_fault' }), { id: 'live-clear' }),
      el('span', { id: 'live-phase' }),
    );
    addEventListener('keydown', (e) => {
      const onControl = e.target instanceof HTMLElement && e.target.closest('button, input, select, dialog') !== null;
      if (e.key !== ' ' || !this.shown || onControl) return;
      e.preventDefault();
      this.stop();
    });
  }

  // -- the map ----------------------------------------------------------------------------------------------

  press(screen: Point): boolean { return this.goals.press(screen); }
  drag(screen: Point): void { this.goals.drag(screen); }
  release(): void { this.goals.release(); }
  click(at: Point, also: boolean): void { if (this.canDrive) this.goals.click(at, also); }

  private paint(c: CanvasRenderingContext2D): void {
    const { view } = this.stage;
    const colours = inkNow();
    if (this.surveys) this.survey.paint(c);
    else drawWay(c, view, this.track, colours.track, 1.5);
    drawWay(c, view, this.path, colours.path, 3);
    if (this.preview?.points) drawWay(c, view, this.preview.points.map(([x, y]) => ({ x, y })), colours.preview, 3, [8, 6]);
    this.paintMarkersInView(c);
    const state = this.state;
    if (state?.pose) {
      const pose = { x: state.pose.x_m, y: state.pose.y_m, yawDeg: state.pose.yaw_deg };
      drawRobot(c, view, pose, this.site.robot, this.isStale ? colours.stale : colours.robot);
      drawEllipse(c, view, pose, state.pose.covariance_m2, colours.goal);
    }
    const many = this.goals.list.length > 1;
    this.goals.list.forEach((goal: Goal, i) => drawGoal(c, view, goal, goal.yawDeg, many ? String(i + 1) : 'Goal', colours.goal));
    state?.goals.slice(state.current).forEach(([x, y, yaw]) => drawGoal(c, view, { x: x!, y: y! }, yaw ?? null, '', colours.path));
  }

  private paintMarkersInView(c: CanvasRenderingContext2D): void {
    const state = this.state;
    if (!state?.pose || state.seen_s === null || state.time_s - state.seen_s > 0.5) return;
    const from = this.stage.view.toScreen({ x: state.pose.x_m, y: state.pose.y_m });
    c.save();
    c.strokeStyle = inkNow().truth;
    c.lineWidth = 1.5;
    c.setLineDash([3, 4]);
    for (const id of state.markers) {
      const at = this.stage.placeOfId(id);
      if (!at) continue;
      const p = this.stage.view.toScreen(at);
      c.beginPath();
      c.moveTo(from.x, from.y); c.lineTo(p.x, p.y);
      c.stroke();
      c.strokeRect(p.x - 11, p.y - 11, 22, 22);
    }
    c.restore();
  }

  middle(): Point { return this.stage.view.center; }

  words(): string {
    const state = this.state;
    if (!this.hello) return 'No connection yet';
    if (!this.hello.robot) return 'No robot is connected: start the console with lodestar replay --serve, or lodestar run --serve';
    if (!state) return 'Waiting for the robot';
    return `${state.phase}${state.moving && state.goals.length > 1 ? `, goal ${state.current + 1} of ${state.goals.length}` : ''}`;
  }
}
