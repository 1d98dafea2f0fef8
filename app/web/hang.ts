// Ladder mode, for a phone: which marker comes next, how far from which walls, and what hangs already. The robot's reading of
// a marker that hangs verifies it.
import * as api from './api.js';
import type { HangingMarker, HangingState } from './api.js';
import { button, byId, el } from './dom.js';
import { pitchM, sideM } from './geometry.js';
import type { Point } from './geometry.js';
import type { Live } from './live.js';
import type { Guest } from './pointer.js';
import type { Stage } from './stage.js';
import { attempt, complain } from './words.js';

const lookEveryMs = 500;
const longestPhotoPx = 1600;
const inks: Record<HangingState, string> = { planned: '#8a94a3', hung: '#c77700', verified: '#1d6b34' };

/** Of two opposite walls the nearer one. */
function nearer(low: string, lowM: number | null, high: string, highM: number | null): string {
  if (lowM === null && highM === null) return '';
  const isLow = lowM !== null && (highM === null || lowM <= highM);
  return `${(isLow ? lowM : highM!).toFixed(3)} m from the wall ${isLow ? low : high}`;
}

/** A photo as the server keeps it: smaller, as JPEG, in base64. */
async function smallJpeg(file: File): Promise<string> {
  const image = await createImageBitmap(file);
  const scale = Math.min(1, longestPhotoPx / Math.max(image.width, image.height));
  const canvas = el('canvas');
  [canvas.width, canvas.height] = [Math.round(image.width * scale), Math.round(image.height * scale)];
  canvas.getContext('2d')!.drawImage(image, 0, 0, canvas.width, canvas.height);
  return canvas.toDataURL('image/jpeg', 0.8).split(',')[1]!;
}

export class Hang implements Guest {
  markers: HangingMarker[] = [];
  private now: number | null = null;  // the ID of the marker that is shown
  private shown = false;
  private busy = false;
  private taken = Date.now();  // tells a new photo from the one before
  private readonly photo = el('input', { id: 'hang-photo', type: 'file', accept: 'image/*', capture: 'environment', hidden: '', 'aria-label': 'Photo of the marker' });

  constructor(private readonly stage: Stage, private readonly live: Live) {
    stage.painters.push((c) => { if (this.shown) this.paint(c); });
    this.photo.addEventListener('change', () => attempt(() => this.keepPhoto()));
    document.body.append(this.photo);
    setInterval(() => { if (this.shown) this.look(); }, lookEveryMs);
  }

  show(shown: boolean): void {
    this.shown = shown;
    if (shown) attempt(() => this.load());
  }

  private async load(): Promise<void> { this.take(await api.getHanging()); }

  private take(markers: HangingMarker[]): void {
    this.markers = markers;
    if (!markers.some((marker) => marker.id === this.now)) this.now = this.next()?.id ?? markers[0]?.id ?? null;
    this.refresh();
  }

  private get current(): HangingMarker | undefined { return this.markers.find((marker) => marker.id === this.now); }

  /** The nearest one that does not hang; at first the one nearest to a corner, so that nobody walks to and fro. */
  private next(): HangingMarker | undefined {
    const from = this.current ?? { x_m: Math.min(...this.markers.map((m) => m.x_m)), y_m: Math.max(...this.markers.map((m) => m.y_m)) };
    const apart = (m: HangingMarker) => Math.hypot(m.x_m - from.x_m, m.y_m - from.y_m);
    return this.markers.filter((m) => m.state === 'planned' && m.id !== this.now).sort((a, b) => apart(a) - apart(b))[0];
  }

  private choose(id: number): void {
    this.now = id;
    this.refresh();
  }

  private async set(id: number, state: HangingState, by = this.live.control.name): Promise<void> {
    this.take(await api.setHanging(id, state, by));
  }

  private async hung(): Promise<string> {
    const { current } = this;
    if (!current) return '';
    await this.set(current.id, 'hung');
    const next = this.next();
    if (next) this.choose(next.id);
    return `Marker ${current.id} hangs${next ? `; next is ${next.id}` : '; all of them do'}`;
  }

  private async keepPhoto(): Promise<string | void> {
    const file = this.photo.files?.[0];
    if (!file || this.now === null) return;
    ++this.taken;
    this.take(await api.keepPhoto(this.now, await smallJpeg(file)));
    this.photo.value = '';
    return `The photo of marker ${this.now} is kept`;
  }

  /** A robot that reads what hangs has verified it; it may be any of them. */
  private look(): void {
    const read = this.markers.find((marker) => marker.state === 'hung' && this.live.readsNow(marker.id));
    if (read && !this.busy && this.live.mayEdit) {
      this.busy = true;
      this.set(read.id, 'verified', 'the robot').catch(complain).finally(() => { this.busy = false; });
    }
    this.showReading();
  }

