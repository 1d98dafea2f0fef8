// Import, export, printing, history, conflict and help.
import * as api from './api.js';
import type { Command } from './commands.js';
import { ask, byId, el, plural } from './dom.js';
import type { Editor, Registry } from './editor.js';

const suffixes: Record<string, string> = {
  lodestar: '.yaml', csv: '.csv', stargazer: '.yaml', apriltag: '.json', fiducial_slam: '.txt', geojson: '.geojson',
};

function download(name: string, blob: Blob): void {
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
  if (await ask('Export markers', [row, el('p', {}, 'Poses as they are on the map, in metres.')],
    [['go', 'Download'], ['', 'Cancel']]) !== 'go') return;
  const { text } = await api.exportMarkers(select.value, editor.registry());
  download(`markers${suffixes[select.value] ?? '.txt'}`, new Blob([text]));
}

export async function importFrom(editor: Editor, file: File): Promise<string> {
  const registry = await api.importMarkers(file.name, await file.text());
  editor.replaceAll(registry);
  return `${plural(registry.markers.length, 'marker')} read from ${file.name}; undo brings the former back`;
}

export async function printChosen(editor: Editor): Promise<void> {
  const chosen = editor.chosen();
  const ids = [...new Set((chosen.length > 0 ? chosen : [...editor.markers.values()]).map((m) => m.id))].sort((a, b) => a - b);
  const [row, select] = choice('print-paper', 'Paper', ['A4', 'A3']);
  const words = `${plural(ids.length, 'sheet')}, one for each ${chosen.length > 0 ? 'chosen ' : ''}marker, as a PDF in true scale. ` +
    'Print at 100 % and measure the ruler.';
  if (ids.length === 0 || await ask('Print markers', [el('p', {}, words), row], [['go', 'Download'], ['', 'Cancel']]) !== 'go') return;
  download('markers.pdf', await api.printSheets(ids, select.value));
}

/** Takes an earlier state into the editor; nothing is saved by that. */
export async function openHistory(editor: Editor): Promise<string> {
  const numbers = await api.getHistory();
  if (numbers.length === 0) return 'Nothing has been saved over yet';
  const [row, select] = choice('history-number', 'Saved state', numbers.map(String));
  if (await ask('Earlier states', [el('p', {}, 'The highest number is the one before the last save.'), row],
    [['go', 'Bring back'], ['', 'Cancel']]) !== 'go') return '';
  editor.replaceAll(await api.getFormer(Number(select.value)));
  return `State ${select.value} brought back; save to keep it`;
}

export type Resolution = 'merge' | 'theirs' | 'mine' | '';

export async function askAboutConflict(base: Registry, mine: Registry, theirs: Registry): Promise<Resolution> {
  const words = `Meanwhile somebody else saved: ${difference(base, theirs)}. You: ${difference(base, mine)}.`;
  return await ask('Somebody else saved first', [el('p', { id: 'conflict-words' }, words),
    el('p', {}, 'Merging applies your changes to theirs; where both changed a marker, yours counts.')],
    [['merge', 'Merge'], ['theirs', 'Take theirs'], ['mine', 'Overwrite with mine'], ['', 'Go on editing']]) as Resolution;
}

type Entry = Registry['markers'][number];
const byIdOf = (registry: Registry): Map<number, Entry> => new Map(registry.markers.map((m) => [m.id, m]));
const same = (a: unknown, b: unknown): boolean => JSON.stringify(a) === JSON.stringify(b);

function difference(from: Registry, to: Registry): string {
  const before = byIdOf(from), after = byIdOf(to);
  const added = [...after.keys()].filter((id) => !before.has(id)).length;
  const removed = [...before.keys()].filter((id) => !after.has(id)).length;
  const changed = [...after].filter(([id, m]) => before.has(id) && !same(before.get(id), m)).length;
  return `${changed} changed, ${added} added, ${removed} removed`;
}

/** What `mine` changed since `base`, applied to `theirs`. */
export function merged(base: Registry, mine: Registry, theirs: Registry): Registry {
  const before = byIdOf(base), ours = byIdOf(mine), result = byIdOf(theirs);
  for (const id of before.keys()) if (!ours.has(id)) result.delete(id);
  for (const [id, marker] of ours) if (!same(before.get(id), marker)) result.set(id, marker);
  return {
    alignment: same(base.alignment, mine.alignment) ? theirs.alignment : mine.alignment,
    markers: [...result.values()],
  };
}

export async function showHelp(commands: Command[]): Promise<void> {
  const mouse: [string, string][] = [
    ['Drag', 'a marker: move all chosen; the round handle: rotate; the floor: pan'],
    ['Shift+click', 'choose one more'], ['Shift+drag', 'choose all in a box'], ['Alt while dragging', 'no snapping'],
    ['Wheel', 'zoom about the pointer'], ['Right drag', 'pan, wherever it begins'],
    ['Live: click, Shift+click', 'a goal, one goal more; the end of its arrow: drag for a heading'], ['Live: space bar', 'stop the robot'],
    ['Replay: arrows, space bar', 'half a second on or back (Shift: five), play or pause']];
  const keys = commands.filter((c) => c.key).map((c): [string, string] => [c.key!, c.title]);
  const list = el('dl', {}, ...[...mouse, ...keys].flatMap(([key, words]) => [el('dt', {}, key), el('dd', {}, words)]));
  await ask('Mouse and keys', [list, el('p', {}, 'A marker is given by the middle of its dot O (orange) and the direction from O ' +
    'to X (blue), counter-clockwise from the x axis, seen from above. The map shows markers from above, as through the ceiling: ' +
    'mirrored against what you see when you look up.')], [['', 'Close']]);
}

export function pickFile(then: (file: File) => void): void {
  const input = byId('file') as HTMLInputElement;
  input.value = '';
  input.onchange = () => { if (input.files?.[0]) then(input.files[0]); };
  input.click();
}
