// Former runs: the list, the map and markers that each was driven on, what happened, two beside each other, links, heat; and
// who saved what before.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { cpSync, mkdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, describe, test } from 'node:test';
import { axeSource, labCopy, launch, open, serveSite } from './browser.mjs';
import { binary } from './programs.mjs';

const pictures = process.env.LODESTAR_PICTURES;
let browser, server, place;

const drive = (name, ...options) => {
  try {
    execFileSync(binary, ['replay', place.site, '--quiet', '-o', join(place.folder, 'runs', name), ...options], { stdio: 'ignore' });
  } catch (error) {
    assert.equal(error.status, 1, `${name} ended with ${error.status}`);  // a goal that was not reached is no fault of the test
  }
};

before(async () => {
  place = labCopy();
  drive('plain', '--goal', '4.3,5.4', '--seed', '3', '--pictures', '1');
  drive('pushed', '--goal', '4.3,5.4', '--seed', '4', '--remove-markers', '0.7', '--plain-ceiling');
  drive('waiting', '--goal', '7.2,5.6', '--seed', '5', '--people', '8', '--people-kind', 'threatening');
  mkdirSync(join(place.folder, 'runs', 'killed'));
  cpSync(join(place.folder, 'runs', 'plain', 'run.yaml'), join(place.folder, 'runs', 'killed', 'run.yaml'));
  cpSync(join(place.folder, 'runs', 'plain'), join(place.folder, 'runs', 'older'), { recursive: true });
  rmSync(join(place.folder, 'runs', 'older', 'site'), { recursive: true });
  rmSync(join(place.folder, 'runs', 'older', 'run.yaml'));
  server = await serveSite(place);
  browser = await launch();
});
after(async () => {
  await browser?.close();
  await server?.stop();
});

const until = (page, condition, argument) => page.waitForFunction(condition, argument, { polling: 50 });
const opened = (page, name) => until(page, (n) => window.lodestar.console.replay.run?.name === n, name);
const line = (page, name) => page.locator('#run-list li').filter({ has: page.locator('strong', { hasText: new RegExp(`^${name}$`) }) });
const look = (page, name) => pictures ? page.screenshot({ path: join(pictures, `runs-${name}.png`) }) : Promise.resolve();

async function replaying(name, hash = '', more = {}) {
  const page = await open(browser, server.url + hash, { width: 1280, height: 800 }, more);
  if (hash === '') {
    await page.locator('#tool-replay').click();
    await line(page, name).getByRole('button').first().click();
  }
  await opened(page, name);
  return page;
}

async function leave(page) {
  assert.deepEqual(page.complaints, []);
  await page.context().close();
}

