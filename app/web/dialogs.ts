// Import, export, printing, conflict and help.
import * as api from './api.js';
import type { Command } from './commands.js';
import { ask, byId, el, plural } from './dom.js';
import type { Editor, Registry } from './editor.js';
import { bothChanged, differences, summary } from './history.js';

const suffixes: Record<string, string> = {
  lodestar: '.yaml', csv: '.csv', stargazer: '.yaml', apriltag: '.json', fiducial_slam: '.txt', geojson: '.geojson',
};

export function download(name: string, blob: Blob): void {
  const link = el('a', { href: URL.createObjectURL(blob), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

function choice(id: string, label: string, options: string[]): [HTMLElement, HTMLSelectElement] {
  const select = el('select', { id }, ...options.map((o) => el('option', { value: o }, o)));
  return [el('p', {}, el('label', { for: id }, `${label} `), select), select];
}

export async function exportTo(editor: Editor, formats: string[]): Promise<void> {
  const [row, select] = choice('export-format', 'Format', formats);
  if (await ask('Export markers', [row, el('p', {}, 'Poses in the map frame, in metres.')],
    [['go', 'Download'], ['', 'Cancel']]) !== 'go') return;
  const { text } = await api.exportMarkers(select.value, editor.registry());
  download(`markers${suffixes[select.value] ?? '.txt'}`, new Blob([text]));
}

export async function importFrom(editor: Editor, file: File): Promise<string> {
  const read = await api.importMarkers(file.name, await file.text());
  const words = `${plural(read.markers.length, 'marker')} read from ${file.name}`;
  const joined = editor.joined(read);
  const way = editor.markers.size === 0 ? 'replace' : await askHowToImport(words, editor.registry(), joined, read);
  if (way === '') return 'Nothing was imported';
  editor.replaceAll(way === 'add' ? joined : read);
  return `${words}; undo restores the previous markers`;
}

const askHowToImport = (words: string, now: Registry, joined: Registry, read: Registry): Promise<string> => ask(words,
  [el('p', { id: 'import-add' }, `Added to those here: ${summary(now, joined)}.`), ...changesOf(now, joined),
    el('p', { id: 'import-replace' }, `In place of all here: ${summary(now, read)}.`), ...changesOf(now, read)],
  [['add', 'Add'], ['replace', 'Replace all'], ['', 'Cancel']]);

export async function printChosen(editor: Editor): Promise<void> {
  const chosen = editor.chosen();
  const ids = [...new Set((chosen.length > 0 ? chosen : [...editor.markers.values()]).map((m) => m.id))].sort((a, b) => a - b);
  const [row, select] = choice('print-paper', 'Paper', ['A4', 'A3']);
  const words = `${plural(ids.length, 'sheet')}, one for each ${chosen.length > 0 ? 'chosen ' : ''}marker with where it hangs, as a PDF in true scale. ` +
    'Print at 100 % and measure the ruler.';
  if (ids.length === 0 || await ask('Print markers', [el('p', {}, words), row], [['go', 'Download'], ['', 'Cancel']]) !== 'go') return;
  download('markers.pdf', await api.printSheets(ids, editor.registry(), select.value));
}

export type Resolution = 'merge' | 'theirs' | 'mine' | '';

const mostLines = 40;

/** A line for each change, and how many more there are. */
export const changeList = (lines: string[]): HTMLElement[] => [el('ul', { class: 'plain' }, ...lines.slice(0, mostLines).map((line) => el('li', {}, line))),
  ...(lines.length > mostLines ? [el('p', {}, `and ${lines.length - mostLines} more`)] : [])];

/** The changes that are not saved, marker by marker. */
const changesOf = (from: Registry, to: Registry): HTMLElement[] => changeList(differences(from, to));

export async function askAboutConflict(base: Registry, mine: Registry, theirs: Registry): Promise<Resolution> {
  const words = `Another user has saved: ${summary(base, theirs)}. You: ${summary(base, mine)}.`;
  const both = bothChanged(base, mine, theirs);
  return await ask('Another user saved first', [el('p', { id: 'conflict-words' }, words), el('p', {}, 'They changed:'), ...changesOf(base, theirs), el('p', {}, 'You changed:'), ...changesOf(base, mine),
    el('p', both.length > 0 ? { class: 'error', id: 'conflict-both' } : { id: 'conflict-both' }, both.length > 0 ? `Changed by both: ${both.join(', ')}. A merge takes yours.` : 'No marker was changed by both: a merge loses nothing.')],
    [['merge', 'Merge'], ['theirs', 'Take theirs'], ['mine', 'Overwrite with mine'], ['', 'Continue editing']]) as Resolution;
}

export async function confirmReload(theirs: Registry, mine: Registry): Promise<boolean> {
  return await ask('Throw away your changes?', [el('p', {}, `Not saved: ${summary(theirs, mine)}.`), ...changesOf(theirs, mine)],
    [['', 'Keep editing'], ['go', 'Throw away and reload']]) === 'go';
}

/** `sinceWhen`: in words. Who closes the question has not said to throw them away. */
export async function offerDraft(saved: Registry, draft: Registry, sinceWhen: string): Promise<boolean> {
  return await ask('Changes that were not saved', [el('p', {}, `This browser kept changes of ${sinceWhen}: ${summary(saved, draft)}.`), ...changesOf(saved, draft)],
    [['go', 'Bring them back'], ['no', 'Throw them away']]) !== 'no';
}

export async function showHelp(commands: Command[]): Promise<void> {
  const mouse: [string, string][] = [
    ['Drag', 'a marker: move the selection; the round handle: rotate; the floor: pan'],
    ['Shift+click', 'add to the selection'], ['Shift+drag', 'select all in a box'], ['Alt while dragging', 'no snapping'],
    ['Wheel', 'zoom at the pointer'], ['Right drag', 'pan, wherever it starts'],
    ['Live: click, Shift+click', 'set a goal, add a goal; drag the end of its arrow for a heading'], ['Space bar', 'stop the robot, wherever the focus is; Escape leaves a text field first'],
    ['Replay: arrows, P', 'half a second forward or back (Shift: five), play or pause']];
  const keys = commands.filter((c) => c.key).map((c): [string, string] => [c.key!, c.title]);
  const list = el('dl', {}, ...[...mouse, ...keys].flatMap(([key, words]) => [el('dt', {}, key), el('dd', {}, words)]));
  await ask('Mouse and keys', [list, el('p', {}, 'A marker is given by the centre of its dot O (orange) and the direction from O ' +
    'to X (blue), counter-clockwise from the x axis, seen from above. The map shows markers from above, as through the ceiling: ' +
    'mirrored compared with what you see when you look up.')], [['', 'Close']]);
}

export function pickFile(then: (file: File) => void): void {
  const input = byId('file') as HTMLInputElement;
  input.value = '';
  input.onchange = () => { if (input.files?.[0]) then(input.files[0]); };
  input.click();
}
