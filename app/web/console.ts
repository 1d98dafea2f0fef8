// The page as a whole: connects map, panel, tools and keys, and updates them after a change.
import { Actions } from './actions.js';
import * as api from './api.js';
import { isTyping, keyOf } from './commands.js';
import type { Command } from './commands.js';
import { CountedCoverage } from './counted.js';
import { Documents } from './documents.js';
import { offerDraft } from './dialogs.js';
import { Draft } from './draft.js';
import { byId } from './dom.js';
import { Editor } from './editor.js';
import type { Registry } from './editor.js';
import type { Floor } from './floor.js';
import type { Point } from './geometry.js';
import { Hang } from './hang.js';
import { Latest } from './latest.js';
import { Layers } from './layers.js';
import { Live } from './live.js';
import { MapMode } from './map_mode.js';
import { Measure } from './measure.js';
import { Modes } from './modes.js';
import { pageCommands } from './page_commands.js';
import type { Page } from './page_commands.js';
import { Panel } from './panel.js';
import { Pointer } from './pointer.js';
import { Replay } from './replay.js';
import { paintRoutes } from './route.js';
import { Stage } from './stage.js';
import { SitePlaces } from './site_places.js';
import { View } from './view.js';
import { Toolbar } from './toolbar.js';
import { attempt, complain, say } from './words.js';

const followEveryMs = 200;

export class Console implements Page {
  readonly editor = new Editor();
  readonly view = new View();
  readonly layers = new Layers();
  readonly coverage: CountedCoverage;
  readonly stage: Stage;
  readonly pointer: Pointer;
  readonly replay: Replay;
  readonly live: Live;
  readonly measure: Measure;
  readonly actions: Actions;
  readonly documents: Documents;
  readonly modes: Modes;
  readonly hang: Hang;
  readonly map: MapMode;
  readonly places: SitePlaces;
  private readonly draft: Draft<Registry>;
  private counting = 0;  // changes whose coverage is being counted
  readonly commands: Command[];
  readonly routes: Point[][];
  private readonly panel: Panel;
  private readonly toolbar: Toolbar;
  private readonly checking = new Latest(followEveryMs, () => this.check(), complain);
  private readonly deviations = new Latest(followEveryMs, () => this.showDeviations(), complain);

  constructor(readonly site: api.Site, readonly floor: Floor, tagged: api.Tagged) {
    this.coverage = new CountedCoverage(floor, site.coverage, complain);
    this.stage = new Stage(byId('stage'), this.view, this.editor, floor, this.coverage, this.layers);
    this.pointer = new Pointer(this.stage);
    this.replay = new Replay(this.stage, site, { goTo: (points) => this.goTo(points), suggestNear: (spot) => this.suggestNear(spot) }, complain);
    this.live = new Live(this.stage, site, say);
    this.panel = new Panel(this.editor, { goTo: (points) => this.goTo(points), suggest: () => attempt(() => this.actions.suggest()),
      fill: () => attempt(() => this.actions.fill()), pickId: () => attempt(() => this.actions.pickId()),
      letStand: (issue, reason) => attempt(async () => {
        await api.letStand(issue, reason);
        this.checking.want();
      }) });
    this.actions = new Actions(this.editor, this.coverage, say);
    this.measure = new Measure(this.stage, this.pointer, say);
    this.documents = new Documents(this.editor, tagged, () => this.live.hello?.robot === true);
    this.draft = new Draft({ key: `lodestar-draft: ${site.name}`, what: 'changes', dirty: () => this.editor.dirty, document: () => this.editor.registry(),
      ask: offerDraft, take: (registry) => this.editor.replaceAll(registry) }, complain);
    this.routes = site.routes.map((route) => route.map(([x, y]) => ({ x, y })));
    this.stage.painters.push((c) => { if (this.layers.shown.route && this.modes.now === 'edit') paintRoutes(c, this.stage, this.routes); });
    this.places = new SitePlaces({ stage: this.stage, snap: this.pointer.snap, goTo: (points) => this.goTo(points), refresh: () => this.refreshTools(),
      hasRobot: () => this.live.hello?.robot === true, lanesAre: (there) => this.live.lanesAre(there), list: this.live.places, isOn: () => this.modes?.now === 'places',
      shows: () => this.layers.shown.zones && this.modes?.now !== 'replay' }, site.name, site.actions);
    this.commands = [...this.places.commands(), ...pageCommands(this)];
    this.toolbar = new Toolbar(this.commands, (command) => this.run(command));
    this.hang = new Hang(this.stage, this.live);
    this.map = new MapMode(floor.info, this.live);
    this.modes = new Modes(this);
    this.listen();
    byId('title').textContent = `Lodestar: ${site.name}`;
    this.editor.load(tagged.registry);
    this.fit();
    attempt(() => this.offerDrafts());
  }

  /** One question after the other. */
  private async offerDrafts(): Promise<string> {
    const markers = await this.draft.offer();
    return await this.places.open() || markers;
  }

