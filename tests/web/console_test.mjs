// The console as a person uses it: a real browser, a real server, and the file that is saved.
import assert from 'node:assert/strict';
import { mkdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, describe, test } from 'node:test';
import { axeSource, launch, open, serve } from './browser.mjs';

let browser;
let server;
before(async () => {
  browser = await launch();
  server = await serve();
  const run = join(server.runs, 'seed 1');
  mkdirSync(run, { recursive: true });
  writeFileSync(join(run, 'summary.json'), '{}');
  const row = (t, x, y, deg) => `${t} ${x} ${y} 0 0 0 ${Math.sin(deg * Math.PI / 360)} ${Math.cos(deg * Math.PI / 360)}\n`;
  writeFileSync(join(run, 'estimate.tum'), row(0, 1, 5.6, 0) + row(1, 2, 5.6, 170) + row(2, 3, 5.6, -170) + row(3, 4, 5.6, -170));
  writeFileSync(join(run, 'truth.tum'), row(0, 1, 5.61, 0) + row(3, 4, 5.61, 0));
});
after(async () => {
  await browser?.close();
  await server?.stop();
});

/** Runs a story on a fresh page over the lab as it is, and looks that the page had no complaints. */
function story(name, tell, size) {
  test(name, async () => {
    const page = await open(browser, server.url, size);
    await tell(page);
    assert.deepEqual(page.complaints, []);
    await page.context().close();
  });
}

const lineOf = (id) => server.markersFile().split('\n').find((line) => line.includes(`id: ${id},`));

/** Where a marker is drawn, in the window. */
async function placeOf(page, id) {
  const box = await page.locator('#stage').boundingBox();
  const at = await page.evaluate((i) => window.lodestar.screenOf(i), id);
  return { x: box.x + at.x, y: box.y + at.y };
}

async function drag(page, from, to, ...keys) {
  await page.mouse.move(from.x, from.y);
  for (const key of keys) await page.keyboard.down(key);
  await page.mouse.down();
  await page.mouse.move((from.x + to.x) / 2, (from.y + to.y) / 2);
  await page.mouse.move(to.x, to.y);
  await page.mouse.up();
  for (const key of keys) await page.keyboard.up(key);
}

const marker = (page, id) => page.evaluate((i) => window.lodestar.marker(i), id);
const stateIs = (page, words) =>
  page.waitForFunction((w) => document.getElementById('state').textContent.includes(w), words, { polling: 50 });

async function save(page) {
  await page.keyboard.press('Control+s');
  await stateIs(page, 'Saved');
}

