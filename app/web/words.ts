// The line at the foot of the page: what has just been done, or why not.
import { byId } from './dom.js';

export function say(words: string, bad = false): void {
  byId('state').textContent = words;
  byId('state').classList.toggle('bad', bad);
}

export const complain = (error: unknown): void => say(error instanceof Error ? error.message : String(error), true);

/** Runs something that may fail, and says how. */
export function attempt(action: () => Promise<string | void>): void {
  action().then((words) => { if (words) say(words); }, complain);
}