  // -- after a change ---------------------------------------------------------------------------------------

  private changed(): void {
    this.coverage.update(this.editor.shown());
    attempt(() => this.tellCoverage());
    this.stage.redraw();
    this.panel.show();
    this.refreshTools();
    this.draft.changed();
    document.title = `${this.editor.dirty ? '• ' : ''}${this.site.name} - Lodestar`;
    this.judge();
  }

  /** Says no share that stands for a moment, while many markers are counted. */
  private async tellCoverage(): Promise<void> {
    ++this.counting;
    await this.coverage.settled().finally(() => { --this.counting; });
    if (this.counting === 0) this.panel.showCoverage(this.coverage);
  }

  private dragged(): void {
    this.coverage.update(this.editor.shown());
    this.stage.redrawDragged();
    this.panel.showSelection();
    this.judge();
  }

  /** Has the server check the draft, shortly after a change and also while dragging. */
  private judge(): void {
    this.checking.want();
    if (this.layers.floor === 'deviation') this.deviations.want();
  }

  private async check(): Promise<void> {
    try {
      this.panel.showIssues(await api.checkMarkers(this.editor.draft()));
    } catch (error) {
      if (!(error instanceof api.Refusal) || error.status !== 403) throw error;
      this.panel.showUnchecked('Not checked: that needs the token to edit.');
    }
  }

  /** Expected deviation of a single fix at each position, by the server, as `lodestar map visibility` computes it. */
  private async showDeviations(): Promise<void> {
    this.stage.floorPaint.deviations = this.floor.spread(await api.getDeviations(this.editor.draft()));
    this.stage.paintRaster();
    this.stage.redrawDragged();
  }

  private layersChanged(): void {
    this.layers.showLegend();
    this.stage.paintRaster();
    this.stage.redraw();
    if (this.layers.floor === 'deviation') this.deviations.want();
  }

  // -- view -------------------------------------------------------------------------------------------------

  fit(): void {
    this.view.fit(this.floor.corners());
    this.stage.redraw();
  }

  /** About the middle of the map. */
  zoom(factor: number): void {
    this.view.zoomAt({ x: this.view.width / 2, y: this.view.height / 2 }, factor);
    this.stage.redraw();
  }

  turnView(deg: number): void {
    this.view.turnBy(deg);
    this.stage.redraw();
  }

  goTo(points: Point[]): void {
    if (points.length === 0) return;
    this.view.fit(points, 3);
    this.stage.redraw();
  }

  /** In the markers' mode, where it can be moved or undone. */
  private suggestNear(spot: Point): void {
    this.modes.enter('edit');
    this.goTo([spot]);
    attempt(() => this.actions.suggestNear(spot));
  }

  changeTheme(): void {
    const root = document.documentElement;
    root.dataset['theme'] = root.dataset['theme'] === 'dark' ? 'light' : 'dark';
    this.layersChanged();
  }

  // -- tools and keys ---------------------------------------------------------------------------------------

  refreshTools(): void {
    this.toolbar.refresh((command) => this.isPossibleNow(command));
    byId('tool-save').classList.toggle('main', this.editor.dirty);
    byId('tool-places-save').classList.toggle('main', this.places.editor.dirty);
  }

  private run(command: Command): void {
    if (command.possible?.() === false) return;
    say('');  // what was said of the command before
    command.run();
    this.refreshTools();
  }

  private isPossibleNow(command: Command): boolean {
    const mode = document.body.dataset['mode'];
    if (command.placing) return mode === 'places';
    if (mode === 'map' || mode === 'new') return command.mapless === true;
    return mode === 'edit' || command.everywhere === true || (mode === 'survey' && command.surveying === true);
  }

  private listen(): void {
    this.layers.onChange = () => this.layersChanged();
    this.layers.showLegend();
    this.coverage.onCounted = (boxes) => { this.stage.paintCounted(boxes); if (this.counting === 0) this.panel.showCoverage(this.coverage); };
    this.pointer.onHover = (at) => { this.places.hoverAt(at); byId('where').textContent = at ? `${at.x.toFixed(3)}, ${at.y.toFixed(3)} m` : ''; };
    this.pointer.onDrag = () => this.dragged();
    this.editor.onChange = () => this.changed();
    this.live.onSaving = (what) => attempt(() => what === 'places' ? this.places.heardOfSaving() : this.documents.heardOfSaving());
    addEventListener('beforeunload', (e) => { if (this.editor.dirty || this.places.editor.dirty) e.preventDefault(); });
    addEventListener('keydown', (e) => {
      if ((byId('dialog') as HTMLDialogElement).open) return;
      const key = keyOf(e);
      if (isTyping(e.target) && !['Ctrl+S', 'Ctrl+P'].includes(key)) return;
      const command = this.commands.find((c) => c.key === key && this.isPossibleNow(c));
      if (!command) return;
      if (command.onMap && document.activeElement !== byId('stage')) return;
      e.preventDefault();
      this.run(command);
    });
  }
}

