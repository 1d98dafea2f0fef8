// What tests do with a page that shows a robot.
import assert from 'node:assert/strict';

/** Waits for the robot to be in a state; `holds` sees the page's live view. */
export const until = (page, holds, what) => page.waitForFunction(holds, what, { polling: 50, timeout: 30_000 });
export const isIdle = () => { const s = window.lodestar?.console.live.state; return !!s && !s.moving && s.pose !== null && s.base_ready; };
export const isMoving = () => window.lodestar.console.live.state?.measured?.forward_mps > 0.15;
export const isAtRest = () => { const s = window.lodestar.console.live.state; return !s.moving && Math.abs(s.measured.forward_mps) < 0.005; };
export const goals = (page) => page.evaluate(() => window.lodestar.console.live.goals.list.map(({ x, y }) => [x, y]));
export const setGoals = (page, ...list) => page.evaluate((wanted) => window.lodestar.console.live.goals.set(wanted.map(([x, y, yawDeg]) => ({ x, y, yawDeg: yawDeg ?? null }))), list);
export const planned = (page) => page.locator('#preview-words', { hasText: /about \d+ s/ }).waitFor();
export const words = (page) => page.evaluate(() => document.getElementById('live-phase').textContent);

/** Where the robot is not yet: there and back again. */
let isThere = false;
export async function driveOff(page) {
  isThere = !isThere;
  await page.locator('#tool-live').click();
  await setGoals(page, isThere ? [5.4, 4.3] : [1.7, 5.6]);
  await planned(page);
  await page.getByRole('button', { name: 'Drive', exact: true }).click();
  await until(page, isMoving);
}

export async function leave(page) {
  assert.deepEqual(page.complaints, []);
  await page.context().close();
}
