// The mode of the page: selects the panel beside the map, and the meaning of clicks on it.
import { button, byId } from './dom.js';
import type { Layers } from './layers.js';
import type { Hang } from './hang.js';
import type { Live } from './live.js';
import type { MapMode } from './map_mode.js';
import type { Guest, Pointer } from './pointer.js';
import type { Replay } from './replay.js';
import { linkIn } from './run_link.js';
import type { RunLink } from './run_link.js';
import type { SitePlaces } from './site_places.js';
import type { Stage } from './stage.js';
import { attempt } from './words.js';

export type Mode = 'edit' | 'hang' | 'places' | 'map' | 'live' | 'survey' | 'replay';
const titles: [Mode, string, string][] = [['edit', 'Markers', 'edit the markers'], ['hang', 'Hang', 'hang the markers, one after the other'], ['places', 'Zones', 'draw zones, lanes and places'], ['map', 'Map', 'draw and erase walls'], ['live', 'Live', 'watch and drive the robot'],
  ['survey', 'Survey', 'survey the markers by driving'],
  ['replay', 'Replay', 'open a run and play it back']];

/** Ignores clicks and drags: no editing during playback. */
const passive: Guest = { press: () => false, drag: () => {}, release: () => {}, click: () => {} };

interface Parts {
  readonly hang: Hang;
  readonly map: MapMode;
  readonly layers: Layers;
  readonly live: Live;
  readonly pointer: Pointer;
  readonly places: SitePlaces;
  readonly replay: Replay;
  readonly stage: Stage;
  fit(): void;
  refreshTools(): void;
}

export class Modes {
  now: Mode = 'edit';
  private link: RunLink | null = null;  // that the page was opened with, until it is left
  private readonly seen = new Set<Mode>();

  constructor(private readonly parts: Parts) {
    byId('modes').append(...titles.map(([mode, text, title]) => button(text, title, () => this.enter(mode), { id: `tool-${mode}` })));
    parts.replay.onClose = () => this.enter(parts.live.hello?.robot ? 'live' : 'edit');
    parts.live.onRobot = () => { if (!this.link) this.enter(parts.live.hello?.survey ? 'survey' : 'live'); };
    this.link = linkIn(location.hash);
    this.enter(this.link ? 'replay' : 'edit');
  }

  enter(mode: Mode): void {
    const { hang, layers, live, map, places, pointer, replay, stage } = this.parts;
    const before = this.now;
    this.now = mode;
    document.body.dataset['mode'] = mode;
    for (const [other] of titles) byId(`tool-${other}`).setAttribute('aria-pressed', String(other === mode));
    pointer.endPick();
    pointer.cancel();
    const isLive = mode === 'live' || mode === 'survey';
    pointer.guest = mode === 'edit' ? null : mode === 'hang' ? hang : mode === 'places' ? places.tools : isLive ? live : passive;
    if (mode === 'places') places.judge();
    else if (before === 'places') places.tools.take(null);
    stage.showsSelection = mode === 'edit';
    live.show(isLive, mode === 'survey');
    hang.show(mode === 'hang');
    map.show(mode === 'map');
    if (before !== mode) layers.paintFloor(mode === 'edit' ? 'coverage' : 'plain');
    if (mode !== 'replay') this.fitAtFirst(mode);
    this.parts.refreshTools();
    stage.paintRaster();
    stage.redraw();
    if (mode === 'replay') return attempt(() => this.openReplay());
    if (before === 'replay') replay.leave();
    this.link = null;
  }

  private async openReplay(): Promise<string> {
    const first = !this.seen.has('replay');
    const words = await this.parts.replay.open(this.link);
    if (first && this.now === 'replay') this.fitAtFirst('replay');
    return words;
  }

  /** Fits the map on the first use of a mode: each leaves a different size for it. */
  private fitAtFirst(mode: Mode): void {
    if (this.seen.has(mode)) return;
    this.seen.add(mode);
    this.parts.stage.resize();
    this.parts.fit();
  }
}
