// Earlier states of a document: when each was saved over and by whom, a picture of it, and what has changed since.
import type { FormerState } from './api.js';
import { ask, button, el } from './dom.js';
import { complain } from './words.js';
import { shortTime } from './when.js';

export interface History<Document> {
  states: FormerState[];
  get(number: number): Promise<Document>;
  /** What has changed since, in words; `list` a line each. */
  compare(former: Document): { summary: string; list: string[] };
  /** A picture of a state, with what has changed since where it is `large`. */
  draw(canvas: HTMLCanvasElement, former: Document, large: boolean): void;
}

const mostLines = 200;
const whenOf = (state: FormerState): string => `${state.at === '' ? `State ${state.number}` : shortTime(state.at)}${state.by === '' ? '' : `, ${state.by}`}`;

/** The state that is to be brought back; null when none is. */
export async function chooseState<Document>(history: History<Document>): Promise<Document | null> {
  const read = new Map<number, Promise<Document>>();
  const get = (number: number): Promise<Document> => {
    if (!read.has(number)) read.set(number, history.get(number));
    return read.get(number)!;
  };
  const words = el('p', { id: 'history-words', role: 'status' });
  const lines = el('ul', { class: 'plain', id: 'history-list' });
  const picture = el('canvas', { id: 'history-picture', role: 'img' });
  let chosen = history.states[0]!.number;
  const rows = history.states.map((state) => {
    const small = el('canvas', { 'aria-hidden': 'true' });
    const row = button('', 'Show what has changed since', () => { choose(state.number).catch(complain); }, { id: `history-${state.number}` });
    row.append(small, el('span', {}, whenOf(state)));
    return { state, small, row };
  });
  const choose = async (number: number): Promise<void> => {
    chosen = number;
    for (const { state, row } of rows) row.setAttribute('aria-pressed', String(state.number === number));
    const former = await get(number);
    if (chosen !== number) return;
    const { summary, list } = history.compare(former);
    words.textContent = summary;
    picture.setAttribute('aria-label', summary);
    lines.replaceChildren(...list.slice(0, mostLines).map((line) => el('li', {}, line)));
    history.draw(picture, former, true);
  };
  // Pictures are made when they come into sight: there may be fifty of thousands of markers.
  const seen = new IntersectionObserver((entries) => {
    for (const entry of entries.filter((e) => e.isIntersecting)) {
      seen.unobserve(entry.target);
      const { state, small } = rows.find(({ row }) => row === entry.target)!;
      get(state.number).then((former) => history.draw(small, former, false)).catch(complain);
    }
  });
  for (const { row } of rows) seen.observe(row);
  await choose(chosen);
  const answer = await ask('Earlier states', [el('p', {}, 'Each until it was saved over, the newest first.'),
    el('div', { class: 'history' }, el('ul', { class: 'plain history-states' }, ...rows.map(({ row }) => el('li', {}, row))), el('div', {}, picture, words, lines))],
  [['go', 'Bring back'], ['', 'Cancel']]);
  seen.disconnect();
  return answer === 'go' ? await get(chosen) : null;
}
