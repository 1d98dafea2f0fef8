// The status line at the foot of the page.
import { byId } from './dom.js';

export function say(words: string, bad = false): void {
  byId('state').textContent = words;
  byId('state').classList.toggle('bad', bad);
}

export const complain = (error: unknown): void => say(error instanceof Error ? error.message : String(error), true);

/** Runs an action that may fail, and reports the result. */
export function attempt(action: () => Promise<string | void>): void {
  action().then((words) => { if (words) say(words); }, complain);
}
