// Compares two versions of what is named on a map, item by item, and merges them.
import type { PlacesDocument } from './places_doc.js';

type Entry = Record<string, unknown>;
const lists = ['places', 'nodes', 'edges', 'keep_out', 'speed_zones', 'missions'] as const;
const words: Record<typeof lists[number], string> = { places: 'place', nodes: 'node', edges: 'lane', keep_out: 'keep-out', speed_zones: 'speed zone', missions: 'mission' };

/** What makes an item the same in two versions: its name, the ends of a lane; of a zone without a name all of it. */
const identity = (entry: Entry): string => entry['from'] !== undefined ? `${String(entry['from'])} → ${String(entry['to'])}` : entry['name'] !== undefined ? String(entry['name']) : JSON.stringify(entry);
const indexed = (document: PlacesDocument, list: typeof lists[number]): Map<string, Entry> => new Map((document[list] as Entry[]).map((e) => [identity(e), e]));
const same = (a: unknown, b: unknown): boolean => JSON.stringify(a) === JSON.stringify(b);

/** One line for each item that differs. */
export function placesDifferences(from: PlacesDocument, to: PlacesDocument): string[] {
  return lists.flatMap((list) => {
    const before = indexed(from, list), after = indexed(to, list);
    return [...new Set([...before.keys(), ...after.keys()])].flatMap((id) => {
      const title = `${words[list]} ${id.startsWith('{') ? 'without a name' : id}`;
      if (!after.has(id)) return [`${title}: removed`];
      if (!before.has(id)) return [`${title}: added`];
      return same(before.get(id), after.get(id)) ? [] : [`${title}: changed`];
    });
  });
}

/** The changes from `base` to `mine`, applied to `theirs`. What is left without an end is for the server to refuse. */
export function mergedPlaces(base: PlacesDocument, mine: PlacesDocument, theirs: PlacesDocument): PlacesDocument {
  const merged = { ...theirs } as unknown as Record<string, unknown>;
  for (const list of lists) {
    const before = indexed(base, list), ours = indexed(mine, list), result = indexed(theirs, list);
    for (const id of before.keys()) if (!ours.has(id)) result.delete(id);
    for (const [id, entry] of ours) if (!same(before.get(id), entry)) result.set(id, entry);
    merged[list] = [...result.values()];
  }
  return merged as unknown as PlacesDocument;
}

/** Items that both sides changed, and differently: a merge takes ours. */
export function bothChanged(base: PlacesDocument, mine: PlacesDocument, theirs: PlacesDocument): string[] {
  return lists.flatMap((list) => {
    const before = indexed(base, list), ours = indexed(mine, list), others = indexed(theirs, list);
    return [...ours.keys()].filter((id) => !same(before.get(id), ours.get(id)) && !same(before.get(id), others.get(id)) && !same(ours.get(id), others.get(id)))
      .map((id) => `${words[list]} ${id}`);
  });
}
