// A survey under way: what is known of each marker, what ties them together, and where to drive next.
import { button, byId, el } from './dom.js';
import { font } from './fonts.js';
import { centerOf } from './geometry.js';
import type { Marker, Point } from './geometry.js';
import type { Editor } from './editor.js';
import { drawWay, ellipseOf, inkNow } from './robot_paint.js';
import type { Stage } from './stage.js';

export interface SurveyedMarker { id: number; x_m: number; y_m: number; yaw_deg: number; sigma_m: number | null; covariance_m2?: [number, number, number]; places: number }
export interface Proposal {
  id: number; change: 'moved' | 'swapped' | 'new' | 'gone'; x_m: number; y_m: number; dx_m: number; dy_m: number; dyaw_deg: number; sigma_m: number;
  marker: { id: number; x_m: number; y_m: number; z_m: number; yaw_deg: number };
}
export interface Survey {
  number: number; frames: number; on_map: boolean; target_m: number; markers: SurveyedMarker[]; links: [number, number, number][];
  path: [number, number][]; flaws: { flaw: string; found: string }[]; rare: number[]; unseen: number[];
  next: { x_m: number; y_m: number; ids: [number, number]; sigma_m: number } | null; proposals: Proposal[];
}

const magnified = 100;          // of the ellipses: millimetres on a map of metres
const blindGapM = 0.6;          // keyframes farther apart than this saw nothing between
const mm = (m: number): string => `${(1000 * m).toFixed(m < 0.01 ? 1 : 0)} mm`;
const point = ([x, y]: [number, number]): Point => ({ x, y });

export class SurveyView {
  survey: Survey | null = null;
  private readonly refused = new Set<string>();
  private listed = '';

  constructor(private readonly stage: Stage, private readonly editor: Editor,
    private readonly act: { goTo(at: Point): void; driveTo(at: Point): void; say(words: string): void }) {
    this.refresh();
  }

  set(survey: Survey): void {
    this.survey = survey;
    this.refresh();
    this.stage.redrawOverlay();
  }

  // -- the panel --------------------------------------------------------------------------------------------

  refresh(): void {
    const { survey } = this;
    if (!survey) return byId('survey').replaceChildren(el('p', {}, 'Nothing surveyed yet: drive under the markers.'));
    const sigmas = survey.markers.map((m) => m.sigma_m ?? Infinity);
    const good = sigmas.filter((sigma) => sigma <= survey.target_m).length;
    const rows: [string, string][] = [
      ['Markers', `${survey.markers.length}, ${good} of them known to ${mm(survey.target_m)}`],
      ['Worst', sigmas.length > 0 ? mm(Math.max(...sigmas)) : '-'],
      ['Frames', String(survey.frames)],
      ['On the map', survey.on_map ? 'by registered markers' : 'as if it had begun at the site\'s start'],
    ];
    byId('survey').replaceChildren(
      el('dl', {}, ...rows.flatMap(([name, words]) => [el('dt', {}, name), el('dd', {}, words)])),
      ...survey.flaws.map((f) => el('p', { class: 'error' }, `${f.flaw}: ${f.found}`)),
      ...this.missing(survey), ...this.nextWords(survey));
    this.listProposals(survey);
  }

  private missing(survey: Survey): HTMLElement[] {
    const list = (ids: number[]) => ids.slice(0, 12).join(', ') + (ids.length > 12 ? ` and ${ids.length - 12} more` : '');
    return [
      ...(survey.rare.length > 0 ? [el('p', {}, `Seen from one place only: ${list(survey.rare)}`)] : []),
      ...(survey.unseen.length > 0 ? [el('p', {}, `Registered, not seen yet: ${list(survey.unseen)}`)] : []),
    ];
  }

  private nextWords(survey: Survey): HTMLElement[] {
    const { next } = survey;
    if (!next) return [];
    if (next.sigma_m <= survey.target_m) return [el('p', { id: 'survey-next' }, 'Every marker is tied to its neighbours within the target.')];
    const at = { x: next.x_m, y: next.y_m };
    return [el('p', { id: 'survey-next' }, `Weakest link: ${next.ids[0]} to ${next.ids[1]}, ${mm(next.sigma_m)}. Drive across between them. `,
      button('Show', 'Show this place on the map', () => this.act.goTo(at)), ' ',
      button('Make it the goal', 'Set a goal there', () => this.act.driveTo(at)))];
  }

