// Missions drawn in the console, and driven from it: with waits, actions and repetitions.
import assert from 'node:assert/strict';
import { appendFileSync, chmodSync, existsSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, describe, test } from 'node:test';
import { labCopy, launch, open, serveRobotAt } from './browser.mjs';
import { isIdle, leave, until } from './robot_page.mjs';

const pictures = process.env.LODESTAR_PICTURES;
let browser, robot, place;

before(async () => {
  place = labCopy();
  appendFileSync(join(place.site, 'site.yaml'), 'actions:\n  - {type: pick, run: [./pick], timeout_s: 10}\n');
  writeFileSync(join(place.site, 'pick'), '#!/bin/sh\ncat >> picked\necho taken\n');
  chmodSync(join(place.site, 'pick'), 0o755);
  writeFileSync(join(place.site, 'places.yaml'), 'format: lodestar-places\nversion: 1\nplaces:\n  - {name: shelf, x_m: 2.2, y_m: 5.2}\n  - {name: desk, x_m: 1.6, y_m: 5.6}\n');
  robot = await serveRobotAt(place, '--realtime');
  browser = await launch();
});
after(async () => {
  await browser?.close();
  await robot?.stop();
});

describe('missions', () => {
  test('are made of places, with what is done at each stop, by undoable steps', async () => {
    const page = await open(browser, robot.url);
    await page.locator('#tool-places').click();
    await page.locator('#mission-new').click();
    await page.locator('#mission-name').fill('round');
    await page.keyboard.press('Tab');
    await page.locator('#mission-wait-0').fill('-1');
    await page.keyboard.press('Tab');
    await page.locator('#mission-reason', { hasText: 'A wait is 0 to 86400 seconds; it keeps what it had' }).waitFor();
    await page.locator('#mission-wait-0').fill('2');
    await page.keyboard.press('Tab');
    await page.locator('#mission-action-1').selectOption('pick');
    await page.locator('#mission-repeat').fill('2');
    await page.keyboard.press('Tab');
    const row = page.locator('#place-missions li button').first();
    assert.equal(await row.innerText(), 'round: shelf (2 s) → desk (pick), 2 times');
    await page.locator('#mission-up-1').click();
    assert.equal(await row.innerText(), 'round: desk (pick) → shelf (2 s), 2 times');
    await page.locator('#tool-places-undo').click();
    assert.equal(await row.innerText(), 'round: shelf (2 s) → desk (pick), 2 times');
    if (pictures) await page.screenshot({ path: join(pictures, 'missions.png') });
    await page.locator('#tool-places-save').click();
    await page.locator('#state', { hasText: 'Saved' }).waitFor();
    assert.match(readFileSync(join(place.site, 'places.yaml'), 'utf8'),
      /\{name: "round", stops: \[\{place: "shelf", wait_s: 2\}, \{place: "desk", action: "pick"\}\], repeat: 2\}/);
    await leave(page);
  });

  test('are driven from the live view: the robot waits, has the action carried out, and begins again', async () => {
    const page = await open(browser, robot.url);
    await until(page, isIdle);
    await page.locator('#places').getByRole('button', { name: 'round: shelf (2 s) → desk (pick), 2 times', exact: true }).click();
    await page.locator('#preview-words', { hasText: /about \d+ s/ }).waitFor();
    await page.getByRole('button', { name: 'Drive', exact: true }).click();
    await until(page, () => window.lodestar.console.live.state.phase === 'at a stop of the mission');
    assert.equal((await page.evaluate(() => window.lodestar.console.live.state.goals.length)), 4);
    await page.waitForFunction(() => window.lodestar.console.live.state.events.some((e) => e.words.includes('goal 4: arrived')), undefined, { polling: 50, timeout: 120_000 });
    assert.ok(existsSync(join(place.site, 'picked')));
    assert.equal(readFileSync(join(place.site, 'picked'), 'utf8').match(/"actionType":"pick"/g).length, 2);
    await leave(page);
  });

  test('with an action that the site has no program for cannot be saved', async () => {
    const page = await open(browser, robot.url);
    const answer = await page.evaluate(async () => {
      const { headers } = await fetch('/api/places');
      const body = await (await fetch('/api/places')).json();
      body.missions = [{ name: 'odd', stops: [{ place: 'desk', action: 'juggle' }] }];
      const put = await fetch('/api/places', { method: 'PUT', body: JSON.stringify(body), headers: { 'Content-Type': 'application/json', 'X-Lodestar': '1', 'If-Match': headers.get('ETag') } });
      return [put.status, (await put.json()).error];
    });
    assert.equal(answer[0], 422);
    assert.match(answer[1], /found the action 'juggle' in mission 'odd'/);
    await page.context().close();
  });
});
