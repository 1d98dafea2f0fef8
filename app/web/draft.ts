// What has been changed and not saved, kept in the browser: a crash or a closed window loses nothing.
import { offerDraft } from './dialogs.js';
import type { Editor, Registry } from './editor.js';
import { Latest } from './latest.js';

const keepEveryMs = 1000;

interface Kept { at: string; registry: Registry }

export class Draft {
  private readonly key: string;
  private readonly keeping: Latest;
  private offered = false;

  constructor(private readonly editor: Editor, site: string, fail: (error: unknown) => void) {
    this.key = `lodestar-draft: ${site}`;
    this.keeping = new Latest(keepEveryMs, async () => this.keep(), fail);
  }

  /** What has just been saved is thrown away at once: a page that is opened meanwhile must not offer what it replaced. */
  changed(): void {
    if (this.offered && !this.editor.dirty) this.keep();
    else this.keeping.want();
  }

  private keep(): void {
    if (!this.editor.dirty) return localStorage.removeItem(this.key);
    const kept: Kept = { at: new Date().toLocaleString(), registry: this.editor.registry() };
    localStorage.setItem(this.key, JSON.stringify(kept));
  }

  /** Offers what an earlier window left. */
  async offer(): Promise<string> {
    const text = localStorage.getItem(this.key);
    this.offered = true;
    if (text === null) return '';
    localStorage.removeItem(this.key);
    const { at, registry } = JSON.parse(text) as Kept;
    const saved = this.editor.registry();
    if (JSON.stringify(saved) === JSON.stringify(registry)) return '';
    if (!await offerDraft(saved, registry, at)) return 'Threw the unsaved changes away';
    this.editor.replaceAll(registry);
    return 'Brought the unsaved changes back';
  }
}
