// The server's documents. A refused request throws a Refusal with the server's message.
import { base64 } from './base64.js';
import type { Registry } from './editor.js';
import { myName } from './my_name.js';
import type { ListName, NamedMission, PlacesDocument } from './places_doc.js';

export class Refusal extends Error {
  /** `item`: of the document sent, that is to blame. */
  constructor(readonly status: number, words: string, readonly item: { list: ListName; index: number } | null = null) { super(words); }
}

export interface Site {
  name: string;
  actions: string[];  // that a mission may have carried out at its stops
  robot: { name: string; radius_m: number; footprint_m: [number, number][] | null };  // the outline; null for a disc
  start: { x_m: number; y_m: number; yaw_deg: number };
  goals: { x_m: number; y_m: number }[];
  routes: [number, number][][];  // the usual routes, as waypoints
  coverage: { camera: string; camera_height_m: number; reach_per_m: number; margin_m: number; room_m: number };
  formats: string[];
}

export interface MapInfo {
  columns: number;
  rows: number;
  resolution_m: number;
  origin: { x_m: number; y_m: number; yaw_deg: number };
  heights: { low_m: number; step_m: number; touch_m: number } | null;  // of an OctoMap
}

/** Occupied heights above each cell: bit k from low_m + k step_m up to the next. */
export interface Heights { low_m: number; step_m: number; touch_m: number; bands: Uint32Array }

/** Every `stride`-th cell of each row and column: millimetres, or null where some heading sees no marker. */
export interface Deviations { stride: number; columns: number; sigma_mm: (number | null)[] }

export interface Issue {
  kind: string;  // as lodestar markers check names it
  severity: 'error' | 'warning';
  ids: number[];
  words: string;
  places_m: [number, number][];
  accepted?: { reason: string; by: string; at: string };
}

async function request(method: string, target: string, body?: unknown, headers: Record<string, string> = {}): Promise<Response> {
  const init: RequestInit = { method, headers: { ...headers } };
  if (body !== undefined) {
    init.body = JSON.stringify(body);
    init.headers = { ...headers, 'Content-Type': 'application/json', 'X-Lodestar': '1', 'X-Lodestar-Name': encodeURIComponent(myName()) };
  }
  const response = await fetch(target, init).catch(() => { throw new Refusal(0, 'the server does not answer'); });
  if (!response.ok) {
    const why = await response.json().catch(() => ({})) as { error?: string; list?: ListName; index?: number };
    throw new Refusal(response.status, why.error ?? response.statusText, why.list === undefined ? null : { list: why.list, index: why.index ?? 0 });
  }
  return response;
}

const json = async <T>(response: Promise<Response>): Promise<T> => await (await response).json() as T;

export const openSession = (token: string): Promise<Response> => request('POST', '/api/session', { token });
export const getSite = (): Promise<Site | NoSite> => json(request('GET', '/api/site'));

export type HangingState = 'planned' | 'hung' | 'verified';
/** A saved marker on the map: its centre, and metres to the walls about it. */
export interface HangingMarker {
  id: number; x_m: number; y_m: number; z_m: number; yaw_deg: number;
  walls: { left: number | null; right: number | null; below: number | null; above: number | null };
  state: HangingState; by: string; at: string; photo: boolean;
}
export const getHanging = (): Promise<HangingMarker[]> => json(request('GET', '/api/hanging'));
export const setHanging = (id: number, state: HangingState, by: string): Promise<HangingMarker[]> => json(request('PUT', `/api/hanging/${id}`, { state, by }));
export const keepPhoto = (id: number, jpeg: string): Promise<HangingMarker[]> => json(request('PUT', `/api/hanging/${id}/photo`, { jpeg }));

/** Of a site that is yet to be made. */
export interface NoSite { new: true; folder: string }
export interface Plan { name: string; width_px: number; height_px: number; metres_per_px: number | null; shown_px: number; png: string }
/** Cells in base64, bottom row first: 0 free, 100 occupied, 255 unknown. */
export interface NewMap { columns: number; rows: number; resolution_m: number; x_m: number; y_m: number; cells: string; warnings: string[]; markers: number }

