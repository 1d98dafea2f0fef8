// The map of a site that is there: walls drawn and erased, and saved. What stands on it is measured against the new one.
import * as api from './api.js';
import type { TaggedCells } from './api.js';
import { button, byId, el } from './dom.js';
import type { Live } from './live.js';
import { MapPaint } from './map_paint.js';
import { MapTools } from './map_tools.js';
import { NewStage } from './new_stage.js';
import { attempt } from './words.js';

const waitMs = 200;

export class MapMode {
  paint: MapPaint | null = null;
  private stage: NewStage | null = null;
  private tools: MapTools | null = null;
  private before: TaggedCells | null = null;
  private shown = false;
  private readonly save = button('Save the map', 'What was before is kept in .history/map', () => attempt(() => this.keep()), { id: 'map-save', class: 'main' });
  private readonly words = el('p', { id: 'map-words', role: 'status' });

  constructor(private readonly info: api.MapInfo, private readonly live: Live) {
    addEventListener('keydown', (e) => { if (this.shown) this.tools?.key(e); });
    addEventListener('beforeunload', (e) => { if (this.paint?.canUndo) e.preventDefault(); });
  }

  show(shown: boolean): void {
    this.shown = shown;
    if (shown && this.paint === null) attempt(() => this.open());
    else if (shown) this.stage?.fit();
  }

  private async open(): Promise<string | void> {
    this.before = await api.getTaggedCells();
    this.paint = new MapPaint(this.info.columns, this.info.rows, new Uint8Array(this.before.cells));
    this.stage = new NewStage();
    this.stage.showMap(this.paint);
    if (this.live.hello?.robot) {
      this.stage.drawable = false;
      byId('map').replaceChildren(el('p', {}, 'A robot runs on this map. End it, draw in the console of lodestar serve, and start the robot again.'));
      return;
    }
    this.tools = new MapTools(this.stage, () => this.paint);
    byId('map').replaceChildren(el('p', {}, 'The wheel zooms, the right button moves the map.'), this.tools.element, this.words, el('div', { class: 'row' }, this.save));
    this.stage.onStroke = () => this.refresh();
    this.tools.pick('line', 'wall');
    this.refresh();
  }

  private refresh(): void {
    const { paint, before } = this;
    if (!paint || !before) return;
    const changed = paint.cells.reduce((sum, cell, i) => sum + (cell === before.cells[i] ? 0 : 1), 0);
    this.words.textContent = changed === 0 ? 'Nothing has changed' : `${(changed * this.info.resolution_m ** 2).toFixed(2)} m² changed`;
    this.save.disabled = changed === 0;
  }

  private async keep(): Promise<void> {
    const { paint, before } = this;
    if (!paint || !before) return;
    await api.saveCells(paint.cells, before.etag);
    this.paint = null;  // nothing is lost by leaving
    sessionStorage.setItem('lodestar-made', 'The map is saved. Look at the coverage and at what cannot be reached');
    while (!await api.isMapAnother(before.etag)) await new Promise((done) => setTimeout(done, waitMs));
    location.reload();
  }
}
