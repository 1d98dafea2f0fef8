// Starts the console's page: reads the documents, and ties map, panel, tools and keys together.
import { Actions } from './actions.js';
import * as api from './api.js';
import { alignByPairs } from './alignment.js';
import { isTyping, keyOf } from './commands.js';
import type { Command } from './commands.js';
import { Coverage, Floor } from './coverage.js';
import { askAboutConflict, exportTo, importFrom, pickFile, printChosen, showHelp } from './dialogs.js';
import { button, byId } from './dom.js';
import { Editor } from './editor.js';
import type { Registry } from './editor.js';
import { centerOf } from './geometry.js';
import type { Marker, Point } from './geometry.js';
import { merged, openHistory } from './history.js';
import { Layers } from './layers.js';
import { markerCommands } from './marker_commands.js';
import { Measure } from './measure.js';
import { Panel } from './panel.js';
import { Live } from './live.js';
import { Pointer } from './pointer.js';
import { Replay } from './replay.js';
import { blindStretches, paintRoutes } from './route.js';
import { Stage } from './stage.js';
import { View } from './view.js';

const checkAfterMs = 350;
const mostBlindM = 1;  // that the wheels may carry the robot along the route

function say(words: string, bad = false): void {
  byId('state').textContent = words;
  byId('state').classList.toggle('bad', bad);
}

/** Runs something that may fail, and says how. */
function attempt(action: () => Promise<string | void>): void {
  action().then((words) => { if (words) say(words); }, (error: unknown) => {
    say(error instanceof Error ? error.message : String(error), true);
  });
}

/** A link with #t=TOKEN becomes a session; the token leaves the address bar. */
async function useTokenOfAddress(): Promise<void> {
  const token = new URLSearchParams(location.hash.slice(1)).get('t');
  if (!token) return;
  history.replaceState(null, '', location.pathname);
  await api.openSession(token);
}

type Mode = 'edit' | 'live' | 'replay';

class Console {
  readonly editor = new Editor();
  readonly view = new View();
  readonly coverage: Coverage;
  readonly stage: Stage;
  readonly pointer: Pointer;
  readonly replay: Replay;
  readonly layers = new Layers();
  readonly measure: Measure;
  readonly actions: Actions;
  readonly routes: Point[][];
  readonly live: Live;
  mode: Mode = 'edit';
  private readonly seen = new Set<Mode>();
  private readonly panel: Panel;
  private readonly commands: Command[];
  private base: Registry;
  private etag: string;
  private checkTimer = 0;
  private coverageTimer = 0;

  constructor(readonly site: api.Site, readonly floor: Floor, tagged: api.Tagged) {
    this.coverage = new Coverage(floor, site);
    this.stage = new Stage(byId('stage'), this.view, this.editor, floor, this.coverage, this.layers);
    this.pointer = new Pointer(this.stage);
    this.replay = new Replay(this.stage, site.robot.radius_m, (error) => attempt(() => Promise.reject(error)));
    this.live = new Live(this.stage, site, say);
    this.live.onRobot = () => this.enter('live');
    this.panel = new Panel(this.editor, { goTo: (points) => this.goTo(points), suggest: () => this.actions.suggest(),
      fill: () => attempt(() => this.actions.fill()), pickId: () => attempt(() => this.actions.pickId()) });
    this.actions = new Actions(this.editor, this.coverage, say);
    this.measure = new Measure(this.stage, this.pointer, say);
    this.routes = site.routes.map((route) => route.map(([x, y]) => ({ x, y })));
    this.stage.painters.push((c) => { if (this.layers.shown.route) paintRoutes(c, this.stage, this.routes); });
    this.layers.onChange = () => this.layersChanged();
    [this.base, this.etag] = [tagged.registry, tagged.etag];
    this.commands = this.makeCommands();
    this.pointer.onHover = (at) => { byId('where').textContent = at ? `${at.x.toFixed(3)}, ${at.y.toFixed(3)} m` : ''; };
    this.pointer.onDrag = () => this.dragged();
    this.editor.onChange = () => this.changed();
    byId('title').textContent = `Lodestar: ${site.name}`;
    this.layers.showLegend();
    this.makeTools();
    this.makeModes();
    this.listenToKeys();
    addEventListener('beforeunload', (e) => { if (this.editor.dirty) e.preventDefault(); });
    this.editor.load(tagged.registry);
    this.fit();
  }

  // -- what follows a change --------------------------------------------------------------------------------

  private changed(): void {
    this.coverage.update(this.editor.shown());
    this.stage.paintRaster();
    this.stage.redraw();
    this.panel.show();
    this.refreshTools();
    document.title = `${this.editor.dirty ? '• ' : ''}${this.site.name} - Lodestar`;
    clearTimeout(this.coverageTimer);
    this.coverageTimer = setTimeout(() => this.panel.showCoverage(this.coverage, blindStretches(this.routes, this.coverage, mostBlindM)), 60);
    clearTimeout(this.checkTimer);
    this.checkTimer = setTimeout(() => this.check(), checkAfterMs);
  }

