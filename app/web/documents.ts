// The registry of the site: read, saved, and settled with what somebody else saved.
import * as api from './api.js';
import { askAboutConflict } from './dialogs.js';
import { plural } from './dom.js';
import type { Editor, Registry } from './editor.js';
import { merged } from './history.js';

export class Documents {
  private base: Registry;
  private etag: string;

  /** `hasRobot`: is one here that drives by the markers as they were when it began? */
  constructor(private readonly editor: Editor, tagged: api.Tagged, private readonly hasRobot: () => boolean) {
    [this.base, this.etag] = [tagged.registry, tagged.etag];
  }

  async save(): Promise<string> {
    const mine = this.editor.registry();
    try {
      this.take(await api.putMarkers(mine, this.etag));
      this.editor.markSaved();
      return `Saved ${plural(mine.markers.length, 'marker')}${this.hasRobot() ? '; the robot goes by them when it is started again' : ''}`;
    } catch (error) {
      if (!(error instanceof api.Refusal) || error.status !== 412) throw error;
      return await this.settle(mine);
    }
  }

  async reload(): Promise<string> {
    const tagged = await api.getMarkers();
    this.take(tagged);
    this.editor.load(tagged.registry);
    return 'Read again from the site';
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
}
