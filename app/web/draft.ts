// What has been changed and not saved, kept in the browser: a crash or a closed window loses nothing.
import { Latest } from './latest.js';

const keepEveryMs = 1000;

interface Kept<T> { at: string; document: T }

export interface Drafted<T> {
  key: string;   // in the browser's storage
  what: string;  // of it was not saved, in the words of what is said afterwards
  dirty: () => boolean;
  document: () => T;
  ask: (saved: T, left: T, sinceWhen: string) => Promise<boolean>;
  take: (left: T) => void;
}

export class Draft<T> {
  private readonly keeping: Latest;
  private offered = false;

  constructor(private readonly of: Drafted<T>, fail: (error: unknown) => void) {
    this.keeping = new Latest(keepEveryMs, async () => this.keep(), fail);
    addEventListener('pagehide', () => this.keep());
  }

  /** What has just been saved is thrown away at once: a page that is opened meanwhile must not offer what it replaced. */
  changed(): void {
    if (!this.of.dirty()) this.keep();
    else this.keeping.want();
  }

  private keep(): void {
    if (!this.offered) return;  // what an earlier window left stays until it is decided on
    if (!this.of.dirty()) return localStorage.removeItem(this.of.key);
    const kept: Kept<T> = { at: new Date().toLocaleString(), document: this.of.document() };
    localStorage.setItem(this.of.key, JSON.stringify(kept));
  }

  /** Offers what an earlier window left. */
  async offer(): Promise<string> {
    try {
      return await this.bringBack();
    } finally {
      this.offered = true;
      this.keep();
    }
  }

  private async bringBack(): Promise<string> {
    const text = localStorage.getItem(this.of.key);
    if (text === null) return '';
    const { at, document } = JSON.parse(text) as Kept<T>;
    const saved = this.of.document();
    if (JSON.stringify(saved) === JSON.stringify(document)) return '';
    if (!await this.of.ask(saved, document, at)) return `Threw the unsaved ${this.of.what} away`;
    this.of.take(document);
    return `Brought the unsaved ${this.of.what} back`;
  }
}