  private dragged(): void {
    this.coverage.update(this.editor.shown());
    this.stage.paintRaster();
    this.stage.redrawDragged();
    this.panel.showSelection();
  }

  private check(): void {
    attempt(async () => { this.panel.showIssues(await api.checkMarkers(this.editor.registry())); });
    if (this.layers.floor === 'deviation') attempt(() => this.showDeviations());
  }

  /** What a single fix would give at each place, by the server, as `lodestar map visibility` has it. */
  private async showDeviations(): Promise<void> {
    this.stage.deviations = this.floor.spread(await api.getDeviations(this.editor.registry()));
    this.stage.paintRaster();
    this.stage.redraw();
  }

  private layersChanged(): void {
    this.layers.showLegend();
    this.stage.paintRaster();
    this.stage.redraw();
    if (this.layers.floor === 'deviation') attempt(() => this.showDeviations());
  }

  // -- documents --------------------------------------------------------------------------------------------

  save(): void {
    attempt(async () => {
      const mine = this.editor.registry();
      try {
        this.take(await api.putMarkers(mine, this.etag));
        this.editor.markSaved();
        return `Saved ${mine.markers.length} markers`;
      } catch (error) {
        if (!(error instanceof api.Refusal) || error.status !== 412) throw error;
        return await this.settle(mine);
      }
    });
  }

  private async settle(mine: Registry): Promise<string> {
    const theirs = await api.getMarkers();
    const resolution = await askAboutConflict(this.base, mine, theirs.registry);
    if (resolution === '') return 'Not saved: somebody else saved first';
    const base = this.base;
    this.take(theirs);
    if (resolution === 'theirs') {
      this.editor.load(theirs.registry);
      return 'Took the state that somebody else saved';
    }
    if (resolution === 'merge') this.editor.replaceAll(merged(base, mine, theirs.registry));
    this.take(await api.putMarkers(this.editor.registry(), this.etag));
    this.editor.markSaved();
    return resolution === 'merge' ? 'Merged and saved' : 'Saved over the other state; it is in the history';
  }

  private take(tagged: api.Tagged): void { [this.base, this.etag] = [tagged.registry, tagged.etag]; }

  reload(): void {
    attempt(async () => {
      const tagged = await api.getMarkers();
      this.take(tagged);
      this.editor.load(tagged.registry);
      return 'Read again from the site';
    });
  }


  // -- view -------------------------------------------------------------------------------------------------

  fit(): void {
    this.view.fit(this.floor.corners());
    this.stage.redraw();
  }

  private turnView(deg: number): void {
    this.view.turnBy(deg);
    this.stage.redraw();
  }

  goTo(points: Point[]): void {
    if (points.length === 0) return;
    this.view.fit(points, 3);
    this.stage.redraw();
  }

  private theme(): void {
    const root = document.documentElement;
    root.dataset['theme'] = root.dataset['theme'] === 'dark' ? 'light' : 'dark';
    this.stage.paintRaster();
    this.stage.redraw();
  }

  private toggleCoverage(): void {
    this.layers.paintFloor(this.layers.floor === 'coverage' ? 'plain' : 'coverage');
  }

  // -- tools and keys ---------------------------------------------------------------------------------------

  private makeCommands(): Command[] {
    const { editor } = this;
    return [
      { name: 'undo', button: 'Undo', key: 'Ctrl+Z', title: 'undo', run: () => editor.undo(), possible: () => editor.canUndo },
      { name: 'redo', button: 'Redo', key: 'Ctrl+Shift+Z', title: 'redo', run: () => editor.redo(), possible: () => editor.canRedo },
      { name: 'redo2', key: 'Ctrl+Y', title: 'redo', run: () => editor.redo() },
      ...markerCommands(this, attempt),
      { name: 'coverage', everywhere: true, button: 'Coverage', key: 'C', title: 'show what the markers cover', run: () => this.toggleCoverage(), pressed: () => this.layers.floor === 'coverage' },
      { name: 'measure', everywhere: true, button: 'Measure', key: 'T', title: 'tape measure between two places', run: () => this.measure.toggle(), pressed: () => this.measure.on },
      { name: 'deviation', everywhere: true, key: 'V', title: 'show how sure of its pose the robot would be', run: () => this.layers.paintFloor(this.layers.floor === 'deviation' ? 'coverage' : 'deviation') },
      { name: 'turn-view', everywhere: true, key: '.', title: 'turn the view by 15° clockwise', run: () => this.turnView(-15) },
      { name: 'turn-view-back', everywhere: true, key: ',', title: 'turn the view by 15° counter-clockwise', run: () => this.turnView(15) },
      { name: 'north', everywhere: true, key: '0', title: 'the map upright again', run: () => this.turnView(-this.view.turnDeg) },
      { name: 'fit', everywhere: true, button: 'Fit', key: 'F', title: 'show the whole map', run: () => this.fit() },
      { name: 'align', button: 'Align', title: 'align all markers to the map by pairs of points', run: () => alignByPairs(this.editor, this.pointer, this.stage, say) },
      { name: 'import', button: 'Import', title: 'read markers of another format', run: () => pickFile((file) => attempt(() => importFrom(editor, file))) },
      { name: 'export', button: 'Export', title: 'write markers in another format', run: () => attempt(() => exportTo(editor, this.site.formats)) },
      { name: 'print', button: 'Print', key: 'Ctrl+P', title: 'sheets to make the chosen markers from', run: () => attempt(() => printChosen(editor)) },
      { name: 'history', button: 'History', title: 'bring back an earlier state', run: () => attempt(() => openHistory(editor)) },
      { name: 'reload', button: 'Reload', title: 'read the markers again; unsaved changes are lost', run: () => this.reload() },
      { name: 'save', button: 'Save', key: 'Ctrl+S', title: 'save', run: () => this.save(), possible: () => editor.dirty },
      { name: 'theme', everywhere: true, button: 'Light/dark', title: 'light or dark', run: () => this.theme() },
      { name: 'help', everywhere: true, button: 'Help', key: '?', title: 'this sheet', run: () => attempt(() => showHelp(this.commands)) },
    ];
  }

