// Summary of a run, in words and numbers.
import type { Run } from './api.js';
import { byId, el } from './dom.js';
import { shortTime } from './when.js';

interface GoalFacts { x_m: number; y_m: number; heading_deg: number | null; arrived: boolean; failure: string; travel_time_s: number; position_error_m: number | null }
interface Facts { camera?: string; seed?: number; repeat?: string; contacts?: number; nees?: number | null; goals?: GoalFacts[] }

/** `over`: what it is drawn over, where that needs words. */
export function showSummary(run: Run, over: string): void {
  const facts = run.summary as Facts;
  const rows: [string, string][] = [...(run.started ? [['Started', shortTime(run.started)] as [string, string]] : []), ['Camera', facts.camera ?? '-'], ['Seed', String(facts.seed ?? '-')]];
  if (run.truth.length > 0) rows.push(['Contacts', String(facts.contacts ?? '-')], ['NEES (3: consistent)', facts.nees?.toFixed(2) ?? '-']);
  byId('run-facts').replaceChildren(el('dl', {}, ...rows.flatMap(([name, words]) => [el('dt', {}, name), el('dd', {}, words)])),
    el('p', { class: 'faint' }, facts.repeat ?? ''), ...(over === '' ? [] : [el('p', { id: 'run-over' }, over)]));
  byId('run-goals').replaceChildren(el('ul', { class: 'plain' }, ...(facts.goals ?? []).map(goalLine)));
}

function goalLine(goal: GoalFacts): HTMLElement {
  const place = `${goal.x_m.toFixed(2)}, ${goal.y_m.toFixed(2)} m`;
  if (!goal.arrived) return el('li', { class: 'error' }, `${place}: not reached: ${goal.failure || 'never started'}`);
  const error = goal.position_error_m === null ? '' : `, ${(1000 * goal.position_error_m).toFixed(1)} mm off`;
  return el('li', { class: 'fine' }, `${place}: reached after ${goal.travel_time_s.toFixed(1)} s${error}`);
}
