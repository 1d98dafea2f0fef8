// Stop stops: from any focus, in every mode, on a small screen, and whatever the server is asked for.
import assert from 'node:assert/strict';
import { after, before, describe, test } from 'node:test';
import { launch, open, serveRobot } from './browser.mjs';
import { driveOff, goals, isAtRest, isIdle, leave, planned, setGoals, until } from './robot_page.mjs';

const [all, view] = ['drive-drive-drive-drive', 'look-look-look-look-look'];
let browser;
let robot;
before(async () => {
  browser = await launch();
  robot = await serveRobot('--realtime', '--token', all, '--view-token', view);
});
after(async () => {
  await browser?.close();
  await robot?.stop();
});

async function driver(size) {
  const page = await open(browser, `${robot.url}#t=${all}`, size);
  await until(page, isIdle);
  return page;
}

const orders = (page) => page.evaluate(() => window.lodestar.console.live.state.events.filter((e) => e.words.includes('go to')).length);

describe('the space bar', () => {
  test('stops the robot after Drive was clicked, and does not press Drive again', async () => {
    const page = await driver();
    await driveOff(page);
    const before = await orders(page);
    assert.equal(await page.evaluate(() => document.activeElement.id), 'drive-go');
    await page.keyboard.press(' ');
    await until(page, isAtRest);
    assert.equal(await orders(page), before);
    await leave(page);
  });

  const elsewhere = [
    ['a button of the editor', async (page) => { await page.locator('#tool-edit').click(); await page.locator('#tool-fit').focus(); }],
    ['a checkbox, which it leaves as it is', async (page) => { await page.locator('#tool-edit').click(); await page.locator('#layer-map').focus(); }],
    ['a number', async (page) => { await page.locator('#tool-live').click(); await page.locator('#goal-list input').first().focus(); }],
    ['the time bar of a replay', async (page) => { await page.locator('#tool-replay').click(); await page.locator('#tool-replay').focus(); }],
    ['a dialog', async (page) => { await page.locator('#stage').focus(); await page.keyboard.press('?'); await page.getByRole('dialog').waitFor(); }],
  ];
  for (const [where, go] of elsewhere) {
    test(`stops it from ${where}`, async () => {
      const page = await driver();
      await driveOff(page);
      await go(page);
      await page.keyboard.press(' ');
      await until(page, isAtRest);
      assert.equal(await page.locator('#layer-map').isChecked(), true);
      await leave(page);
    });
  }

  test('is text in a text field, and a stop again after Escape', async () => {
    const page = await driver();
    await driveOff(page);
    await page.locator('#my-name').fill('Ada');
    await page.locator('#my-name').press(' ');
    assert.equal(await page.locator('#my-name').inputValue(), 'Ada ');
    assert.equal(await page.evaluate(() => window.lodestar.console.live.state.moving), true);
    await page.keyboard.press('Escape');
    await page.keyboard.press(' ');
    await until(page, isAtRest);
    await leave(page);
  });
});

describe('the button', () => {
  test('is large and free at 390 pixels in every mode, and in a dialog', async () => {
    const page = await driver({ width: 390, height: 844 });
    const pressable = (selector) => page.evaluate((s) => {
      const box = document.querySelector(s).getBoundingClientRect();
      const top = document.elementFromPoint(box.x + box.width / 2, box.y + box.height / 2);
      return box.height >= 60 && box.right <= innerWidth && box.bottom <= innerHeight && top === document.querySelector(s);
    }, selector);
    for (const mode of ['edit', 'live', 'replay']) {
      await page.locator(`#tool-${mode}`).click();
      await page.waitForTimeout(200);
      assert.ok(await pressable('#live-stop'), mode);
    }
    await driveOff(page);
    await page.locator('#tool-edit').click();
    await page.locator('#live-stop').click();
    await until(page, isAtRest);
    await driveOff(page);
    await page.locator('#stage').focus();
    await page.keyboard.press('?');
    await page.locator('dialog .stop').click();
    await until(page, isAtRest);
    await leave(page);
  });

  test('acts at once while viewers and editors ask for the most that can be asked', async () => {
    const page = await driver();
    const hostile = await open(browser, `${robot.url}#t=${view}`);
    const editor = await open(browser, `${robot.url}#t=${all}`);
    await hostile.evaluate(() => {
      const targets = ['/api/runs', '/api/runs/run', '/api/site', '/api/map/cells', '/api/markers', '/api/markers/history'];
      window.asked = 0;
      for (let i = 0; i < 12; ++i) {
        const next = () => fetch(targets[i % targets.length], { cache: 'no-store' }).then((r) => r.arrayBuffer()).then(() => { ++window.asked; return next(); }).catch(() => {});
        void next();
      }
    });
    await editor.evaluate(() => {
      const markers = [];
      for (let i = 0; i < 4000; ++i) markers.push({ id: i, x_m: 0.15 * (i % 100), y_m: 0.17 * Math.floor(i / 100), z_m: 2.6, yaw_deg: i % 360 });
      const registry = { alignment: { x_m: 0, y_m: 0, yaw_deg: 0 }, markers };
      for (const what of ['check', 'deviations']) {
        void fetch(`/api/markers/${what}`, { method: 'POST', headers: { 'Content-Type': 'application/json', 'X-Lodestar': '1' }, body: JSON.stringify(registry) }).catch(() => {});
      }
    });
    await driveOff(page);
    const tookMs = [];
    for (let i = 0; i < 5; ++i) {
      tookMs.push(await page.evaluate(() => new Promise((done) => {
        const { live } = window.lodestar.console;
        const heard = live.onState.bind(live);
        const from = performance.now();
        live.onState = (state) => {
          if (state.events.some((e) => e.words.endsWith('stop') && e.number > last)) { live.onState = heard; done(performance.now() - from); }
          heard(state);
        };
        const last = live.state.events.at(-1).number;
        live.stop();
      })));
    }
    tookMs.sort((a, b) => a - b);
    console.log(`a stop was seen to act after ${tookMs.map((ms) => ms.toFixed(0)).join(', ')} ms`);
    assert.ok(tookMs[2] < 2000, `${tookMs}`);  // 33 s when requests held the robot's turn; the figure itself is printed, machines differ
    await until(page, isAtRest);
    assert.ok(await hostile.evaluate(() => window.asked) > 0);
    for (const other of [hostile, editor]) await other.context().close();
    await leave(page);
  });
});

