// Starts the console's page: opens a session with the token in the address, loads the documents, and creates
// the console.
import * as api from './api.js';
import { Console } from './console.js';
import { Coverage } from './coverage.js';
import { Floor } from './floor.js';
import { centerOf } from './geometry.js';
import type { Marker, Point } from './geometry.js';
import { NewSitePage } from './new_site.js';
import { say } from './words.js';

/** A link with #t=TOKEN becomes a session; the token leaves the address bar. */
async function useTokenOfAddress(): Promise<void> {
  const parts = new URLSearchParams(location.hash.slice(1));
  const token = parts.get('t');
  if (!token) return;
  parts.delete('t');
  history.replaceState(null, '', location.pathname + (parts.size > 0 ? `#${parts}` : ''));
  await api.openSession(token);
}

/** For tests, and for the browser's own console. */
export interface Handle {
  console: Console;
  screenOf(id: number): Point;
  marker(id: number): Marker | undefined;
  /** Counts these markers alone, at once; on another floor if there is one. */
  countedAnew(markers: Iterable<Marker>, floor?: Floor): Coverage;
}

async function start(): Promise<void> {
  if (matchMedia('(prefers-color-scheme: dark)').matches) document.documentElement.dataset['theme'] = 'dark';
  await useTokenOfAddress();
  const site = await api.getSite();
  if ('new' in site) {
    (window as unknown as { lodestar: { newSite: NewSitePage } }).lodestar = { newSite: new NewSitePage(site.folder) };
    return;
  }
  const [info, cells, tagged] = await Promise.all([api.getMap(), api.getCells(), api.getMarkers()]);
  const made = new Console(site, new Floor(info, cells, site.coverage.room_m, await api.getHeights(info)), tagged);
  const marker = (id: number) => [...made.editor.shown()].find((m) => m.id === id);
  const countedAnew = (markers: Iterable<Marker>, floor = made.floor) => {
    const coverage = new Coverage(floor, site.coverage);
    for (const m of markers) coverage.put(m);
    return coverage;
  };
  const handle: Handle = { console: made, marker, countedAnew, screenOf: (id) => made.view.toScreen(centerOf(marker(id)!)) };
  (window as unknown as { lodestar: Handle }).lodestar = handle;
  say(sessionStorage.getItem('lodestar-made') ?? 'Ready');
  sessionStorage.removeItem('lodestar-made');
}

/** Instead of an empty page. */
function explain(error: unknown): void {
  const needsToken = error instanceof api.Refusal && error.status === 401;
  const words = needsToken ? 'This console needs its token: open the address with #t=TOKEN' : error instanceof Error ? error.message : String(error);
  const box = document.createElement('div');
  box.id = 'no-start';
  box.setAttribute('role', 'alert');
  const head = document.createElement('h2');
  head.textContent = needsToken ? 'Not signed in' : 'The console could not start';
  const text = document.createElement('p');
  text.textContent = needsToken ? `${words}. The token is what lodestar was started with: --token, --edit-token or --view-token.` : words;
  box.append(head, text);
  document.querySelector('main')!.replaceChildren(box);
  say(words, true);
}

start().catch(explain);
