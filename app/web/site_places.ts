// Zones, lanes and places of the site as a whole: editor, tools, panel, drafts, saving and what others save.
import * as api from './api.js';
import type { Command } from './commands.js';
import { ask, byId } from './dom.js';
import { Draft } from './draft.js';
import { isSpot, isZone } from './places_doc.js';
import { PlacesEditor } from './places_doc.js';
import type { Kind, PlacesDocument } from './places_doc.js';
import { changeList } from './dialogs.js';
import { askAboutPlaces, offerPlacesDraft } from './places_dialogs.js';
import { openPlacesHistory } from './places_history.js';
import { mergedPlaces, placesDifferences } from './places_merge.js';
import { paintDrawing, paintPlaces } from './places_paint.js';
import { MissionsPanel } from './missions_panel.js';
import { PlacesPanel } from './places_panel.js';
import { PlacesTools } from './places_tools.js';
import { Latest } from './latest.js';
import type { Point } from './geometry.js';
import type { Stage } from './stage.js';
import type { Snap } from './pointer.js';
import { attempt, complain, say } from './words.js';

const followEveryMs = 400;

export interface PlacesHost {
  readonly stage: Stage;
  readonly snap: Snap;
  goTo(points: Point[]): void;
  /** The tools' buttons follow. */
  refresh(): void;
  hasRobot(): boolean;
  /** Has the site lanes, as saved? */
  lanesAre(there: boolean): void;
  /** The list of the live view, which saves places too. */
  readonly list: { saving: Promise<unknown>; savedAs: string };
  /** Is this mode on? */
  isOn(): boolean;
  /** Are zones shown in the present mode? */
  shows(): boolean;
}

export class SitePlaces {
  readonly editor = new PlacesEditor();
  readonly tools: PlacesTools;
  private readonly panel: PlacesPanel;
  private readonly missions: MissionsPanel;
  private base: PlacesDocument | null = null;
  private etag = '';
  private marks: Point[] = [];
  private busy: Promise<unknown> = Promise.resolve();
  private readonly draft: Draft<PlacesDocument>;
  private readonly checking = new Latest(followEveryMs, () => this.check(), complain);

  constructor(private readonly host: PlacesHost, site: string, actions: string[]) {
    const { stage } = host;
    this.draft = new Draft({ key: `lodestar-places-draft: ${site}`, what: 'places', dirty: () => this.editor.dirty, document: () => this.editor.document(),
      ask: offerPlacesDraft, take: (places) => this.editor.replaceAll(places) }, complain);
    this.tools = new PlacesTools(this.editor, stage.view, host.snap, () => this.redraw(), say);
    this.panel = new PlacesPanel(this.editor, { add: (kind) => this.addByNumbers(kind), goTo: (points) => host.goTo(points), remove: () => this.remove() });
    this.missions = new MissionsPanel(this.editor, actions);
    this.editor.onChange = () => this.changed();
    stage.painters.push((c) => {
      if (!host.shows()) return;
      paintPlaces(c, stage.view, this.editor, host.isOn(), { positions: this.marks });
      if (host.isOn()) paintDrawing(c, stage.view, this.tools.drawing, this.tools.hover);
    });
  }

  /** Reads the site's, and offers what an earlier window left. */
  async open(): Promise<string> {
    const tagged = await api.getPlaces();
    this.take(tagged);
    this.editor.load(tagged.places);
    return await this.draft.offer();
  }

  private changed(): void {
    this.redraw();
    this.panel.show();
    this.missions.show();
    this.draft.changed();
    if (this.host.isOn()) this.judge();
  }

  private redraw(): void {
    this.host.stage.redrawOverlay();
    this.host.refresh();
  }

  hoverAt(at: Point | null): void {
    if (this.tools.drawing.length === 0) return;
    this.tools.hover = at;
    this.host.stage.redrawOverlay();
  }

  judge(): void { this.checking.want(); }