describe('editing', () => {
  story('a dragged marker snaps to the grid and is saved as one changed line', async (page) => {
    const linesBefore = server.markersFile().split('\n');
    const from = await placeOf(page, 1178);
    const start = await marker(page, 1178);
    await drag(page, from, { x: from.x + 60, y: from.y - 30 });
    const end = await marker(page, 1178);
    const pixelsPerM = await page.evaluate(() => window.lodestar.console.view.pixelsPerM);
    assert.ok(Math.abs(end.x - start.x - 60 / pixelsPerM) <= 0.03, `${end.x}`);
    assert.ok(Math.abs(end.y - start.y - 30 / pixelsPerM) <= 0.03, `${end.y}`);
    for (const value of [end.x, end.y]) assert.ok(Math.abs(value / 0.05 - Math.round(value / 0.05)) < 1e-6);

    await save(page);
    const linesAfter = server.markersFile().split('\n');
    const changed = linesAfter.filter((line, i) => line !== linesBefore[i]);
    assert.deepEqual(changed, [`  - {id: 1178, x_m: ${end.x}, y_m: ${end.y}, z_m: 2.6, yaw_deg: -90.7}`]);

    await page.reload();
    await page.waitForFunction(() => window.lodestar !== undefined, undefined, { polling: 100 });
    const again = await marker(page, 1178);
    assert.deepEqual([again.x, again.y, again.yawDeg], [end.x, end.y, -90.7]);
  });

  story('the handle rotates counter-clockwise as seen from above, in steps of 15 degrees', async (page) => {
    const at = await placeOf(page, 2357);
    await page.mouse.click(at.x, at.y);
    const box = await page.locator('#stage').boundingBox();
    const { handle, pivot } = await page.evaluate(() => {
      const { stage, editor, view } = window.lodestar.console;
      return { handle: stage.rotateHandle(), pivot: view.toScreen(editor.pivot(editor.chosen())) };
    });
    const o = { x: box.x + pivot.x, y: box.y + pivot.y };
    await drag(page, { x: box.x + handle.x, y: box.y + handle.y }, { x: o.x + 1, y: o.y - 80 });  // to map north
    const turned = await marker(page, 2357);
    assert.equal(turned.yawDeg, 90);
    assert.deepEqual([turned.x, turned.y], [7.464, 3.674]);
    await save(page);
    assert.match(lineOf(2357), /yaw_deg: 90}/);
  });

  story('numbers typed into the fields arrive as they are, and nonsense does not', async (page) => {
    await page.getByRole('button', { name: '2826', exact: true }).click();
    await page.getByLabel('x (m)').fill('11.123456');
    await page.getByLabel('z (m)').fill('2.75');
    await page.getByLabel('yaw (°)').fill('270');
    await page.getByLabel('ID', { exact: true }).fill('5000');
    await page.keyboard.press('Enter');
    assert.equal(await page.getByLabel('ID', { exact: true }).getAttribute('aria-invalid'), 'true');
    assert.match(await page.locator('#field-reason').textContent(), /0 to 4095; the marker keeps 2826/);
    const m = await marker(page, 2826);
    assert.deepEqual([m.id, m.x, m.z, m.yawDeg], [2826, 11.123456, 2.75, -90]);
    await save(page);
    assert.equal(lineOf(2826), '  - {id: 2826, x_m: 11.123456, y_m: 1.124, z_m: 2.75, yaw_deg: -90}');
  });

  story('a box chooses several, which move together and come back together', async (page) => {
    const [a, b] = [await placeOf(page, 3390), await placeOf(page, 2641)];
    await drag(page, { x: a.x - 25, y: a.y - 30 }, { x: b.x + 25, y: b.y + 30 }, 'Shift');
    const chosen = await page.evaluate(() => window.lodestar.console.editor.chosen().map((m) => m.id));
    assert.deepEqual(chosen.sort(), [2641, 3390]);
    const before = [await marker(page, 3390), await marker(page, 2641)];
    await drag(page, a, { x: a.x + 47, y: a.y + 13 }, 'Alt');
    const moved = [await marker(page, 3390), await marker(page, 2641)];
    for (const i of [0, 1]) {
      assert.ok(Math.abs((moved[i].x - before[i].x) - (moved[0].x - before[0].x)) < 1.1e-3);
      assert.ok(moved[i].x > before[i].x && moved[i].y < before[i].y);
    }
    await page.keyboard.press('Control+z');
    assert.deepEqual([await marker(page, 3390), await marker(page, 2641)], before);
  });

  story('undo and redo give each former state back, over random sequences', async (page) => {
    const failure = await page.evaluate(() => {
      const { editor } = window.lodestar.console;
      let seed = 20260901;
      const random = (n) => {
        seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0;
        return Math.floor(seed / 2 ** 32 * n);
      };
      const state = () => JSON.stringify([editor.alignment, [...editor.markers.values()].sort((a, b) => a.key - b.key)]);
      const keys = () => [...editor.markers.keys()];
      const history = [state()];
      let at = 0;
      editor.onChange = () => {};
      for (let step = 0; step < 1000; ++step) {
        const action = random(8);
        const some = keys().filter(() => random(5) === 0);
        editor.select(some);
        const before = state();
        if (action < 2) editor.change(editor.chosen().map((m) => ({ ...m, x: m.x + random(100) / 100, yawDeg: random(360) - 179 })));
        if (action === 2) editor.add([editor.fresh(random(4096), random(15), random(7), 2.6, random(360))]);
        if (action === 3 && some.length > 0) editor.remove(some.slice(0, 2));
        if (action === 4) editor.align({ x: random(5) / 10, y: 0, yawDeg: random(9) });
        if (action === 5) editor.undo();
        if (action >= 6) for (let i = random(4); i > 0; --i) action === 6 ? editor.undo() : editor.redo();
        if (action < 5) {
          if (state() === before && action !== 4) continue;
          history.length = at + 1;
          history.push(state());
          ++at;
        } else {
          at = history.indexOf(state(), 0);
          const found = history.map((h, i) => h === state() ? i : -1).filter((i) => i >= 0);
          if (found.length === 0) return `step ${step}: a state that never was`;
          at = found.at(-1);
        }
      }
      while (editor.canUndo) editor.undo();
      if (state() !== history[0]) return 'not back at the beginning';
      while (editor.canRedo) editor.redo();
      return state() === history.at(-1) ? '' : 'not at the end again';
    });
    assert.equal(failure, '');
  });

  story('keys add, duplicate, nudge, delete and undo', async (page) => {
    const count = () => page.evaluate(() => window.lodestar.console.editor.markers.size);
    const all = await count();
    await page.locator('#stage').focus();
    await page.keyboard.press('n');
    assert.equal(await count(), all + 1);
    await page.keyboard.press('Control+d');
    assert.equal(await count(), all + 2);
    const x = () => page.evaluate(() => window.lodestar.console.editor.chosen()[0].x);
    const before = await x();
    await page.keyboard.press('Shift+ArrowRight');
    assert.ok(Math.abs(await x() - before - 0.1) < 1e-9);
    await page.keyboard.press('Delete');
    assert.equal(await count(), all + 1);
    for (let i = 0; i < 4; ++i) await page.keyboard.press('Control+z');
    assert.equal(await count(), all);
    assert.equal(await page.locator('#tool-undo').isDisabled(), true);
  });
});