export const readPlan = async (name: string, bytes: string, metresPerUnit: number | null): Promise<Plan> =>
  ({ ...await json<Omit<Plan, 'name'>>(request('PUT', '/api/new/plan', { name, bytes, metres_per_unit: metresPerUnit })), name });
export const makeMap = async (wanted: Record<string, unknown>): Promise<NewMap> => {
  const { map, ...more } = await json<{ map: Omit<NewMap, 'warnings' | 'markers'>; warnings: string[]; markers: number }>(request('PUT', '/api/new/map', wanted));
  return { ...map, ...more };
};
/** A drive whose scans can become a map. */
export interface ScannedRun { name: string; started: string | null; site: string | null; duration_s: number | null }
export const getScannedRuns = (): Promise<ScannedRun[]> => json(request('GET', '/api/new/runs'));
export const makeSite = (site: Record<string, unknown>): Promise<{ markers: number; uncovered_m2: number; why: string }> =>
  json(request('PUT', '/api/new/site', site));
/** While the server changes over nobody listens. */
export const isSiteThere = async (): Promise<boolean> =>
  request('GET', '/api/site').then(async (response) => !('new' in await response.json()), () => false);

export const getMap = (): Promise<MapInfo> => json(request('GET', '/api/map'));
export const getCells = async (): Promise<Int8Array> =>
  new Int8Array(await (await request('GET', '/api/map/cells')).arrayBuffer());

/** With the ETag that tells these cells from others. */
export interface TaggedCells { cells: Uint8Array; etag: string }
export async function getTaggedCells(): Promise<TaggedCells> {
  const response = await request('GET', '/api/map/cells');
  return { cells: new Uint8Array(await response.arrayBuffer()), etag: response.headers.get('ETag') ?? '' };
}
export const saveCells = (cells: Uint8Array, etag: string): Promise<Response> => request('PUT', '/api/map/cells', { cells: base64(cells) }, { 'If-Match': etag });
/** While the server loads the site anew nobody listens. */
export const isMapAnother = async (etag: string): Promise<boolean> => getTaggedCells().then((now) => now.etag !== etag, () => false);

export const getHeights = async (info: MapInfo): Promise<Heights | null> => info.heights
  ? { ...info.heights, bands: new Uint32Array(await (await request('GET', '/api/map/heights')).arrayBuffer()) } : null;
export const getDeviations = (registry: Registry): Promise<Deviations> =>
  json(request('POST', '/api/markers/deviations', registry));

export interface Tagged { registry: Registry; etag: string }

async function tagged(response: Response): Promise<Tagged> {
  return { registry: await response.json() as Registry, etag: response.headers.get('ETag') ?? '' };
}

export const getMarkers = async (): Promise<Tagged> => tagged(await request('GET', '/api/markers'));
export const putMarkers = async (registry: Registry, etag: string): Promise<Tagged> =>
  tagged(await request('PUT', '/api/markers', registry, { 'If-Match': etag }));
/** A warning may stand for a reason; without one it is a warning again. */
export const letStand = async ({ kind, ids, places_m }: Issue, reason: string): Promise<void> => {
  await request('PUT', '/api/accepted', { kind, ids, places_m, reason });
};
export const checkMarkers = (registry: Registry): Promise<Issue[]> =>
  json(request('POST', '/api/markers/check', registry));
export const exportMarkers = (format: string, registry: Registry): Promise<{ text: string }> =>
  json(request('POST', '/api/markers/export', { format, registry }));
export const importMarkers = (name: string, text: string): Promise<Registry> =>
  json(request('POST', '/api/markers/import', { name, text }));
/** The table of `lodestar markers plan`, as CSV. */
export const planOf = (registry: Registry): Promise<{ text: string }> => json(request('POST', '/api/markers/plan', registry));
export const printSheets = async (ids: number[], registry: Registry, paper: string): Promise<Blob> =>
  (await request('POST', '/api/markers/print', { ids, registry, paper })).blob();