  private open(survey: Survey): Proposal[] {
    return survey.proposals.filter((p) => !this.refused.has(keyOf(p)) && !this.isApplied(p));
  }

  private listProposals(survey: Survey): void {
    const open = this.open(survey);
    const key = JSON.stringify(open);
    if (key === this.listed) return;
    this.listed = key;
    byId('proposals').replaceChildren(...(open.length === 0
      ? [el('p', {}, survey.on_map ? 'The registry agrees with what the robot sees.' : 'Comparing needs two registered markers that still hang in their places.')]
      : open.map((p) => el('div', { class: 'proposal' }, el('span', {}, wordsOf(p)),
        button('Accept', `Take over: ${wordsOf(p)}. Can be undone.`, () => this.accept(p)),
        button('Refuse', 'Leave the registry as it is', () => { this.refused.add(keyOf(p)); this.refresh(); this.stage.redrawOverlay(); })))));
  }

  private markerOf(id: number): Marker | undefined { return [...this.editor.markers.values()].find((m) => m.id === id); }

  private isApplied(p: Proposal): boolean {
    const now = this.markerOf(p.id);
    if (p.change === 'gone') return now === undefined;
    return now !== undefined && Math.hypot(now.x - p.marker.x_m, now.y - p.marker.y_m) < Math.max(0.002, 3 * p.sigma_m);
  }

  /** One step of the editor's history each. */
  private accept(p: Proposal): void {
    const now = this.markerOf(p.id);
    const at = this.editor.fresh(p.id, p.marker.x_m, p.marker.y_m, p.marker.z_m, p.marker.yaw_deg);
    if (p.change === 'gone') { if (now) this.editor.remove([now.key]); }
    else if (now) this.editor.change([this.editor.onMap({ ...at, key: now.key })]);
    else this.editor.add([at]);
    this.act.say(`${wordsOf(p)}: taken over; Save writes it, Undo takes it back`);
    this.listed = '';
    this.refresh();
  }

  // -- the map ----------------------------------------------------------------------------------------------

  paint(c: CanvasRenderingContext2D): void {
    const { survey, stage: { view } } = this;
    if (!survey) return;
    const colours = inkNow();
    this.paintWay(c, survey);
    const places = new Map(survey.markers.map((m) => [m.id, m]));
    c.save();
    for (const [a, b, count] of survey.links) {
      const from = places.get(a), to = places.get(b);
      if (!from || !to) continue;
      const p = view.toScreen(middleOf(from)), q = view.toScreen(middleOf(to));
      c.strokeStyle = colours.truth;
      c.globalAlpha = 0.55;
      c.lineWidth = Math.min(4, 1 + count / 10);
      c.beginPath();
      c.moveTo(p.x, p.y); c.lineTo(q.x, q.y);
      c.stroke();
    }
    c.restore();
    for (const marker of survey.markers) this.paintMarker(c, survey, marker);
    for (const p of this.open(survey)) this.paintProposal(c, p);
    if (survey.next && survey.next.sigma_m > survey.target_m) this.paintNext(c, { x: survey.next.x_m, y: survey.next.y_m });
  }

  /** Where the robot saw markers; stretches without any are dashed. */
  private paintWay(c: CanvasRenderingContext2D, survey: Survey): void {
    const { view } = this.stage;
    const colours = inkNow();
    let piece: Point[] = [];
    for (const at of survey.path.map(point)) {
      const last = piece.at(-1);
      if (last && Math.hypot(at.x - last.x, at.y - last.y) > blindGapM) {
        drawWay(c, view, piece, colours.track, 1.5);
        drawWay(c, view, [last, at], colours.goal, 2, [3, 5]);
        piece = [];
      }
      piece.push(at);
    }
    drawWay(c, view, piece, colours.track, 1.5);
  }

