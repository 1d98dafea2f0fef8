// The live view: the robot's state, and its goals.
import type { Site } from './api.js';
import { CameraPicture } from './camera_picture.js';
import { Control } from './control.js';
import { button, byId, el } from './dom.js';
import { Goals, goalJson } from './goals.js';
import type { Goal } from './goals.js';
import { LiveSocket } from './live_socket.js';
import type { Hello, Listener, Picture, Preview, Seen, State } from './live_socket.js';
import { LiveTrace } from './live_trace.js';
import { DrivePanel } from './drive_panel.js';
import { HandDrive } from './hand.js';
import { Places } from './places.js';
import type { Guest } from './pointer.js';
import { drawEllipse, drawGoal, drawRobot, drawWay, inkNow } from './robot_paint.js';
import { drawSeen, fieldWords, seenForMs } from './seen_paint.js';
import type { Stage } from './stage.js';
import { stopAlways } from './stop.js';
import type { Point } from './geometry.js';
import { SurveyView } from './survey.js';
import type { Survey } from './survey.js';

const beatEveryMs = 250;
const staleAfterMs = 1500;

export class Live implements Guest, Listener {
  hello: Hello | null = null;
  state: State | null = null;
  preview: Preview | null = null;
  /** Is the socket open? Then a state may still be late. */
  connected = false;
  readonly goals: Goals;
  readonly camera = new CameraPicture();
  readonly control: Control;
  readonly trace = new LiveTrace();
  onRobot: () => void = () => {};
  /** Somebody saved, perhaps this page. */
  onSaving: (what: 'markers' | 'places') => void = () => {};
  private readonly socket: LiveSocket;
  private readonly panel: DrivePanel;
  readonly places: Places;
  readonly hand: HandDrive;
  readonly survey: SurveyView;
  private path: Point[] = [];
  private seen: Seen | null = null;
  private seenAt = 0;
  private heardAt = 0;
  private shown = false;
  private surveys = false;
  private sent = '';  // the goals of the drive under way
  private replan = false;
  hasLanes = false;
  wantsLanes = true;

  constructor(private readonly stage: Stage, private readonly site: Site, private readonly say: (words: string, bad?: boolean) => void) {
    const live = this;
    this.control = new Control({ say, send: (message) => this.socket.send(message), driveOver: () => this.driveOver(), get atWheel() { return live.atWheel; } });
    this.goals = new Goals(stage.view);
    this.goals.onChange = () => this.goalsChanged();
    this.panel = new DrivePanel(this);
    this.places = new Places(this.goals, say);
    this.hand = new HandDrive((order) => this.control.order(order), () => this.control.release());
    this.survey = new SurveyView(stage, stage.editor, { say, goTo: (at) => { stage.view.fit([at], 3); stage.redraw(); },
      driveTo: (at) => this.goals.set([{ ...at, yawDeg: null }]) });
    byId('hand').append(this.hand.element);
    byId('camera-box').append(this.camera.element, this.camera.words);
    this.makeControls();
    stage.painters.push((c) => { if (this.shown) this.paint(c); });
    this.socket = new LiveSocket(this);
    setInterval(() => this.beat(), beatEveryMs);
  }

  /** While shown, pictures are requested, and clicks on the map set goals. `surveys`: a survey is shown too. */
  show(shown: boolean, surveys = false): void {
    this.shown = shown;
    this.surveys = surveys;
    if (!shown) this.hand.set(false);
    if (shown) {
      this.trace.show();
      this.places.open();
    }
    this.wantPictures();
    this.panel.refresh();
    this.stage.redraw();
  }

  private wantPictures(): void { if (this.hello?.robot) this.socket.send({ type: 'camera', on: this.shown }); }