  /** By the server, on its worker, as `lodestar places check` does. */
  private async check(): Promise<void> {
    try {
      const issues = await api.checkPlaces(this.editor.document());
      this.marks = issues.filter((i) => i.kind !== 'zone-off-map').flatMap((i) => i.positions_m.map(([x, y]) => ({ x, y })));
      this.panel.showIssues(issues);
    } catch (error) {
      if (!(error instanceof api.Refusal)) throw error;
      this.marks = [];
      if (error.status === 403) this.panel.showChecking('Not checked: that needs the token to edit.');
      else if (error.status === 503) this.judge();
      else this.showRefusal(error);
    }
    this.host.stage.redrawOverlay();
  }

  private showRefusal(error: api.Refusal): void {
    this.panel.showRefusal(error.message, error.item ? this.editor.itemAt(error.item.list, error.item.index) : undefined);
  }

  // -- commands -----------------------------------------------------------------------------------------------

  commands(): Command[] {
    const { editor, tools } = this;
    const tool = (kind: Kind, button: string, key: string, title: string): Command =>
      ({ name: `draw-${kind}`, placing: true, button, key, title, run: () => tools.take(kind), pressed: () => tools.tool === kind });
    const any = () => editor.selected !== null;
    const nudges: Command[] = ([['', 0.01, '1 cm'], ['Shift+', 0.1, '10 cm'], ['Alt+', 0.001, '1 mm']] as const).flatMap(([mod, by, words]) =>
      ([['ArrowLeft', -1, 0], ['ArrowRight', 1, 0], ['ArrowUp', 0, 1], ['ArrowDown', 0, -1]] as const).map(([key, x, y]): Command =>
        ({ name: `places-${mod}${key}`, placing: true, key: `${mod}${key}`, title: `Zones: move the selection or its chosen corner by ${words} (with the map in focus)`, onMap: true, run: () => tools.nudge(x * by, y * by), possible: any })));
    return [
      { name: 'places-undo', placing: true, button: 'Undo', key: 'Ctrl+Z', title: 'Zones: undo', run: () => editor.undo(), possible: () => editor.canUndo },
      { name: 'places-redo', placing: true, button: 'Redo', key: 'Ctrl+Shift+Z', title: 'Zones: redo', run: () => editor.redo(), possible: () => editor.canRedo },
      { name: 'places-redo2', placing: true, key: 'Ctrl+Y', title: 'Zones: redo', run: () => editor.redo() },
      tool('keep_out', 'Keep-out', 'O', 'Zones: draw an area that the robot must not enter'), tool('speed_zone', 'Speed zone', 'Z', 'Zones: draw an area where it drives slower'),
      tool('place', 'Place', 'P', 'Zones: a named place to drive to'), tool('node', 'Node', 'N', 'Zones: a point of the route graph'), tool('edge', 'Lane', 'L', 'Zones: a lane between two of them'),
      { name: 'places-close', placing: true, key: 'Enter', onMap: true, title: 'Zones: close the polygon being drawn', run: () => tools.close() },
      { name: 'places-back', placing: true, key: 'Backspace', onMap: true, title: 'Zones: take back the last corner', run: () => tools.takeBack() },
      { name: 'places-none', placing: true, key: 'Escape', title: 'Zones: end drawing; clear the selection', run: () => this.escape() },
      { name: 'places-delete', placing: true, button: 'Delete', key: 'Delete', title: 'Zones: delete the selection, or its chosen corner (with the map in focus)', run: () => this.removeOrCorner(), possible: any },
      { name: 'places-history', placing: true, button: 'History', title: 'Zones: restore an earlier version', run: () => attempt(() => openPlacesHistory(editor, this.host.stage.floor)) },
      { name: 'places-reload', placing: true, button: 'Reload', title: 'Zones: reload them from the site', run: () => attempt(() => this.reload()) },
      { name: 'places-save', placing: true, button: 'Save', key: 'Ctrl+S', title: 'Zones: save', run: () => attempt(() => this.save()), possible: () => editor.dirty },
      ...nudges,
    ];
  }

  private escape(): void {
    if (this.tools.tool === null) return this.editor.select(null);
    this.tools.take(null);
  }

  private remove(): void { if (this.editor.selected !== null) say(this.editor.remove(this.editor.selected)); }

  private removeOrCorner(): void {
    const item = this.editor.chosen;
    const { corner } = this.editor;
    if (item && isZone(item) && corner !== null && item.corners.length > 3 && document.activeElement === byId('stage')) this.panel.removeCorner(corner);
    else this.remove();
  }