describe('the wheel', () => {
  test('is free again after the robot was placed', async () => {
    const page = await driver();
    const other = await driver();
    const { pose } = await page.evaluate(() => window.lodestar.console.live.state);
    await setGoals(page, [pose.x_m, pose.y_m, pose.yaw_deg]);
    await page.locator('#drive-place:enabled').click();
    await until(page, () => window.lodestar.console.live.state.events.some((e) => e.words.includes('set pose to')));
    await setGoals(other, [2.5, 5]);
    await planned(other);
    await other.locator('#drive-go:enabled').waitFor();
    assert.equal(await other.evaluate(() => window.lodestar.console.live.state.driver), null);
    await leave(other);
    await leave(page);
  });

  test('names its holder, can be asked for, and is handed over without a stop', async () => {
    const page = await driver();
    const other = await driver();
    await page.locator('#my-name').fill('Ada');
    await page.locator('#my-name').press('Enter');
    await driveOff(page);
    await other.locator('#drive-why', { hasText: /Ada \(client \d+\) is at the wheel/ }).waitFor();
    await other.locator('#ask-wheel').click();
    await page.locator('#keep-wheel').click();
    await other.locator('#state', { hasText: /Ada.* keeps control/ }).waitFor();
    await other.locator('#ask-wheel').click();
    await page.locator('#hand-over').click();
    await until(other, () => window.lodestar.console.live.atWheel);
    assert.equal(await other.evaluate(() => window.lodestar.console.live.state.paused), false);
    await page.waitForTimeout(3500);  // longer than the lease: it is renewed by the other now
    assert.equal(await other.evaluate(() => window.lodestar.console.live.state.paused), false);
    await other.keyboard.press(' ');
    await until(other, isAtRest);
    await leave(other);
    await leave(page);
  });
});

describe('goals', () => {
  test('set during a drive are there after it, planned from where the robot is', async () => {
    const page = await driver();
    await until(page, isIdle);
    const { pose } = await page.evaluate(() => window.lodestar.console.live.state);
    const aside = pose.x_m > 3 ? -0.4 : 0.4;
    await setGoals(page, [pose.x_m + aside, pose.y_m]);
    await planned(page);
    await page.getByRole('button', { name: 'Drive', exact: true }).click();
    await until(page, () => window.lodestar.console.live.state.moving);
    await setGoals(page, [2.5, 5]);
    await until(page, isIdle);
    await until(page, () => window.lodestar.console.live.state.driver === null);
    assert.deepEqual(await goals(page), [[2.5, 5]]);
    await planned(page);
    await page.locator('#drive-go:enabled').waitFor();
    await leave(page);
  });

  test('are set by clicks after Align was left for Live, and Escape ends measuring there', async () => {
    const page = await driver();
    await page.locator('#tool-edit').click();
    await page.locator('#tool-align').click();
    await page.locator('#tool-live').click();
    const box = await page.locator('#stage').boundingBox();
    await page.mouse.click(box.x + box.width / 2, box.y + box.height / 2);
    assert.equal((await goals(page)).length, 1);
    await page.keyboard.press('t');
    await page.mouse.click(box.x + box.width / 2 + 60, box.y + box.height / 2);
    await page.keyboard.press('Escape');
    assert.equal(await page.evaluate(() => window.lodestar.console.measure.on), false);
    await page.mouse.click(box.x + box.width / 2 + 40, box.y + box.height / 2 + 20, { modifiers: [] });
    assert.equal((await goals(page)).length, 1);
    await leave(page);
  });

  test('by numbers have their fields at once', async () => {
    const page = await driver();
    await page.locator('#goal-numbers').click();
    await page.keyboard.type('2.5');  // over the x that is there
    await page.keyboard.press('Enter');
    assert.equal((await goals(page))[0][0], 2.5);
    await page.getByLabel('Goal 1, y in metres').fill('five');
    await page.keyboard.press('Enter');
    await page.locator('.goal-row .error', { hasText: "'five' is not a number" }).waitFor();
    await leave(page);
  });
});