  private paintMarker(c: CanvasRenderingContext2D, survey: Survey, marker: SurveyedMarker): void {
    const { view } = this.stage;
    const middle = middleOf(marker);
    const p = view.toScreen(middle);
    const colours = inkNow();
    const colour = marker.sigma_m === null ? colours.stale : marker.sigma_m <= survey.target_m ? colours.path : marker.sigma_m <= 3 * survey.target_m ? colours.preview : colours.goal;
    c.save();
    c.strokeStyle = c.fillStyle = colour;
    c.lineWidth = 2;
    if (marker.covariance_m2) {
      const { long, short, yawRad } = ellipseOf(marker.covariance_m2, magnified);
      const most = 60;  // pixels: what is hardly known covers nothing else
      c.globalAlpha = 0.25;
      c.beginPath();
      c.ellipse(p.x, p.y, Math.min(most, Math.max(4, long * view.pixelsPerM)), Math.min(most, Math.max(4, short * view.pixelsPerM)), -yawRad + view.angleOf(0), 0, 2 * Math.PI);
      c.fill();
      c.globalAlpha = 1;
      c.stroke();
    }
    c.font = font(11);
    c.textAlign = 'center';
    c.fillText(`${marker.id}${marker.sigma_m === null ? '' : ` ±${mm(marker.sigma_m)}`}`, p.x, p.y - 12);
    c.restore();
  }

  private paintProposal(c: CanvasRenderingContext2D, p: Proposal): void {
    const { view } = this.stage;
    const to = view.toScreen({ x: p.x_m, y: p.y_m });
    const from = view.toScreen({ x: p.x_m - p.dx_m, y: p.y_m - p.dy_m });
    c.save();
    c.strokeStyle = c.fillStyle = inkNow().goal;
    c.lineWidth = 2.5;
    if (p.change === 'gone' || p.change === 'new') {
      c.strokeRect(to.x - 14, to.y - 14, 28, 28);
      if (p.change === 'gone') { c.beginPath(); c.moveTo(to.x - 14, to.y - 14); c.lineTo(to.x + 14, to.y + 14); c.moveTo(to.x + 14, to.y - 14); c.lineTo(to.x - 14, to.y + 14); c.stroke(); }
    } else {
      const angle = Math.atan2(to.y - from.y, to.x - from.x);
      const length = Math.max(30, Math.hypot(to.x - from.x, to.y - from.y));  // a few centimetres are to be seen, too
      const tip = { x: from.x + length * Math.cos(angle), y: from.y + length * Math.sin(angle) };
      c.beginPath();
      c.moveTo(from.x, from.y); c.lineTo(tip.x, tip.y);
      c.stroke();
      c.beginPath();
      c.moveTo(tip.x, tip.y);
      for (const side of [-0.4, 0.4]) c.lineTo(tip.x - 11 * Math.cos(angle + side), tip.y - 11 * Math.sin(angle + side));
      c.closePath();
      c.fill();
    }
    c.font = font(12, 'bold');
    c.fillText(wordsOf(p), to.x + 16, to.y + 16);
    c.restore();
  }

  private paintNext(c: CanvasRenderingContext2D, at: Point): void {
    const p = this.stage.view.toScreen(at);
    c.save();
    c.strokeStyle = c.fillStyle = inkNow().robot;
    c.lineWidth = 2;
    c.setLineDash([4, 3]);
    c.beginPath();
    c.arc(p.x, p.y, 16, 0, 2 * Math.PI);
    c.stroke();
    c.font = font(12, 'bold');
    c.fillText('drive here next', p.x + 20, p.y + 4);
    c.restore();
  }
}

const keyOf = (p: Proposal): string => `${p.id} ${p.change}`;

function wordsOf(p: Proposal): string {
  if (p.change === 'new') return `${p.id} is new`;
  if (p.change === 'gone') return `${p.id} is gone`;
  const turn = Math.abs(p.dyaw_deg) >= 0.1 ? `, ${p.dyaw_deg.toFixed(1)}°` : '';
  return `${p.id} ${p.change === 'swapped' ? 'was swapped,' : 'moved by'} ${mm(Math.hypot(p.dx_m, p.dy_m))}${turn} ± ${mm(p.sigma_m)}`;
}

const middleOf = (m: SurveyedMarker): Point => centerOf({ x: m.x_m, y: m.y_m, yawDeg: m.yaw_deg });