  /** In the middle of the view, for those who draw by keyboard. */
  private addByNumbers(kind: Kind): void {
    const round = (value: number) => Math.round(value * 20) / 20;
    const middle = { x: round(this.host.stage.view.center.x), y: round(this.host.stage.view.center.y) };
    this.tools.take(null);
    if (kind === 'place' || kind === 'node') return this.tools.addSpot(kind, middle);
    if (kind !== 'edge') return this.tools.addZone(kind, ([[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]] as const).map(([x, y]) => ({ x: round(middle.x + x), y: round(middle.y + y) })));
    const { items } = this.editor.state;
    const spots = items.filter(isSpot);
    const isTaken = (from: number, to: number) => items.some((i) => i.kind === 'edge' && ((i.from === from && i.to === to) || (i.from === to && i.to === from)));
    const [from, to] = spots.flatMap((a) => spots.filter((b) => a.key < b.key && !isTaken(a.key, b.key)).map((b) => [a.key, b.key]))[0] ?? [];
    if (from === undefined || to === undefined) return say('A lane needs two places or nodes that none connects yet', true);
    this.editor.add({ key: this.editor.key(), kind: 'edge', from, to, oneWay: false, maxMps: null });
  }

  // -- documents ----------------------------------------------------------------------------------------------

  private take(tagged: api.TaggedPlaces): void {
    [this.base, this.etag] = [tagged.places, tagged.etag];
    this.host.lanesAre(tagged.places.edges.length > 0);
  }

  private async save(): Promise<string> {
    const saving = this.saveNow();
    this.busy = saving.catch(() => undefined);
    return await saving;
  }

  private async saveNow(): Promise<string> {
    try {
      this.take(await api.putPlaces(this.editor.document(), this.etag));
      this.nowSaved();
      return this.host.hasRobot() ? 'Saved; the robot obeys the zones from now on' : 'Saved';
    } catch (error) {
      if (error instanceof api.Refusal && error.status === 422) this.showRefusal(error);
      if (!(error instanceof api.Refusal) || error.status !== 412) throw error;
      return await this.settle();
    }
  }

  private async settle(): Promise<string> {
    const theirs = await api.getPlaces();
    const mine = this.editor.document();
    const resolution = await askAboutPlaces(this.base!, mine, theirs.places);
    if (resolution === '') return 'Not saved: another user saved first';
    const base = this.base!;
    this.take(theirs);
    if (resolution === 'theirs') {
      this.editor.replaceAll(theirs.places);
      this.nowSaved();
      return 'Loaded the version that the other user saved; undo brings yours back';
    }
    if (resolution === 'merge') this.editor.replaceAll(mergedPlaces(base, mine, theirs.places));
    this.take(await api.putPlaces(this.editor.document(), this.etag));
    this.nowSaved();
    return resolution === 'merge' ? 'Merged and saved' : 'Overwrote the other version; it is in the history';
  }

  private async reload(): Promise<string> {
    const tagged = await api.getPlaces();
    const lines = placesDifferences(tagged.places, this.editor.document());
    if (this.editor.dirty && await ask('Throw away your changes?', changeList(lines), [['', 'Keep editing'], ['go', 'Throw away and reload']]) !== 'go') return 'Kept your changes';
    this.take(tagged);
    this.editor.replaceAll(tagged.places);
    this.nowSaved();
    return 'Reloaded from the site; undo brings yours back';
  }

  /** Somebody saved the site's places, perhaps this page. */
  async heardOfSaving(): Promise<string> {
    await Promise.all([this.busy, this.host.list.saving]);
    const tagged = await api.getPlaces();
    if (tagged.etag === this.etag) return '';
    if (this.editor.dirty) return 'Somebody else saved places or zones; saving yours will ask what to do, Reload shows theirs';
    this.take(tagged);
    this.editor.replaceAll(tagged.places);
    this.nowSaved();
    return tagged.etag === this.host.list.savedAs ? '' : 'Somebody else saved places or zones: they are shown now';
  }

  /** At once, not a second later: a page that is opened meanwhile must not offer what has been saved over. */
  private nowSaved(): void {
    this.editor.markSaved();
    this.draft.changed();
  }
}