describe('runs', () => {
  test('are listed with date, outcome, duration and worst error', async () => {
    const page = await replaying('plain');
    const summary = JSON.parse(readFileSync(join(place.folder, 'runs', 'plain', 'summary.json'), 'utf8'));
    const words = await line(page, 'plain').innerText();
    assert.match(words, /reached 1 goal/);
    assert.ok(words.includes(`${(1000 * summary.estimate_position_error_m.max).toFixed(1)} mm off at worst`), words);
    assert.ok(words.includes(`${summary.duration_s.toFixed(1)} s`), words);
    const today = new Date().toLocaleString('en-GB', { day: 'numeric', month: 'short' });
    assert.ok(words.includes(today), `${words} without ${today}`);
    assert.match(await line(page, 'killed').innerText(), /no report/);
    assert.equal(await line(page, 'killed').getByRole('button').first().isDisabled(), true);
    await page.getByLabel('Filter the runs').fill('wait');
    assert.equal(await page.locator('#run-list li').count(), 1);
    await look(page, 'list');
    await leave(page);
  });

  test('are drawn over the map and the markers that they were driven on', async () => {
    const page = await replaying('plain');
    const before = await page.evaluate(() => window.lodestar.console.stage.scene.markers.find((m) => m.id === 447));
    assert.equal(await page.locator('#run-over').count(), 0, 'nothing has changed yet');
    await page.locator('#tool-edit').click();
    await page.evaluate(() => { const { editor } = window.lodestar.console; editor.change([{ ...window.lodestar.marker(447), x: 9.9 }]); });
    await page.locator('#tool-replay').click();
    await until(page, () => window.lodestar.console.replay.run !== null);
    await line(page, 'plain').getByRole('button').first().click();
    await opened(page, 'plain');
    await page.locator('#run-over', { hasText: 'Changed since then: one marker' }).waitFor();
    assert.deepEqual((await page.evaluate(() => window.lodestar.console.stage.scene.markers.find((m) => m.id === 447))).x, before.x);
    await line(page, 'older').getByRole('button').first().click();
    await opened(page, 'older');
    await page.locator('#run-over', { hasText: 'drawn over today' }).waitFor();
    assert.equal(await page.evaluate(() => window.lodestar.console.stage.scene), null);
    await page.locator('#tool-edit').click();
    assert.equal((await page.evaluate(() => window.lodestar.marker(447))).x, 9.9, 'the editor keeps what was not saved');
    await leave(page);
  });

  test('over another map are drawn with its walls', async () => {
    const map = readFileSync(join(place.folder, 'runs', 'plain', 'site', 'map.yaml'), 'utf8');
    cpSync(join(place.folder, 'runs', 'plain'), join(place.folder, 'runs', 'rebuilt'), { recursive: true });
    writeFileSync(join(place.folder, 'runs', 'rebuilt', 'site', 'map.yaml'), map.replace(/resolution: .*/, 'resolution: 0.2'));
    const page = await replaying('plain');
    await line(page, 'rebuilt').getByRole('button').first().click();
    await opened(page, 'rebuilt');
    await page.locator('#run-over', { hasText: 'the map' }).waitFor();
    assert.equal(await page.evaluate(() => window.lodestar.console.stage.scene.floor !== window.lodestar.console.stage.floorPaint), true);
    await page.locator('#tool-live').click();
    assert.equal(await page.evaluate(() => window.lodestar.console.stage.scene), null);
    rmSync(join(place.folder, 'runs', 'rebuilt'), { recursive: true });
    await leave(page);
  });

  test('tell what happened and when: a click goes there, and the link leads there again', async () => {
    const page = await replaying('waiting');
    const events = page.locator('#run-events button');
    assert.ok(await events.count() > 0, await page.locator('#run-events').innerText());
    await events.last().click();
    const time = await page.evaluate(() => window.lodestar.console.replay.time);
    assert.match(page.url(), /#run=waiting&at=[\d.]+$/);
    await look(page, 'events');
    const again = await replaying('waiting', new URL(page.url()).hash);
    await until(again, (t) => Math.abs(window.lodestar.console.replay.time - t) < 0.011, time);
    await again.locator('#tool-edit').click();
    assert.doesNotMatch(again.url(), /#/);
    await leave(again);
    await leave(page);
  });

  test('chosen one after the other show the last, whichever answer comes first; chosen again, a run stays at its time', async () => {
    const page = await replaying('plain');
    const held = [];
    await page.route('**/api/runs/waiting', async (route) => { await new Promise((go) => held.push(go)); await route.continue(); });
    await line(page, 'waiting').getByRole('button').first().click();
    await line(page, 'pushed').getByRole('button').first().click();
    await opened(page, 'pushed');
    await page.evaluate(() => { const { replay } = window.lodestar.console; replay.goTo(replay.start() + 3); });
    const time = await page.evaluate(() => window.lodestar.console.replay.time);
    const late = page.waitForResponse((answer) => answer.url().endsWith('/api/runs/waiting'));
    held.forEach((go) => go());
    await (await late).finished();
    const again = page.waitForResponse((answer) => answer.url().endsWith('/api/runs/pushed'));
    await page.getByRole('combobox', { name: 'Run', exact: true }).selectOption('pushed');  // the one that is shown
    await (await again).finished();
    await page.waitForTimeout(300);
    assert.deepEqual(await page.evaluate(() => { const { run, time: now } = window.lodestar.console.replay; return [run.name, now]; }), ['pushed', time]);
    await leave(page);
  });

  test('a link to a run that is gone says so and shows the newest', async () => {
    const page = await open(browser, `${server.url}#run=nowhere&at=3`);
    await page.locator('#state', { hasText: "There is no run 'nowhere' any more" }).waitFor();
    await until(page, () => window.lodestar.console.replay.run !== null);
    await leave(page);
  });

  test('two are laid over each other, as long after their starts', async () => {
    const page = await replaying('plain');
    await line(page, 'pushed').getByRole('button', { name: 'beside' }).click();
    await until(page, () => window.lodestar.console.replay.second?.name === 'pushed');
    await page.evaluate(() => window.lodestar.console.replay.goTo(window.lodestar.console.replay.start() + 4));
    const apart = await page.evaluate(() => {
      const { run, second } = window.lodestar.console.replay;
      const at = (rows) => rows.findLast((row) => row[0] <= rows[0][0] + 4);
      const [a, b] = [at(run.estimate), at(second.estimate)];
      return Math.hypot(a[1] - b[1], a[2] - b[2]);
    });
    const words = await page.locator('#replay-words').innerText();
    const told = Number(words.match(/pushed is ([\d.]+) m away/)[1]);
    assert.ok(Math.abs(told - apart) < 0.03, `${words}, worked out ${apart}`);
    assert.match(page.url(), /beside=pushed/);
    await look(page, 'beside');
    await line(page, 'pushed').getByRole('button', { name: 'beside' }).click();
    await until(page, () => window.lodestar.console.replay.second === null);
    await leave(page);
  });
});

describe('where it goes badly', () => {
  test('the worst place without markers is where none was seen, and a marker suggested there is seen from it', async () => {
    drive('blind', '--goal', '9,5.2', '--seed', '5', '--remove-markers', '0.7', '--plain-ceiling');
    const page = await replaying('blind');
    await page.locator('#heat-kind').selectOption({ label: 'time without a marker' });
    const worst = page.locator('#heat-worst li').first();
    await worst.waitFor();
    const [x, y, blind] = (await worst.innerText()).match(/-?[\d.]+/g).map(Number);
    assert.ok(blind >= 0.5, `${blind} s`);
    await look(page, 'heat');
    const before = await page.evaluate(() => window.lodestar.console.editor.markers.size);
    await worst.getByRole('button', { name: 'Suggest a marker here' }).click();
    await page.waitForFunction((n) => window.lodestar.console.editor.markers.size > n, before, { polling: 20 });
    const placed = await page.evaluate(() => { const { editor, modes } = window.lodestar.console; return { mode: modes.now, count: editor.markers.size, chosen: editor.chosen() }; });
    assert.equal(placed.mode, 'edit');
    assert.equal(placed.count, before + 1);
    const sees = await page.evaluate(([at, marker]) => {
      const { floor } = window.lodestar.console;
      const cell = floor.toGrid(at);
      const index = Math.floor(cell.y) * floor.info.columns + Math.floor(cell.x);
      return [...window.lodestar.countedAnew([]).visibleFrom({ x: marker.x + 0.06, y: marker.y - 0.06 }, marker.z)].includes(index) || !floor.canStand(index);
    }, [{ x, y }, placed.chosen[0]]);
    assert.equal(sees, true);
    await page.keyboard.press('Control+z');
    assert.equal(await page.evaluate(() => window.lodestar.console.editor.markers.size), before);
    await leave(page);
  });
});

describe('earlier states', () => {
  test('are shown with time, author, picture and what has changed; the log tells who saved', async () => {
    const page = await replaying('plain');
    await page.locator('#tool-edit').click();
    await page.evaluate(() => localStorage.setItem('lodestar-name', 'Zöe'));
    await page.evaluate(() => {
      const { editor } = window.lodestar.console;
      editor.change([{ ...window.lodestar.marker(1887), x: 9.5 }]);
      editor.remove([window.lodestar.marker(447).key]);
      editor.add([editor.fresh(12, 3, 3, 2.6, 0)]);
    });
    await page.keyboard.press('Control+s');
    await page.locator('#state', { hasText: 'Saved' }).waitFor();
    await page.locator('#tool-history').click();
    await page.locator('#history-words', { hasText: '1 changed, 1 added, 1 removed' }).waitFor();
    assert.match(await page.locator('.history-states button').first().innerText(), /\d\d:\d\d, Zöe/);
    const isDrawn = (selector) => page.evaluate((s) => {
      const canvas = document.querySelector(s);
      const data = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data;
      return new Set(new Uint32Array(data.buffer)).size;
    }, selector);
    assert.ok(await isDrawn('#history-picture') > 4, 'walls, floor, and more than one ink');
    await page.waitForFunction(() => { const c = document.querySelector('.history-states canvas'); return c.width !== 300; }, undefined, { polling: 50 });
    assert.ok(await isDrawn('.history-states canvas') > 2);
    await look(page, 'history');
    await page.getByRole('button', { name: 'Cancel' }).click();
    await page.locator('#tool-log').click();
    await page.locator('#log-list li', { hasText: 'Zöe: saved the markers: 1 changed, 1 added, 1 removed' }).waitFor();
    await look(page, 'log');
    await page.getByRole('button', { name: 'Close' }).last().click();
    await leave(page);
  });
});

for (const [size, scheme] of [[{ width: 1280, height: 800 }, 'light'], [{ width: 390, height: 844 }, 'dark']]) {
  test(`no serious finding of axe at ${size.width} pixels, ${scheme}`, async () => {
    const page = await open(browser, `${server.url}#run=waiting&at=5&beside=plain`, size, { colorScheme: scheme, bypassCSP: true });
    await until(page, () => window.lodestar.console.replay.second !== null);
    await page.locator('#heat-kind').selectOption('waiting');
    await page.evaluate(axeSource);
    const findings = () => page.evaluate(async () => (await window.axe.run()).violations
      .filter((v) => v.impact === 'serious' || v.impact === 'critical').map((v) => `${v.id}: ${v.nodes[0].html}`));
    assert.deepEqual(await findings(), []);
    await look(page, `${size.width}-${scheme}`);
    await page.locator('#tool-log').click();
    assert.deepEqual(await findings(), []);
    await page.context().close();
  });
}