describe('with others', () => {
  story('who saves second is told, and merging keeps both', async (page) => {
    const other = await open(browser, server.url);
    const move = (p, id, y) => p.evaluate(([i, to]) => {
      const { editor } = window.lodestar.console;
      editor.change([{ ...window.lodestar.marker(i), y: to }]);
    }, [id, y]);
    await move(page, 2454, 6.222);
    await move(other, 1395, 6.111);
    await save(other);
    await stateIs(page, 'Somebody else saved the markers');
    await page.keyboard.press('Control+s');
    await page.locator('#conflict-words').waitFor();
    assert.match(lineOf(2454), /y_m: 6.172/);  // nothing written yet
    await page.locator('#dialog', { hasText: '1395: y' }).waitFor();  // what each side changed, marker by marker
    await page.locator('#conflict-both', { hasText: 'loses nothing' }).waitFor();
    await page.getByRole('button', { name: 'Merge' }).click();
    await stateIs(page, 'Merged and saved');
    assert.match(lineOf(1395), /y_m: 6.111/);
    assert.match(lineOf(2454), /y_m: 6.222/);
    assert.deepEqual(other.complaints, []);
    await other.context().close();
  });

  story('issues of the server appear as one edits, and lead to their place', async (page) => {
    await page.evaluate(() => {
      const { editor } = window.lodestar.console;
      editor.change([{ ...window.lodestar.marker(988), x: 40 }, { ...window.lodestar.marker(447), id: 3748 }]);
    });
    await page.locator('[data-kind="outside-map"]').waitFor();
    await page.locator('[data-kind="repeated-id"]').waitFor();
    await page.locator('[data-kind="outside-map"]').click();
    const center = await page.evaluate(() => window.lodestar.console.view.center);
    assert.ok(Math.abs(center.x - 40) < 0.01);
    await page.keyboard.press('Control+s');
    await stateIs(page, 'marker 3748 twice');
  });
});

describe('seeing', () => {
  story('coverage follows a drag, and a suggested marker closes a gap', async (page) => {
    const share = () => page.evaluate(async () => {
      const { coverage } = window.lodestar.console;
      await coverage.settled();
      return coverage.shares().one;
    });
    const before = await share();
    await page.getByRole('button', { name: 'Suggest next marker' }).click();
    await page.waitForFunction((then) => window.lodestar.console.coverage.shares().one > then + 0.02, before, { polling: 50 });
    await page.keyboard.press('Control+z');
    await page.waitForFunction((then) => window.lodestar.console.coverage.shares().one === then, before, { polling: 50 });

    // The same from scratch as by moving: nothing is left behind.
    const equal = await page.evaluate(async () => {
      const { editor, coverage } = window.lodestar.console;
      editor.change([...editor.markers.values()].map((m) => ({ ...m, x: m.x + 0.31, y: m.y - 0.17 })));
      await coverage.settled();
      const fresh = window.lodestar.countedAnew(editor.shown());
      return fresh.counts.every((count, i) => count === coverage.counts[i]);
    });
    assert.ok(equal);
  });

  story('the map shows a marker from above: dot Y to the right of the way from O to X', async (page) => {
    const colours = await page.evaluate(async () => {
      const { console: c } = window.lodestar;
      const m = window.lodestar.marker(2271);  // yaw -3.4 degrees: O to X runs to the right
      c.editor.change([{ ...m, yawDeg: 0 }]);
      c.view.fit([m], 0.6);
      c.stage.redraw();
      await new Promise((done) => setTimeout(done, 200));
      const context = document.getElementById('ceiling').getContext('2d');
      const ratio = devicePixelRatio;
      const at = (x, y) => {
        const p = c.view.toScreen({ x: m.x + x, y: m.y + y });
        return [...context.getImageData(Math.round(p.x * ratio), Math.round(p.y * ratio), 1, 1).data].slice(0, 3).join();
      };
      return { o: at(0, 0), x: at(0.12, 0), y: at(0, -0.12), empty: at(0.12, -0.12) };
    });
    assert.deepEqual(colours, { o: '255,138,61', x: '88,183,255', y: '255,255,255', empty: '28,36,48' });
  });

  story('a run is scrubbed: the pose shown at a time is that of its trajectory', async (page) => {
    await page.locator('#tool-replay').click();
    await page.locator('#replay').waitFor();
    await page.waitForFunction(() => window.lodestar.console.replay.run !== null, undefined, { polling: 50 });
    await page.getByLabel('Time').fill('1.5');
    await page.locator('#replay-words', { hasText: '1.5 of 3.0 s: 2.500, 5.600 m, 180.0°; error 10.0 mm' }).waitFor();
    await page.getByText('No pictures').waitFor();
    assert.equal(await page.locator('#replay-picture').isVisible(), false);  // nothing broken in its place
    await page.getByLabel('Speed').selectOption('50');
    await page.getByRole('button', { name: 'Play', exact: true }).click();
    await page.locator('#replay-words', { hasText: '3.0 of 3.0 s: 4.000' }).waitFor();
    const at = await placeOf(page, 2454);
    await drag(page, at, { x: at.x + 50, y: at.y });  // who looks on moves no marker
    await page.getByRole('button', { name: 'Close' }).click();
    assert.equal(await page.locator('#replay').isVisible(), false);
    assert.equal(await page.evaluate(() => window.lodestar.console.editor.dirty), false);
  });

  story('ten thousand markers can still be panned', async (page) => {
    const median = await page.evaluate(async () => {
      const { console: c } = window.lodestar;
      const markers = [];
      for (let i = 0; i < 10_000; ++i) markers.push({ id: i % 4096, x_m: 0.15 * (i % 100), y_m: 0.07 * Math.floor(i / 100), z_m: 2.6, yaw_deg: i % 360 });
      c.check = async () => {};
      c.editor.onChange = () => {};
      c.editor.load({ alignment: { x_m: 0, y_m: 0, yaw_deg: 0 }, markers });
      const times = [];
      for (let i = 0; i < 15; ++i) {
        const start = performance.now();
        c.stage.pan(3, 1);
        await new Promise((done) => requestAnimationFrame(() => setTimeout(done)));
        times.push(performance.now() - start);
      }
      return times.sort((a, b) => a - b)[7];
    });
    console.log(`pan, 10,000 markers: median ${median.toFixed(0)} ms a frame`);
    assert.ok(median < 500);  // a frame is 16 ms; here only a machine that is busy with more is waited for
  });
});