  get mayDrive(): boolean { return this.hello?.role === 'drive' && this.hello.robot; }
  get mayEdit(): boolean { return this.hello !== null && this.hello.role !== 'view'; }
  /** Is this marker among those that the newest pose was found by, just now? */
  readsNow(id: number): boolean {
    const { state } = this;
    return state !== null && !this.isStale && state.seen_s !== null && state.time_s - state.seen_s < 0.5 && state.markers.includes(id);
  }
  get canDrive(): boolean { return this.mayDrive && this.connected; }
  get atWheel(): boolean { return this.connected && this.state !== null && this.state.driver === this.hello?.client; }
  get isStale(): boolean { return !this.connected || performance.now() - this.heardAt > staleAfterMs; }
  get silentS(): number { return (performance.now() - this.heardAt) / 1000; }

  // -- messages from the robot ------------------------------------------------------------------------------

  onHello(hello: Hello): void {
    const before = this.hello;
    this.hello = hello;
    this.connected = true;
    if (before !== null && before.session !== hello.session) this.reset();
    this.control.lose();
    if (hello.robot) this.control.name = this.control.name;
    this.wantPictures();
    document.body.toggleAttribute('data-robot', hello.robot);
    if (hello.survey) document.body.dataset['survey'] = '';
    if (before === null) this.heardAt = performance.now();
    else for (const what of ['markers', 'places'] as const) this.onSaved(what);  // perhaps, meanwhile
    if (before === null && hello.robot) this.onRobot();
    this.goalsChanged();
  }

  /** The robot's program was started anew: nothing that was shown of it holds any more, but for the user's own goals. */
  private reset(): void {
    [this.state, this.preview, this.seen, this.path, this.sent] = [null, null, null, [], ''];
    this.trace.reset();
    this.replan = true;
    this.say('The robot\'s program was started anew');
  }

  onState(state: State): void {
    this.heardAt = performance.now();
    this.state = state;
    document.body.toggleAttribute('data-scanner', state.field !== null);
    this.trace.add(state, this.shown);
    this.control.watch(state, this.hand.on);
    if (state.driver !== this.hello?.client || !this.connected) byId('asked').hidden = true;
    if (this.replan && state.pose) {
      this.replan = false;
      this.goalsChanged();
    }
    this.panel.refresh(this.shown);
    if (this.shown) this.stage.redrawOverlay();
  }

  onSeen(seen: Seen): void {
    if (this.seen === null) this.stage.layers.showLegend();
    [this.seen, this.seenAt] = [seen, performance.now()];
  }

  onAsked(client: number, name: string): void { this.control.showRequest(client, name); }
  onControl(): void { this.control.receive(); }

  onSaved(what: 'markers' | 'places'): void {
    if (what === 'places') {
      this.places.refresh();
      this.goalsChanged();
    }
    this.onSaving(what);
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
    if (what !== 'ask' && what !== 'stop' && what !== 'camera') this.control.lose();
    if (what === 'place') this.sent = '';
    if (what !== 'hold') this.say(`Not done (${what}): ${why}`, true);
  }

  onSurvey(survey: Survey): void { this.survey.set(survey); }

  onPicture(picture: Picture): void { if (this.shown) this.camera.show(picture); }

  onGone(): void {
    this.connected = false;
    this.control.lose();
    [this.preview, this.seen] = [null, null];
    byId('asked').hidden = true;
    this.panel.refresh();
    this.showSilence();
    this.stage.redrawOverlay();
  }

  // -- the user's orders ------------------------------------------------------------------------------------

  /** Any client may stop. Without a connection nothing can be sent, and a driver's lease runs out by itself. */
  stop(): void {
    this.say(this.socket.send({ type: 'stop' }) ? 'Stop' : 'No connection: use the button on the robot', true);
  }

  /** Does the site have lanes, and does the user want to drive along them? */
  get alongRoutes(): boolean { return this.hasLanes && this.wantsLanes; }

  /** As saved: what is only drawn, the robot does not know. */
  lanesAre(there: boolean): void {
    if (there === this.hasLanes) return;
    this.hasLanes = there;
    this.goalsChanged();
  }

  useLanes(wanted: boolean): void {
    this.wantsLanes = wanted;
    this.goalsChanged();
  }

  drive(): void {
    if (this.goals.list.length === 0) return;
    this.sent = JSON.stringify(this.goals.list);
    this.control.order({ type: 'go', ...this.wanted(), routes: this.alongRoutes });
  }