/** A state of a document that was saved over: when (UTC), and by whom if that is known. */
export interface FormerState { number: number; at: string; by: string }
export const getHistory = (): Promise<FormerState[]> => json(request('GET', '/api/markers/history'));
export const getFormer = (number: number): Promise<Registry> => json(request('GET', `/api/markers/history/${number}`));

export interface Place { name: string; x_m: number; y_m: number; yaw_deg?: number }
export interface Routes { format: string; version: number; places: Place[]; routes: NamedMission[] }
export interface TaggedRoutes { routes: Routes; etag: string }

const taggedRoutes = async (response: Response): Promise<TaggedRoutes> =>
  ({ routes: await response.json() as Routes, etag: response.headers.get('ETag') ?? '' });
export const getRoutes = async (): Promise<TaggedRoutes> => taggedRoutes(await request('GET', '/api/routes'));
export const putRoutes = async (routes: Routes, etag: string): Promise<TaggedRoutes> =>
  taggedRoutes(await request('PUT', '/api/routes', routes, { 'If-Match': etag }));

/** Seconds, x and y in metres, yaw in degrees. */
export type Row = [number, number, number, number];
export interface Run {
  name: string; started: string | null; summary: Record<string, unknown>; map: Omit<MapInfo, 'heights'> | null; registry: Registry | null;
  estimate: Row[]; truth: Row[]; steps: number[][]; fixes: number[][]; pictures: string[];
}
/** Of a run without a report all but name, started and site are null: it is under way, or its program ended in the middle. */
export interface RunFacts {
  name: string; started: string | null; ended: string | null; site: string | null; goals: number | null; arrived: number | null; why: string | null;
  contacts: number | null; duration_s: number | null; driven_m: number | null; worst_error_mm: number | null; worst_3_sigma_mm: number | null;
}
export const getRuns = (): Promise<RunFacts[]> => json(request('GET', '/api/runs'));
export const getCellsOfRun = async (name: string): Promise<Int8Array> =>
  new Int8Array(await (await request('GET', `/api/runs/${encodeURIComponent(name)}/cells`)).arrayBuffer());
/** Of each square: x and y of its middle, worst 3 sigma (mm), worst error (mm), seconds without a marker, seconds of waiting. */
export type HeatSquare = [number, number, number, number | null, number, number];
export interface Heat { square_m: number; squares: HeatSquare[]; runs: number }
export const getHeat = (): Promise<Heat> => json(request('GET', '/api/heat'));
export interface LogEntry { at: string; by: string; what: string }
export const getLog = (): Promise<LogEntry[]> => json(request('GET', '/api/log'));
export const pictureOfRun = (run: string, picture: string): string => `/api/runs/${encodeURIComponent(run)}/pictures/${encodeURIComponent(picture)}`;
export const getRun = (name: string): Promise<Run> => json(request('GET', `/api/runs/${encodeURIComponent(name)}`));

export interface PlacesIssue { kind: string; severity: 'error' | 'warning'; words: string; positions_m: [number, number][] }
export interface TaggedPlaces { places: PlacesDocument; etag: string }
const taggedPlaces = async (response: Response): Promise<TaggedPlaces> =>
  ({ places: await response.json() as PlacesDocument, etag: response.headers.get('ETag') ?? '' });
export const getPlaces = async (): Promise<TaggedPlaces> => taggedPlaces(await request('GET', '/api/places'));
export const putPlaces = async (places: PlacesDocument, etag: string): Promise<TaggedPlaces> =>
  taggedPlaces(await request('PUT', '/api/places', places, { 'If-Match': etag }));
export const checkPlaces = (places: PlacesDocument): Promise<PlacesIssue[]> => json(request('POST', '/api/places/check', places));
export const getPlacesHistory = (): Promise<FormerState[]> => json(request('GET', '/api/places/history'));
export const getFormerPlaces = (number: number): Promise<PlacesDocument> => json(request('GET', `/api/places/history/${number}`));