describe('for everyone', () => {
  for (const [width, scheme] of [[1280, 'light'], [800, 'dark']]) {
    test(`no serious finding of axe at ${width} pixels, ${scheme}`, async () => {
      const page = await open(browser, server.url, { width, height: 700 }, { colorScheme: scheme, bypassCSP: true });
      await page.evaluate(() => {
        const { editor } = window.lodestar.console;
        editor.select([editor.markers.keys().next().value]);
      });
      await page.locator('#coverage-words').waitFor();
      await page.evaluate(axeSource);
      const findings = await page.evaluate(async () => (await window.axe.run()).violations
        .filter((v) => v.impact === 'serious' || v.impact === 'critical').map((v) => `${v.id}: ${v.nodes[0].html}`));
      assert.deepEqual(findings, []);
      await page.context().close();
    });
  }

  test('the help sheet opens by a key and names every shortcut', async () => {
    const page = await open(browser, server.url);
    await page.keyboard.press('?');
    const words = await page.locator('dialog').innerText();
    for (const key of ['Ctrl+Z', 'Ctrl+S', 'Shift+drag', 'Delete', 'counter-clockwise']) assert.ok(words.includes(key), key);
    await page.context().close();
  });
});

describe('with strangers', () => {
  test('a page of another origin reads and changes nothing', async () => {
    const stranger = await serve();
    const page = await (await browser.newContext()).newPage();
    await page.goto(`${stranger.url}style.css`);  // another port: another origin
    const before = server.markersFile();
    const results = await page.evaluate(async (url) => {
      const attempt = (target, init) => fetch(url + target, init).then((r) => r.status, () => 'refused');
      return [await attempt('api/markers'),
        await attempt('api/markers', { method: 'PUT', headers: { 'X-Lodestar': '1', 'Content-Type': 'application/json' }, body: '{}' }),
        await attempt('api/markers/check', { method: 'POST', mode: 'no-cors', body: '{}' })];
    }, server.url);
    assert.deepEqual(results, ['refused', 'refused', 'refused']);
    assert.equal(server.markersFile(), before);
    await page.context().close();
    await stranger.stop();
  });

  test('a console with a token opens by the link and by nothing else', async () => {
    const token = 'a-token-that-nobody-guesses';
    const guarded = await serve('--token', token);
    const context = await browser.newContext();
    const page = await context.newPage();
    await page.goto(guarded.url);
    await page.waitForFunction(() => document.getElementById('state').textContent.includes('token'), undefined, { polling: 50 });
    await page.goto('about:blank');
    await page.goto(`${guarded.url}#t=${token}`);
    await page.waitForFunction(() => window.lodestar !== undefined, undefined, { polling: 100 });
    assert.equal(new URL(page.url()).hash, '');
    assert.equal(await page.evaluate(() => document.cookie), '');
    await context.close();
    await guarded.stop();
  });
});
