// The registry of the site: loads, saves, and resolves conflicts with another user's save.
import * as api from './api.js';
import { askAboutConflict, confirmReload } from './dialogs.js';
import { plural } from './dom.js';
import type { Editor, Registry } from './editor.js';
import { merged } from './history.js';

export class Documents {
  private base: Registry;
  private etag: string;
  private busy: Promise<unknown> = Promise.resolve();

  /** `hasRobot`: is a robot connected that drives by the markers loaded at its start? */
  constructor(private readonly editor: Editor, tagged: api.Tagged, private readonly hasRobot: () => boolean) {
    [this.base, this.etag] = [tagged.registry, tagged.etag];
  }

  async save(): Promise<string> {
    const saving = this.saveNow();
    this.busy = saving.catch(() => undefined);
    return await saving;
  }

  private async saveNow(): Promise<string> {
    const mine = this.editor.registry();
    try {
      this.take(await api.putMarkers(mine, this.etag));
      this.editor.markSaved();
      return `Saved ${plural(mine.markers.length, 'marker')}${this.hasRobot() ? '; the robot uses them after its next start' : ''}`;
    } catch (error) {
      if (!(error instanceof api.Refusal) || error.status !== 412) throw error;
      return await this.settle(mine);
    }
  }

  /** Someone saved the markers, perhaps this page. */
  async heardOfSaving(): Promise<string> {
    await this.busy;
    const tagged = await api.getMarkers();
    if (tagged.etag === this.etag) return '';
    if (this.editor.dirty) return 'Somebody else saved the markers; saving yours will ask what to do, Reload shows theirs';
    this.take(tagged);
    this.editor.replaceAll(tagged.registry);
    this.editor.markSaved();
    return 'Somebody else saved the markers: they are shown now';
  }

  /** What is thrown away is asked for, and undo brings it back. */
  async reload(): Promise<string> {
    const tagged = await api.getMarkers();
    if (this.editor.dirty && !await confirmReload(tagged.registry, this.editor.registry())) return 'Kept your changes';
    this.take(tagged);
    this.editor.replaceAll(tagged.registry);
    this.editor.markSaved();
    return 'Reloaded from the site; undo brings your markers back';
  }

  private async settle(mine: Registry): Promise<string> {
    const theirs = await api.getMarkers();
    const resolution = await askAboutConflict(this.base, mine, theirs.registry);
    if (resolution === '') return 'Not saved: another user saved first';
    const base = this.base;
    this.take(theirs);
    if (resolution === 'theirs') {
      this.editor.load(theirs.registry);
      return 'Loaded the version that the other user saved';
    }
    if (resolution === 'merge') this.editor.replaceAll(merged(base, mine, theirs.registry));
    this.take(await api.putMarkers(this.editor.registry(), this.etag));
    this.editor.markSaved();
    return resolution === 'merge' ? 'Merged and saved' : 'Overwrote the other version; it is in the history';
  }

  private take(tagged: api.Tagged): void { [this.base, this.etag] = [tagged.registry, tagged.etag]; }
}
