// Compares two versions of the registry, in words.
import type { Registry } from './editor.js';

type Entry = Registry['markers'][number];
const byIdOf = (registry: Registry): Map<number, Entry> => new Map(registry.markers.map((m) => [m.id, m]));
const same = (a: unknown, b: unknown): boolean => JSON.stringify(a) === JSON.stringify(b);

/** One line for each marker that differs, by ID. */
export function differences(from: Registry, to: Registry): string[] {
  const before = byIdOf(from), after = byIdOf(to);
  const lines: string[] = [];
  if (!same(from.alignment, to.alignment)) lines.push('the alignment to the map');
  for (const id of [...new Set([...before.keys(), ...after.keys()])].sort((a, b) => a - b)) {
    const a = before.get(id), b = after.get(id);
    if (!b) lines.push(`${id}: removed`);
    else if (!a) lines.push(`${id}: added at ${b.x_m.toFixed(3)}, ${b.y_m.toFixed(3)} m`);
    else if (!same(a, b)) lines.push(`${id}: ${changeOf(a, b)}`);
  }
  return lines;
}

function changeOf(a: Entry, b: Entry): string {
  const fields: [keyof Entry, string][] = [['x_m', 'x'], ['y_m', 'y'], ['z_m', 'z'], ['yaw_deg', 'yaw']];
  return fields.filter(([key]) => a[key] !== b[key])
    .map(([key, name]) => `${name} ${a[key]} → ${b[key]}${key === 'yaw_deg' ? '°' : ' m'}`).join(', ');
}

export function summary(from: Registry, to: Registry): string {
  const before = byIdOf(from), after = byIdOf(to);
  const added = [...after.keys()].filter((id) => !before.has(id)).length;
  const removed = [...before.keys()].filter((id) => !after.has(id)).length;
  const changed = [...after].filter(([id, m]) => before.has(id) && !same(before.get(id), m)).length;
  return `${changed} changed, ${added} added, ${removed} removed`;
}

/** IDs of markers that both sides changed, and differently. */
export function bothChanged(base: Registry, mine: Registry, theirs: Registry): number[] {
  const before = byIdOf(base), ours = byIdOf(mine), others = byIdOf(theirs);
  return [...new Set([...before.keys(), ...ours.keys()])].filter((id) => !same(before.get(id), ours.get(id)) && !same(before.get(id), others.get(id)) && !same(ours.get(id), others.get(id)));
}

/** The changes from `base` to `mine`, applied to `theirs` (three-way merge). */
export function merged(base: Registry, mine: Registry, theirs: Registry): Registry {
  const before = byIdOf(base), ours = byIdOf(mine), result = byIdOf(theirs);
  for (const id of before.keys()) if (!ours.has(id)) result.delete(id);
  for (const [id, marker] of ours) if (!same(before.get(id), marker)) result.set(id, marker);
  return {
    alignment: same(base.alignment, mine.alignment) ? theirs.alignment : mine.alignment,
    markers: [...result.values()],
  };
}
