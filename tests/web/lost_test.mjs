// What is shown of a robot ends with the connection and with its program; what was typed does not.
import assert from 'node:assert/strict';
import { after, before, describe, test } from 'node:test';
import { labCopy, launch, open, serveRobotAt, serve } from './browser.mjs';
import { driveOff, goals, isIdle, leave, planned, setGoals, until, words } from './robot_page.mjs';

let browser;
before(async () => { browser = await launch(); });
after(() => browser?.close());

const stateIs = (page, text) => page.locator('#state', { hasText: text }).waitFor();
const marker = (page, id) => page.evaluate((wanted) => window.lodestar.marker(wanted), id);

describe('a robot', () => {
  test('whose program ends and starts again is shown anew, and never drives without a connection', async () => {
    const place = labCopy();
    const first = await serveRobotAt(place, '--realtime');
    const page = await open(browser, first.url);
    await until(page, isIdle);
    await driveOff(page);
    await setGoals(page, [2.5, 5]);
    await planned(page);
    await first.end();
    await until(page, () => document.getElementById('live-phase').textContent === 'No connection to the robot');
    assert.equal(await page.locator('#drive-go').isDisabled(), true);
    assert.match(await page.locator('#stale').textContent(), /No connection to the robot/);
    assert.doesNotMatch(await page.locator('body').innerText(), /driving/);

    const second = await serveRobotAt(place, '--realtime', '--port', new URL(first.url).port);
    await until(page, isIdle);
    await page.locator('#stale').waitFor({ state: 'hidden' });
    assert.match(await words(page), /waiting for a goal/);
    const shown = await page.evaluate(() => {
      const { live } = window.lodestar.console;
      const [times] = live.trace.columns;
      return { rises: times.every((t, i) => i === 0 || t > times[i - 1]), points: times.length, x: live.trace.track[0].x };
    });
    assert.ok(shown.rises && shown.points > 3, JSON.stringify(shown));
    assert.ok(shown.x < 2.5, `${shown.x}`);  // of the new start, not of the old drive
    assert.deepEqual(await goals(page), [[2.5, 5]]);
    await planned(page);  // anew
    await page.context().close();  // its complaints are of the connection that was cut
    await second.stop();
  });

  test('what was said of an error does not outlive the next command', async () => {
    const site = await serve();
    const page = await open(browser, site.url);
    await page.evaluate(() => { const { editor } = window.lodestar.console; editor.add([editor.fresh(447, 3, 3, 2.6, 0)]); });
    await page.keyboard.press('Control+s');
    await stateIs(page, 'twice');
    await page.locator('#tool-undo').click();
    assert.equal(await page.locator('#state').textContent(), '');
    await leave(page);
    await site.stop();
  });
});

describe('what was edited', () => {
  let site;
  before(async () => { site = await serve(); });
  after(() => site?.stop());
  const story = (name, run) => test(name, async () => {
    const page = await open(browser, site.url);
    await run(page);
    await leave(page);
  });

  story('survives a Reload that was not meant, and one that was by undo', async (page) => {
    await page.evaluate(() => { const { editor } = window.lodestar.console; editor.change([{ ...window.lodestar.marker(447), x: 5 }]); });
    await page.locator('#tool-reload').click();
    await page.getByRole('dialog').getByText(/447: x .* → 5 m/).waitFor();
    await page.getByRole('button', { name: 'Keep editing' }).click();
    assert.equal((await marker(page, 447)).x, 5);
    await page.locator('#tool-reload').click();
    await page.getByRole('button', { name: 'Throw away and reload' }).click();
    await stateIs(page, 'Reloaded');
    assert.notEqual((await marker(page, 447)).x, 5);
    await page.locator('#tool-undo').click();
    assert.equal((await marker(page, 447)).x, 5);
    await page.locator('#tool-redo').click();
  });

  story('survives a browser that dies', async (page) => {
    await page.evaluate(() => { const { editor } = window.lodestar.console; editor.change([{ ...window.lodestar.marker(447), x: 5 }]); });
    await page.waitForFunction(() => Object.keys(localStorage).some((key) => key.startsWith('lodestar-draft')), undefined, { polling: 50 });
    const again = await page.context().newPage();
    await again.goto(site.url);
    await again.getByRole('dialog').getByText(/447: x .* → 5 m/).waitFor();
    await again.reload();  // the question goes unanswered
    await again.getByRole('dialog').getByText(/447: x .* → 5 m/).waitFor();
    await again.keyboard.press('Escape');
    await stateIs(again, 'Brought');
    assert.equal((await marker(again, 447)).x, 5);
    await again.keyboard.press('Control+z');
    await again.waitForFunction(() => !Object.keys(localStorage).some((key) => key.startsWith('lodestar-draft')), undefined, { polling: 50 });
  });

  story('keeps its focus in the list, where arrows move no marker', async (page) => {
    const row = page.getByRole('button', { name: '447', exact: true });
    const before = await marker(page, 447);
    await row.focus();
    await page.keyboard.press('Enter');
    assert.equal(await page.evaluate(() => document.activeElement.textContent), '447');
    await page.keyboard.press('ArrowDown');
    assert.deepEqual(await marker(page, 447), before);
    await page.locator('#stage').focus();
    await page.keyboard.press('ArrowDown');
    assert.ok((await marker(page, 447)).y < before.y);
  });

  story('a row is chosen by the first click after a number was typed', async (page) => {
    await page.getByRole('button', { name: '447', exact: true }).click();
    await page.getByLabel('x (m)').fill('5.25');
    await page.getByRole('button', { name: '2357', exact: true }).click();
    assert.deepEqual(await page.evaluate(() => window.lodestar.console.editor.chosen().map((m) => m.id)), [2357]);
    assert.equal((await marker(page, 447)).x, 5.25);
  });

  story('a form stays open with its reason and its entries, and Enter agrees once', async (page) => {
    await page.getByRole('button', { name: '447', exact: true }).click();
    await page.locator('#tool-array').click();
    await page.locator('#ask-columns').fill('900');
    await page.locator('#ask-rows').fill('1');
    await page.keyboard.press('Enter');
    await page.locator('#dialog-reason', { hasText: 'Columns: wanted a number from 1 to 200' }).waitFor();
    assert.equal(await page.locator('#ask-rows').inputValue(), '1');
    await page.locator('#ask-columns').fill('2');
    await page.keyboard.press('Enter');
    await stateIs(page, 'Pasted 1 marker');
    assert.equal(await page.locator('#dialog').isVisible(), false);
  });

  story('a height that cannot be right is an issue that leads to its marker', async (page) => {
    await page.getByRole('button', { name: '447', exact: true }).click();
    await page.getByLabel('z (m)').fill('-3');
    await page.keyboard.press('Enter');
    await page.locator('[data-kind="implausible-height"].error', { hasText: 'marker 447' }).waitFor();
    await page.getByLabel('z (m)').fill('50');
    await page.keyboard.press('Enter');
    await page.locator('[data-kind="implausible-height"].warning', { hasText: 'higher than any ceiling' }).click();
    assert.deepEqual(await page.evaluate(() => window.lodestar.console.editor.chosen().map((m) => m.id)), [447]);
  });
});
