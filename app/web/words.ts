// The line at the foot of the page: what has just been done, or why it could not be. Nothing in it outlives its use: the
// robot's state stands elsewhere.
import { byId } from './dom.js';

const keptMs = 10_000;
const keptBadMs = 30_000;
let ends = 0;

export function say(words: string, bad = false): void {
  clearTimeout(ends);
  if (words !== '') ends = setTimeout(() => say(''), bad ? keptBadMs : keptMs);
  byId('state').textContent = words;
  byId('state').classList.toggle('bad', bad);
}

export const complain = (error: unknown): void => say(error instanceof Error ? error.message : String(error), true);

/** Runs an action that may fail, and reports the result. */
export function attempt(action: () => Promise<string | void>): void {
  action().then((words) => { if (words) say(words); }, complain);
}