  private makeTools(): void {
    for (const command of this.commands.filter((c) => c.button)) {
      const words = command.title + (command.key ? ` (${command.key})` : '');
      byId('tools').append(button(command.button!, words, () => this.run(command),
        { id: `tool-${command.name}`, ...(command.everywhere ? { class: 'everywhere' } : {}) }));
    }
  }

  private makeModes(): void {
    const titles: [Mode, string, string][] = [['edit', 'Markers', 'edit the markers'], ['live', 'Live', 'watch the robot, and send it'],
      ['replay', 'Replay', 'open a run and scrub through it']];
    byId('modes').append(...titles.map(([mode, text, title]) => button(text, title, () => this.enter(mode), { id: `tool-${mode}` })));
    this.replay.onClose = () => this.enter(this.live.hello?.robot ? 'live' : 'edit');
    this.enter('edit');
  }

  /** What the page is for now: the panel beside the map, and what a click on it means. */
  enter(mode: Mode): void {
    const before = this.mode;
    this.mode = mode;
    document.body.dataset['mode'] = mode;
    for (const other of ['edit', 'live', 'replay']) byId(`tool-${other}`).setAttribute('aria-pressed', String(other === mode));
    this.pointer.cancel();
    this.pointer.guest = mode === 'live' ? this.live : null;
    this.live.show(mode === 'live');
    if (before !== mode) this.layers.paintFloor(mode === 'edit' ? 'coverage' : 'plain');
    if (mode !== 'replay') this.fitAtFirst(mode);
    this.refreshTools();
    this.stage.paintRaster();
    this.stage.redraw();
    if (mode === 'replay') attempt(() => this.openReplay());
    else if (before === 'replay') this.replay.leave();
  }

  private async openReplay(): Promise<string> {
    const first = !this.seen.has('replay');
    const words = await this.replay.open();
    if (first && this.mode === 'replay') this.fitAtFirst('replay');
    return words;
  }

  /** Each mode has room of another size for the map. */
  private fitAtFirst(mode: Mode): void {
    if (this.seen.has(mode)) return;
    this.seen.add(mode);
    this.stage.resize();
    this.fit();
  }

  private refreshTools(): void {
    for (const command of this.commands.filter((c) => c.button)) {
      const tool = byId(`tool-${command.name}`) as HTMLButtonElement;
      tool.disabled = command.possible?.() === false;
      if (command.pressed) tool.setAttribute('aria-pressed', String(command.pressed()));
    }
    byId('tool-save').classList.toggle('main', this.editor.dirty);
  }

  private run(command: Command): void {
    if (command.possible?.() === false) return;
    command.run();
    this.refreshTools();
  }

  private listenToKeys(): void {
    addEventListener('keydown', (e) => {
      if ((byId('dialog') as HTMLDialogElement).open) return;
      const key = keyOf(e);
      if (isTyping(e.target) && !['Ctrl+S', 'Ctrl+P'].includes(key)) return;
      const command = this.commands.find((c) => c.key === key);
      if (!command || (this.mode !== 'edit' && !command.everywhere)) return;
      e.preventDefault();
      this.run(command);
    });
  }
}

/** For tests, and for the browser's own console. */
export interface Handle {
  console: Console;
  screenOf(id: number): Point;
  marker(id: number): Marker | undefined;
}

async function start(): Promise<void> {
  if (matchMedia('(prefers-color-scheme: dark)').matches) document.documentElement.dataset['theme'] = 'dark';
  await useTokenOfAddress();
  const [site, info, cells, tagged] = await Promise.all([api.getSite(), api.getMap(), api.getCells(), api.getMarkers()]);
  const made = new Console(site, new Floor(info, cells, site.robot.radius_m, await api.getHeights(info)), tagged);
  const marker = (id: number) => [...made.editor.shown()].find((m) => m.id === id);
  const handle: Handle = { console: made, marker, screenOf: (id) => made.view.toScreen(centerOf(marker(id)!)) };
  (window as unknown as { lodestar: Handle }).lodestar = handle;
  say('Ready');
}

start().catch((error: unknown) => say(error instanceof api.Refusal && error.status === 401
  ? 'This console needs its token: open the address with #t=TOKEN' : String(error), true));
