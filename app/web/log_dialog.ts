// Who drove and who saved, the newest first.
import { getLog } from './api.js';
import { ask, el } from './dom.js';
import { shortTime } from './when.js';

const mostShown = 300;

export async function openLog(): Promise<void> {
  const entries = await getLog();
  const filter = el('input', { type: 'search', id: 'log-filter', placeholder: 'Filter', 'aria-label': 'Filter the log' });
  const list = el('ul', { class: 'plain', id: 'log-list', tabindex: '0', 'aria-label': 'Log' });
  const show = (): void => {
    const wanted = filter.value.trim().toLowerCase();
    const fitting = entries.filter(({ at, by, what }) => `${shortTime(at)} ${by} ${what}`.toLowerCase().includes(wanted)).slice(0, mostShown);
    list.replaceChildren(...fitting.map(({ at, by, what }) => el('li', {}, el('time', { datetime: at }, shortTime(at)), ` ${by === '' ? '' : `${by}: `}${what}`)));
    if (fitting.length === 0) list.replaceChildren(el('li', {}, entries.length === 0 ? 'Nobody has driven or saved yet.' : 'None.'));
  };
  filter.addEventListener('input', show);
  show();
  await ask('Who drove and who saved', [el('p', { class: 'faint' }, 'By the names under "Shown to others as", which people give themselves.'), filter, list], [['', 'Close']]);
}
