// The map and the markers that a run was driven on: those of today may be others.
import { getCellsOfRun } from './api.js';
import type { Run, Site } from './api.js';
import { Floor } from './floor.js';
import { Editor } from './editor.js';
import type { Registry } from './editor.js';
import { FloorPaint } from './floor_paint.js';
import type { Marker } from './geometry.js';
import { differences } from './history.js';
import type { Stage } from './stage.js';

export interface Scene { floor: FloorPaint; markers: Marker[] }
export interface RunScene { scene: Scene | null; words: string }

const sameCells = (a: Int8Array, b: Int8Array): boolean => a.length === b.length && a.every((value, i) => value === b[i]);

/** The markers of a registry in the map frame. */
export function markersOf(registry: Registry): Marker[] {
  const editor = new Editor();
  editor.load(registry);
  return [...editor.shown()];
}

/** What a run is drawn over, and in words how it differs from today's. */
export async function sceneOf(run: Run, stage: Stage, site: Site): Promise<RunScene> {
  if (!run.map || !run.registry) return { scene: null, words: 'It kept no map and no markers of its own: it is drawn over today\'s.' };
  const cells = await getCellsOfRun(run.name);
  const { columns, rows, resolution_m, origin } = stage.floor.info;
  const isSameMap = JSON.stringify(run.map) === JSON.stringify({ columns, rows, resolution_m, origin }) && sameCells(cells, stage.floor.cells);
  const moved = differences(run.registry, stage.editor.registry()).length;
  const since = [...(isSameMap ? [] : ['the map']), ...(moved === 0 ? [] : [moved === 1 ? 'one marker' : `${moved} markers`])];
  const words = since.length === 0 ? '' : `Drawn over the map and markers that it drove on. Changed since then: ${since.join(' and ')}.`;
  if (isSameMap) return { scene: { floor: stage.floorPaint, markers: markersOf(run.registry) }, words };
  const floor = new Floor({ ...run.map, heights: null }, cells, site.coverage.room_m);
  const paint = new FloorPaint(floor, new Uint16Array(cells.length), stage.layers);
  paint.paint();
  return { scene: { floor: paint, markers: markersOf(run.registry) }, words };
}