  /** A mission by its name, so that the robot also waits and acts at its stops. */
  private wanted(): Record<string, unknown> {
    return this.goals.mission === '' ? { goals: this.goals.list.map(goalJson) } : { mission: this.goals.mission };
  }

  /** Has the user set goals for after the present drive? */
  get hasNext(): boolean { return this.state?.moving === true && this.goals.list.length > 0 && JSON.stringify(this.goals.list) !== this.sent; }

  /** The goals come behind those of the present drive. */
  driveNext(): void {
    this.control.order({ type: 'go', ...this.wanted(), routes: this.alongRoutes, more: true });
    this.goals.set([]);
  }

  charge(): void { this.control.order({ type: 'charge' }); }

  /** Goals set meanwhile are the user's next ones, and are planned from where the robot is now. */
  private driveOver(): void {
    if (JSON.stringify(this.goals.list) === this.sent) this.goals.set([]);
    else this.goalsChanged();
    this.sent = '';
  }

  ask(): void {
    this.control.once({ type: 'ask' });
    this.say('Asked for the wheel');
  }

  /** Sets the robot's pose to the first goal's position and heading. */
  placeRobot(): void {
    const goal = this.goals.list[0];
    if (goal?.yawDeg == null) return this.say('Set a goal on the map and drag its arrow to the robot\'s heading first', true);
    this.control.once({ type: 'place', pose: goalJson(goal) });
    this.goals.set([]);
  }

  private beat(): void {
    this.control.beat();
    this.showSilence();
    if (this.isStale) {
      this.panel.refresh(this.shown);
      this.stage.redrawOverlay();
    }
  }

  private showSilence(): void {
    byId('stale').hidden = !(this.hello?.robot && this.isStale);
    byId('stale').textContent = `${this.connected ? 'No data from the robot' : 'No connection to the robot, and no data'} for ${this.silentS.toFixed(0)} s`;
  }

  private goalsChanged(): void {
    this.preview = null;
    if (this.goals.list.length > 0 && this.canDrive) this.socket.send({ type: 'preview', goals: this.goals.list.map(goalJson), routes: this.alongRoutes });
    this.panel.refresh();
    this.stage.redrawOverlay();
  }

  private makeControls(): void {
    byId('live-controls').append(
      button('Stop', 'Stop the robot (space bar)', () => this.stop(), { id: 'live-stop' }),
      button('Pause', 'Stop and keep the goal', () => this.control.order({ type: 'pause' }), { id: 'live-pause' }),
      button('Resume', 'Continue to the goal', () => this.control.order({ type: 'resume' }), { id: 'live-resume' }),
      button('Clear fault', 'Clear the latched fault of the base, if its cause is gone', () => this.control.once({ type: 'clear_fault' }), { id: 'live-clear' }),
      el('span', { id: 'live-phase' }),
    );
    stopAlways(() => this.stop());
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
    else drawWay(c, view, this.trace.track, colours.track, 1.5);
    if (this.seen && performance.now() - this.seenAt < seenForMs) drawSeen(c, view, this.seen);
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

  /** The state in words, never older than it says. */
  words(): string {
    const state = this.state;
    if (!this.hello) return 'No connection yet';
    if (!this.hello.robot) return 'No robot is connected: start the console with lodestar replay --serve, or lodestar run --serve';
    if (!this.connected) return 'No connection to the robot';
    if (!state) return 'Waiting for the robot';
    if (this.isStale) return `Not heard of for ${this.silentS.toFixed(0)} s`;
    const goal = state.moving && state.goals.length > 1 ? `, goal ${state.current + 1} of ${state.goals.length}` : '';
    const field = state.moving ? fieldWords(state.field) : '';
    const must = field === '' && state.stop !== null ? `must not move: ${state.stop}` : field;
    const phase = !state.moving && state.charging !== '' ? state.charging : state.phase;
    return `${phase}${goal}${must === '' ? '' : `; ${must}`}`;
  }
}