  // -- what is shown --------------------------------------------------------------------------------------------

  private refresh(): void {
    const count = (state: HangingState) => this.markers.filter((marker) => marker.state === state).length;
    const { current } = this;
    byId('hang').replaceChildren(...(this.markers.length === 0
      ? [el('p', {}, 'No markers are saved yet: place them under Markers, and save.')]
      : [el('p', { id: 'hang-progress', role: 'status' }, `${count('hung') + count('verified')} of ${this.markers.length} hang, ${count('verified')} verified`),
        ...(current ? this.card(current) : [])]));
    this.showReading();
    this.stage.redrawOverlay();
  }

  private card(marker: HangingMarker): HTMLElement[] {
    const { walls } = marker;
    const ways = [nearer('on the left', walls.left, 'on the right', walls.right), nearer('below', walls.below, 'above', walls.above)].filter((words) => words !== '');
    if (ways.length === 0) ways.push(`above something that the map has: ${marker.x_m.toFixed(3)}, ${marker.y_m.toFixed(3)} m on the map`);
    const said = marker.state === 'planned' ? 'Does not hang yet' : `${marker.state === 'hung' ? 'Hangs' : 'Verified'}${marker.by === '' ? '' : ` (${marker.by})`}, ${marker.at.replace('T', ' ').replace('Z', ' UTC')}`;
    const act = (text: string, title: string, id: string, action: () => Promise<string | void>, more: Record<string, string> = {}) => button(text, title, () => attempt(action), { id, ...more });
    const acts = marker.state === 'planned'
      ? [act('Hung', 'It hangs; the nearest of the others is next', 'hang-hung', () => this.hung(), { class: 'main' })]
      : [act('Not hung', 'It does not hang after all', 'hang-undo', () => this.set(marker.id, 'planned')),
        ...(marker.state === 'hung' ? [act('Verified', 'It hangs where the plan has it: measured by hand', 'hang-verify', () => this.set(marker.id, 'verified'))] : [])];
    return [el('h3', { id: 'hang-id' }, `Marker ${marker.id}`),
      el('ul', { class: 'hang-ways' }, ...ways.map((words) => el('li', {}, words)), el('li', {}, `${marker.z_m.toFixed(2)} m above the floor, face down`),
        el('li', {}, `arrow at ${Math.round(marker.yaw_deg)}° on the map (0° is to its right, 90° up)`)),
      el('p', {}, said), el('p', { id: 'hang-reading', role: 'status' }),
      el('div', { class: 'row big' }, ...acts, button('Photo', 'A photo of it, kept with the site', () => this.photo.click(), { id: 'hang-take' }),
        button('Next', 'The nearest one that does not hang', () => { const next = this.next(); if (next) this.choose(next.id); }, { id: 'hang-next' })),
      ...(marker.photo ? [el('img', { class: 'hang-photo', alt: `Photo of marker ${marker.id}`, src: `/api/hanging/${marker.id}.jpg?${this.taken}` })] : [])];
  }

  private showReading(): void {
    const place = document.getElementById('hang-reading');
    if (!place || this.now === null) return;
    const reads = this.live.readsNow(this.now);
    place.textContent = this.live.hello?.robot !== true ? '' : reads ? 'The robot reads it now.' : 'The robot does not see it from where it stands.';
    place.className = reads ? 'fine' : 'faint';
  }

  private paint(c: CanvasRenderingContext2D): void {
    const radius = Math.max(12, 0.8 * (sideM + pitchM) * this.stage.view.pixelsPerM);  // px, around the plate
    for (const marker of this.markers) {
      const at = this.stage.view.toScreen({ x: marker.x_m, y: marker.y_m });
      c.beginPath();
      c.arc(at.x, at.y, radius, 0, 2 * Math.PI);
      c.lineWidth = marker.id === this.now ? 5 : 2.5;
      c.strokeStyle = inks[marker.state];
      c.setLineDash(marker.state === 'planned' ? [4, 4] : []);
      c.stroke();
      c.setLineDash([]);
      if (marker.state !== 'verified') continue;
      c.beginPath();
      c.moveTo(at.x + radius - 4, at.y - radius);
      c.lineTo(at.x + radius, at.y - radius + 5);
      c.lineTo(at.x + radius + 7, at.y - radius - 6);
      c.stroke();
    }
  }

  press(): boolean { return false; }
  drag(): void {}
  release(): void {}
  click(at: Point): void {
    const apart = (marker: HangingMarker) => Math.hypot(marker.x_m - at.x, marker.y_m - at.y);
    const nearest = [...this.markers].sort((a, b) => apart(a) - apart(b))[0];
    if (nearest) this.choose(nearest.id);
  }
}
