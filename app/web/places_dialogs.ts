// Questions about places and zones: conflicts, earlier states.
import * as api from './api.js';
import { ask, el } from './dom.js';
import type { PlacesDocument, PlacesEditor } from './places_doc.js';
import { bothChanged, placesDifferences } from './places_merge.js';

const mostLines = 40;

export const changesOfPlaces = (lines: string[]): HTMLElement[] => [el('ul', { class: 'plain' }, ...lines.slice(0, mostLines).map((line) => el('li', {}, line))),
  ...(lines.length > mostLines ? [el('p', {}, `and ${lines.length - mostLines} more`)] : [])];

/** 'merge', 'theirs', 'mine', or nothing. Shows what each side changed, item by item. */
export function askAboutPlaces(base: PlacesDocument, mine: PlacesDocument, theirs: PlacesDocument): Promise<string> {
  const both = bothChanged(base, mine, theirs);
  return ask('Another user saved first', [el('p', {}, 'They changed:'), ...changesOfPlaces(placesDifferences(base, theirs)), el('p', {}, 'You changed:'), ...changesOfPlaces(placesDifferences(base, mine)),
    el('p', both.length > 0 ? { class: 'error' } : {}, both.length > 0 ? `Changed by both, a merge takes yours: ${both.join(', ')}.` : 'Nothing was changed by both.')],
  [['merge', 'Merge and save'], ['theirs', 'Take theirs'], ['mine', 'Overwrite theirs'], ['', 'Cancel']]);
}

/** Shows what has changed since an earlier state, and loads it without saving if wanted. */
export async function openPlacesHistory(editor: PlacesEditor): Promise<string> {
  const numbers = await api.getPlacesHistory();
  if (numbers.length === 0) return 'Nothing has been saved over yet';
  const select = el('select', { id: 'history-number' }, ...numbers.map((n) => el('option', { value: String(n) }, String(n))));
  const list = el('div', { id: 'history-list' });
  const show = async (): Promise<void> => {
    const lines = placesDifferences(await api.getFormerPlaces(Number(select.value)), editor.document());
    list.replaceChildren(...(lines.length === 0 ? [el('p', {}, 'The same as now.')] : changesOfPlaces(lines)));
  };
  select.addEventListener('change', () => { show().catch((error: unknown) => { list.replaceChildren(String(error)); }); });
  await show();
  if (await ask('Earlier states', [el('p', {}, 'The highest number is the one before the last save. Changed since then:'), el('p', {}, el('label', { for: 'history-number' }, 'Saved state '), select), list],
    [['go', 'Bring back'], ['', 'Cancel']]) !== 'go') return '';
  const number = select.value;
  editor.replaceAll(await api.getFormerPlaces(Number(number)));
  return `State ${number} brought back; save to keep it`;
}
