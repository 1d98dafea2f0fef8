// What the editor offers beyond dragging: arrays, walls, measures, IDs, filled gaps, issues, history. Judged by the state
// and by the saved file.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, describe, test } from 'node:test';
import { launch, open, serve } from './browser.mjs';
import { binary } from './programs.mjs';

let browser;
let server;
before(async () => {
  browser = await launch();
  server = await serve();
});
after(async () => {
  await browser?.close();
  await server?.stop();
});

function story(name, tell) {
  test(name, async () => {
    const page = await open(browser, server.url);
    await tell(page);
    assert.deepEqual(page.complaints, []);
    await page.context().close();
  });
}

const stateIs = (page, words) =>
  page.waitForFunction((w) => document.getElementById('state').textContent.includes(w), words, { polling: 50 });
const chosen = (page) => page.evaluate(() => window.lodestar.console.editor.chosen());
const select = (page, ...ids) => page.evaluate((wanted) => {
  const { editor } = window.lodestar.console;
  editor.select([...editor.markers.values()].filter((m) => wanted.includes(m.id)).map((m) => m.key));
}, ids);
const middleOf = (m) => {
  const yaw = m.yawDeg * Math.PI / 180;
  return { x: m.x + 0.06 * (Math.cos(yaw) + Math.sin(yaw)), y: m.y + 0.06 * (Math.sin(yaw) - Math.cos(yaw)) };
};
const near = (a, b, slack = 1.1e-3) => assert.ok(Math.abs(a - b) <= slack, `${a} ${b}`);

/** Opens a dialog by its key, fills in its numbers and agrees. */
async function fill(page, key, numbers, go) {
  await page.locator('#stage').focus();
  await page.keyboard.press(key);
  for (const [name, value] of Object.entries(numbers)) await page.locator(`#ask-${name}`).fill(String(value));
  await page.getByRole('dialog').getByRole('button', { name: go, exact: true }).click();
}

async function save(page) {
  await page.keyboard.press('Control+s');
  await stateIs(page, 'Saved');
}

describe('arranging', () => {
  story('an array is pasted, saved, and comes back as it was', async (page) => {
    const before = server.markersFile();
    await select(page, 447);
    const [first] = await chosen(page);
    await fill(page, 'a', { columns: 3, rows: 2, stepX: 0.5, stepY: 0.4, turnDeg: 90 }, 'Paste');
    await stateIs(page, 'Pasted 5 markers');
    const copies = await chosen(page);
    const places = copies.map((m) => [m.x - first.x, m.y - first.y].map((v) => Math.round(v * 1000) / 1000).join());
    assert.deepEqual(places.sort(), ['-0.4,0', '-0.4,0.5', '-0.4,1', '0,0.5', '0,1'].sort());  // columns run to the north
    assert.ok(copies.every((m) => m.z === first.z && m.yawDeg === first.yawDeg));
    assert.equal(new Set([...copies.map((m) => m.id), 447]).size, 6);
    await save(page);
    for (const m of copies) assert.ok(server.markersFile().includes(`{id: ${m.id}, x_m: ${m.x}, y_m: ${m.y},`), `${m.id}`);
    await page.locator('#stage').focus();
    await page.keyboard.press('Control+z');
    await save(page);
    assert.equal(server.markersFile(), before);
  });

  story('a group moves and turns by numbers about its middle', async (page) => {
    await select(page, 3390, 2641);
    const before = await chosen(page);
    const pivot = { x: (middleOf(before[0]).x + middleOf(before[1]).x) / 2, y: (middleOf(before[0]).y + middleOf(before[1]).y) / 2 };
    await fill(page, 'm', { x: 0.25, y: -0.5, z: 0.1, yawDeg: 90 }, 'Move');
    await stateIs(page, 'Moved 2 markers');
    for (const [i, m] of (await chosen(page)).entries()) {
      const was = middleOf(before[i]), is = middleOf(m);
      near(is.x, pivot.x - (was.y - pivot.y) + 0.25);
      near(is.y, pivot.y + (was.x - pivot.x) - 0.5);
      near(m.z, before[i].z + 0.1, 1e-9);
      near((m.yawDeg - before[i].yawDeg + 720) % 360, 90, 1e-6);
    }
    await page.keyboard.press('Control+z');
    assert.deepEqual(await chosen(page), before);
  });

  story('three are put at equal steps on a line', async (page) => {
    await select(page, 2271, 3390, 2357);
    await page.locator('#stage').focus();
    await page.keyboard.press('d');
    const [a, b, c] = (await chosen(page)).map(middleOf).sort((p, q) => p.x - q.x);
    near(b.x, (a.x + c.x) / 2);
    near(b.y, (a.y + c.y) / 2);
  });

  story('a marker is put square to the nearest wall, at a distance', async (page) => {
    await select(page, 689);
    await fill(page, 'w', { distance: 0.4 }, 'Move');
    await stateIs(page, '0.40 m from the wall');
    const [m] = await chosen(page);
    assert.equal(m.yawDeg % 90, 0);
    const free = await page.evaluate(({ x, y }) => {  // how far to the first occupied cell's edge, on each side
      const { floor } = window.lodestar.console;
      const r = floor.info.resolution_m;
      const at = floor.toGrid({ x, y });
      return [[1, 0], [-1, 0], [0, 1], [0, -1]].map(([dx, dy]) => {
        let step = 0;
        while (!floor.isWall(Math.floor(at.x) + dx * step, Math.floor(at.y) + dy * step) && step < 400) ++step;
        const cell = (dx ? Math.floor(at.x) + dx * step : Math.floor(at.y) + dy * step) + (dx + dy > 0 ? 0 : 1);
        return Math.abs(cell - (dx ? at.x : at.y)) * r;
      });
    }, middleOf(m));
    near(Math.min(...free), 0.4, 2e-3);
  });

  story('numbers that cannot be used change nothing and are told', async (page) => {
    await select(page, 447);
    const before = await chosen(page);
    await fill(page, 'a', { columns: 0 }, 'Paste');
    await page.locator('#dialog-reason', { hasText: 'wanted a number from 1 to 200' }).waitFor();
    await page.getByRole('button', { name: 'Cancel' }).click();
    assert.deepEqual(await chosen(page), before);
  });
});

describe('measuring and looking', () => {
  story('the tape measures between the middles of two markers', async (page) => {
    const box = await page.locator('#stage').boundingBox();
    await page.locator('#stage').focus();
    await page.keyboard.press('t');
    for (const id of [1782, 1849]) {
      const at = await page.evaluate((i) => window.lodestar.screenOf(i), id);
      await page.mouse.click(box.x + at.x, box.y + at.y);
    }
    const [a, b] = await page.evaluate(() => [1782, 1849].map((id) => window.lodestar.marker(id)));
    const distance = Math.hypot(middleOf(a).x - middleOf(b).x, middleOf(a).y - middleOf(b).y);
    await stateIs(page, `Measured: ${distance.toFixed(3)} m`);
    await page.keyboard.press('Escape');
    assert.equal(await page.evaluate(() => window.lodestar.console.measure.on), false);
  });

  story('in a turned view a marker is dragged to where the pointer is', async (page) => {
    await page.evaluate(() => { const { view, stage } = window.lodestar.console; view.turnBy(40); stage.redraw(); });
    const box = await page.locator('#stage').boundingBox();
    const at = await page.evaluate(() => window.lodestar.screenOf(2274));
    await page.keyboard.down('Alt');
    await page.mouse.move(box.x + at.x, box.y + at.y);
    await page.mouse.down();
    await page.mouse.move(box.x + at.x + 30, box.y + at.y + 10);
    await page.mouse.move(box.x + at.x + 60, box.y + at.y + 20);
    await page.mouse.up();
    await page.keyboard.up('Alt');
    const now = await page.evaluate(() => window.lodestar.screenOf(2274));
    near(now.x, at.x + 60, 0.2);
    near(now.y, at.y + 20, 0.2);
  });

  story('layers hide what they name', async (page) => {
    const inked = () => page.evaluate(async () => {
      await new Promise((done) => requestAnimationFrame(() => setTimeout(done, 30)));
      const canvas = document.getElementById('ceiling');
      return canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data.some((v) => v !== 0);
    });
    assert.equal(await inked(), true);
    await page.locator('#layer-markers').uncheck();
    assert.equal(await inked(), false);
    await page.locator('#layer-markers').check();
    assert.equal(await inked(), true);
  });

  story('deviations come from the server, small under markers and none where nothing is seen', async (page) => {
    await page.getByLabel('Floor coloured by').selectOption('deviation');
    await page.waitForFunction(() => window.lodestar.console.stage.floorPaint.deviations !== null, undefined, { polling: 50 });
    const [under, far] = await page.evaluate(() => {
      const { stage: { floorPaint }, floor, editor } = window.lodestar.console;
      const at = (p) => {
        const cell = floor.toGrid(p);
        return floorPaint.deviations[Math.floor(cell.y) * floor.info.columns + Math.floor(cell.x)];
      };
      const before = at(window.lodestar.marker(2357));
      return [before, [...floorPaint.deviations].some((v) => Number.isNaN(v)) && editor.markers.size];
    });
    assert.ok(under > 0.0005 && under < 0.02, `${under}`);
    assert.ok(far > 0);
  });
});

describe('IDs', () => {
  story('the safest free ID is as far from all others as can be, in all eight views', async (page) => {
    await select(page, 447);
    await page.getByRole('button', { name: 'Safest IDs' }).click();
    const first = await page.getByRole('dialog').getByRole('button').first().innerText();
    const [, id, distance] = first.match(/^(\d+): (\d+) apart$/).map(Number);
    const others = await page.evaluate(() => [...window.lodestar.console.editor.markers.values()].map((m) => m.id).filter((i) => i !== 447));
    assert.equal(distance, Math.min(...[...others, id].map((other) => apart(id, other))));
    for (let any = 0; any < 4096; any += 7) {
      if (others.includes(any) || dotsIn(any) < 2) continue;
      assert.ok(Math.min(...[...others, any].map((other) => apart(any, other))) <= distance, `${any}`);
    }
    await page.getByRole('button', { name: first, exact: true }).click();
    await stateIs(page, `Marker 447 is ${id} now`);
    assert.equal((await chosen(page))[0].id, id);
  });

  // The face as the paper has it: 1 for a dot, row by row from the top; bits of the ID by their place.
  const places = [['Y', 0x020, 0x200, null], [0x002, 0x010, 0x100, 0x800], [0x001, 0x008, 0x080, 0x400], ['O', 0x004, 0x040, 'X']];
  const dotsIn = (id) => id.toString(2).split('1').length - 1;
  const face = (id) => places.map((row) => row.map((bit) => bit === null ? 0 : typeof bit === 'string' ? 1 : Number((id & bit) !== 0)));
  const turn = (f) => f.map((row, r) => row.map((_, c) => f[c][3 - r]));
  const mirror = (f) => f.map((row) => [...row].reverse());
  function apart(a, b) {
    const upright = face(a).flat();
    let view = face(b);
    let least = 16;
    for (let i = 0; i < 8; ++i) {
      const distance = view.flat().filter((dot, k) => dot !== upright[k]).length;
      if (a !== b || i > 0) least = Math.min(least, distance);
      view = i === 3 ? mirror(turn(view)) : turn(view);
    }
    return least;
  }
});

describe('gaps', () => {
  story('filling them leaves no place unseen, with no marker that is not needed', async (page) => {
    await fill(page, 'k', { wanted: 1 }, 'Fill');
    await page.waitForFunction(() => /^Added \d+ markers/.test(document.getElementById('state').textContent), undefined, { polling: 100, timeout: 60_000 });
    const result = await page.evaluate(async () => {
      const { editor, coverage, floor } = window.lodestar.console;
      await coverage.settled();
      const blind = [...coverage.counts].filter((count, i) => count === 0 && floor.canStand(i)).length;
      const added = [...editor.selection];
      const needless = added.filter((key) => {
        const rest = window.lodestar.countedAnew([...editor.shown()].filter((m) => m.key !== key));
        return ![...rest.counts].some((count, i) => count < coverage.counts[i] && count === 0);
      });
      return { blind, added: added.length, needless: needless.length };
    });
    console.log(`filling the lab's gaps took ${result.added} markers`);
    assert.ok(result.added > 3);
    assert.equal(result.needless, 0);
    const told = await page.locator('#state').innerText();
    const unseen = Number(told.match(/([\d.]+) m² can be seen/)?.[1] ?? 0);
    near(result.blind * 0.05 ** 2, unseen, 0.006);
    assert.ok(unseen < 0.5, told);
    await page.locator('#stage').focus();
    await page.keyboard.press('Control+z');
    assert.equal(await page.evaluate(() => window.lodestar.console.editor.canUndo), false);
  });

  story('a suggested marker closes as much as the best of all places', async (page) => {
    const { gains, most } = await page.evaluate(async () => {
      const { editor, coverage, floor } = window.lodestar.console;
      editor.remove([...editor.markers.keys()].filter((_, i) => i % 3 === 1));
      const before = window.lodestar.countedAnew(editor.shown());
      const gainOf = (at) => [...before.visibleFrom(at, 2.6)].filter((cell) => before.counts[cell] === 0).length;
      const { columns, rows, resolution_m } = floor.info;
      const stride = Math.round(0.3 / resolution_m);
      const best = await coverage.suggestion(2.6, () => {});
      let most = 0;
      for (let row = stride >> 1; row < rows; row += stride)
        for (let column = stride >> 1; column < columns; column += stride)
          if (floor.isFree(row * columns + column)) most = Math.max(most, gainOf(floor.centerOfCell(row * columns + column)));
      return { gains: gainOf(best), most };
    });
    assert.ok(most > 100);
    assert.equal(gains, most);
  });

  story('what the page paints red is what the server calls gaps', async (page) => {
    for (const kept of [0, 1, 4, 25]) {
      await page.evaluate((n) => {
        const { editor } = window.lodestar.console;
        editor.remove([...editor.markers.keys()].slice(n));
      }, kept);
      const { red, gaps } = await page.evaluate(async () => {
        const { editor, coverage, floor } = window.lodestar.console;
        const answer = await fetch('/api/markers/check', { method: 'POST', body: JSON.stringify(editor.registry()),
          headers: { 'Content-Type': 'application/json', 'X-Lodestar': '1' } });
        const boxes = (await answer.json()).filter((i) => i.kind === 'gap').map((i) => ({ places: i.places_m, m2: Number.parseFloat(i.words) }));
        const cellM2 = floor.info.resolution_m ** 2;
        await coverage.settled();
        const isIn = (p) => boxes.some(({ places: [low, high] }) =>
          p.x > low[0] - 1e-6 && p.y > low[1] - 1e-6 && p.x < high[0] + 1e-6 && p.y < high[1] + 1e-6);
        const blind = [...coverage.counts.keys()].filter((i) => coverage.counts[i] === 0 && floor.canStand(i));
        return { red: { all: blind.length * cellM2, inBoxes: blind.filter((i) => isIn(floor.centerOfCell(i))).length * cellM2 },
          gaps: { number: boxes.length, m2: boxes.reduce((sum, box) => sum + box.m2, 0) } };
      });
      near(red.all, gaps.m2, 0.05 * gaps.number + 0.25);       // to a digit each, and specks that nobody is told of
      near(red.all, red.inBoxes, 0.25);
      await page.keyboard.press('Control+z');
    }
  });

  story('the issues and the words follow a drag before it ends', async (page) => {
    await page.getByText('of the floor where the robot can stand').waitFor();
    const words = await page.locator('#coverage-words').innerText();
    const from = await page.evaluate(() => window.lodestar.screenOf(2357));
    const box = await page.locator('#stage').boundingBox();
    await page.mouse.move(box.x + from.x, box.y + from.y);
    await page.mouse.down();
    await page.mouse.move(box.x + from.x, box.y + 30, { steps: 4 });  // beside the map
    await page.locator('[data-kind="outside-map"]').waitFor();
    assert.notEqual(await page.locator('#coverage-words').innerText(), words);
    await page.keyboard.press('Escape');
    await page.mouse.up();
    await page.locator('[data-kind="outside-map"]').waitFor({ state: 'detached' });
    assert.equal(await page.locator('#coverage-words').innerText(), words);
  });

  story('gaps and a blind route are issues that lead to their place', async (page) => {
    await page.evaluate(() => { const { editor } = window.lodestar.console; editor.remove([...editor.markers.keys()]); });
    // The whole way, and not a stretch of it as before.
    await page.waitForFunction(() => Number(document.querySelector('[data-kind="blind-route"]')?.textContent.match(/([\d.]+) m from/)?.[1]) > 10, undefined, { polling: 50 });
    assert.ok(await page.locator('[data-kind="gap"]').count() >= 1);
    await page.locator('[data-kind="blind-route"]').first().click();
    await page.waitForFunction(() => {
      const { view, routes } = window.lodestar.console;
      const ends = routes[0].map((p) => view.toScreen(p));
      return ends.every((p) => p.x > 0 && p.y > 0 && p.x < view.width && p.y < view.height);
    }, undefined, { polling: 50 });
    await page.keyboard.press('Control+z');
    await page.waitForFunction(() => document.querySelectorAll('[data-kind="gap"]').length > 3, undefined, { polling: 50 });
  });
});

describe('an OctoMap', () => {
  story('hides markers behind what it shows, and nothing else does', async (page) => {
    const seen = await page.evaluate(() => {
      const { floor } = window.lodestar.console;
      const { columns, rows } = floor.info;
      const heights = { low_m: 1, step_m: 0.1, touch_m: 0.18, bands: new Uint32Array(columns * rows) };
      const floorWith = (bits, column) => {  // a beam from south to north in one column of cells
        for (let row = 0; row < rows; ++row) heights.bands[row * columns + column] = bits;
        const open = new Int8Array(columns * rows);  // a hall without walls
        return new floor.constructor(floor.info, open, 0, heights);
      };
      const at = { x: 7.525, y: 3.725 };
      const east = (hall) => {
        const cells = window.lodestar.countedAnew([], hall).visibleFrom(at, 2.6);
        return [[...cells].filter((c) => c % columns > 156).length, [...cells].filter((c) => c % columns < 150).length];
      };
      return { free: east(floorWith(0, 156)), wall: east(floorWith(0xffffffff, 156)), beam: east(floorWith(1 << 10, 156)) };
    });
    assert.ok(seen.free[0] > 100);
    assert.equal(seen.wall[0], 0);                              // behind a wall, nothing
    assert.equal(seen.wall[1], seen.free[1]);                   // on this side of it, all
    assert.ok(seen.beam[0] > 0 && seen.beam[0] < seen.free[0]);  // below a beam: what is seen under it
  });
});

describe('other programs and other times', () => {
  for (const format of ['csv', 'stargazer', 'apriltag', 'fiducial_slam', 'geojson', 'lodestar']) {
    story(`${format}: what the page exports it imports again`, async (page) => {
      const before = await page.evaluate(() => window.lodestar.console.editor.registry().markers);
      await page.locator('#tool-export').click();
      await page.locator('#export-format').selectOption(format);
      const [download] = await Promise.all([page.waitForEvent('download'), page.getByRole('button', { name: 'Download' }).click()]);
      const file = join(server.site, '..', download.suggestedFilename());
      await download.saveAs(file);
      await page.evaluate(() => { const { editor } = window.lodestar.console; editor.remove([...editor.markers.keys()]); });
      const [chooser] = await Promise.all([page.waitForEvent('filechooser'), page.locator('#tool-import').click()]);
      await chooser.setFiles(file);
      await stateIs(page, `${before.length} markers read`);
      const after = await page.evaluate(() => window.lodestar.console.editor.registry().markers);
      for (const m of before) {
        const same = after.find((o) => o.id === m.id);
        for (const key of ['x_m', 'y_m', 'z_m', 'yaw_deg']) near(same[key], m[key], 1e-6);
      }
    });
  }

  story('an import is shown marker by marker first, and added or put in place of all', async (page) => {
    const file = join(server.site, '..', 'theirs.csv');
    writeFileSync(file, 'id;x;y;z;yaw_deg\n77;1,5;2,5;2,6;90\n620;9,5;1,25;2,6;60\n');
    const read = async (answer) => {
      const [chooser] = await Promise.all([page.waitForEvent('filechooser'), page.locator('#tool-import').click()]);
      await chooser.setFiles(file);
      await page.locator('#import-add', { hasText: '1 changed, 1 added, 0 removed' }).waitFor();
      await page.locator('#import-replace', { hasText: '1 changed, 1 added, 24 removed' }).waitFor();
      await page.getByRole('dialog').getByText('620: x 9.446 → 9.5 m', { exact: false }).first().waitFor();
      await page.getByRole('dialog').getByRole('button', { name: answer, exact: true }).click();
    };
    const there = () => page.evaluate(() => { const { editor } = window.lodestar.console; return [editor.markers.size, window.lodestar.marker(77)?.x, window.lodestar.marker(620)?.x]; });
    await read('Cancel');
    await stateIs(page, 'Nothing was imported');
    assert.deepEqual(await there(), [25, undefined, 9.446]);
    await read('Add');
    await stateIs(page, '2 markers read');
    assert.deepEqual(await there(), [26, 1.5, 9.5]);
    await page.keyboard.press('Control+z');
    await read('Replace all');
    await stateIs(page, '2 markers read');
    assert.deepEqual(await there(), [2, 1.5, 9.5]);
    await page.keyboard.press('Control+z');
    assert.deepEqual(await there(), [25, undefined, 9.446]);
  });

  story('a former state is shown with what has changed since, and brought back', async (page) => {
    await page.evaluate(() => {
      const { editor } = window.lodestar.console;
      editor.change([{ ...window.lodestar.marker(1887), x: 9.5 }]);
    });
    await save(page);
    await page.locator('#tool-history').click();
    await page.locator('#history-words', { hasText: '1 changed, 0 added, 0 removed' }).waitFor();
    assert.match(await page.locator('#history-list').innerText(), /1887: x [\d.]+ → 9\.5 m/);
    await page.getByRole('button', { name: 'Bring back' }).click();
    await stateIs(page, 'brought back');
    assert.notEqual((await page.evaluate(() => window.lodestar.marker(1887))).x, 9.5);
  });

  story('the installation plan has a line for each marker, on paper and as CSV', async (page) => {
    await page.evaluate(() => { window.print = () => { window.printed = document.getElementById('paper').innerHTML.length; }; });
    await page.locator('#tool-plan').click();
    await page.getByRole('dialog').getByRole('button', { name: 'Print', exact: true }).click();
    await page.waitForFunction(() => window.printed > 0, undefined, { polling: 50 });
    const count = await page.evaluate(() => window.lodestar.console.editor.markers.size);
    assert.equal(await page.locator('#paper tbody tr').count(), count);
    const line = await page.evaluate(() => [...document.querySelectorAll('#paper tbody tr')].find((row) => row.cells[0].textContent === '447').innerText || [...document.querySelectorAll('#paper tbody tr')].find((row) => row.cells[0].textContent === '447').textContent);
    assert.match(line, /left: 1\.\d{3} m/);
    assert.ok((await page.pdf()).length > 10_000);
    await page.locator('#tool-plan').click();
    const [download] = await Promise.all([page.waitForEvent('download'), page.getByRole('button', { name: 'Download as CSV' }).click()]);
    const file = join(server.site, '..', download.suggestedFilename());
    await download.saveAs(file);
    assert.equal(readFileSync(file, 'utf8').trim().split('\n').length, count + 1);
  });

  story('issues can be narrowed down to one kind', async (page) => {
    await page.locator('#issue-kind').waitFor();
    const [kind, count] = await page.evaluate(() => { const o = document.querySelector('#issue-kind option:nth-child(2)'); return [o.value, Number(o.textContent.match(/\((\d+)\)/)[1])]; });
    await page.locator('#issue-kind').selectOption(kind);
    const shown = await page.evaluate(() => [...document.querySelectorAll('#issues button[data-kind]')].map((b) => b.dataset.kind));
    assert.equal(shown.length, count);
    assert.ok(shown.every((k) => k === kind));
  });

  story('a warning may stand for a reason, for the command too, and can be had back', async (page) => {
    const issues = page.locator('#issues');
    const warning = issues.locator('.issue').first();
    const words = await warning.locator('button.warning').textContent();
    await warning.getByRole('button', { name: 'May stand' }).click();
    await page.getByRole('button', { name: 'Let it stand' }).click();
    await page.locator('#dialog-reason', { hasText: 'Say why' }).waitFor();
    await page.locator('#why').fill('the "robot" never goes: there');
    await page.keyboard.press('Enter');
    await issues.locator('summary', { hasText: '1 may stand' }).click();
    await issues.locator('details', { hasText: words }).getByText('“the "robot" never goes: there”').waitFor();
    assert.equal(await issues.locator('button.warning', { hasText: words }).count(), 0);
    const check = (...more) => spawnSync(binary, ['markers', 'check', '--site', server.site, ...more], { encoding: 'utf8' }).stdout;
    assert.match(check(), /let stand by accepted.yaml:\n  .*: the "robot" never goes: there\n/);
    assert.equal(JSON.parse(check('--json')).issues.filter((i) => i.accepted?.reason === 'the "robot" never goes: there').length, 1);
    await issues.getByRole('button', { name: 'Warn again' }).click();
    await issues.locator('button.warning', { hasText: words }).waitFor();
    assert.equal(await page.locator('#standing-issues').count(), 0);
    assert.doesNotMatch(check(), /let stand/);
  });

  story('a script in an imported file stays text', async (page) => {
    const file = join(server.site, '..', 'evil.csv');
    writeFileSync(file, 'id,x,y,z,yaw_deg,size,name\n5,1,1,2.6,0,0.12,<img src=x onerror=window.hurt=1>\n<script>window.hurt=2</script>,1,1,2.6,0,,\n');
    const [chooser] = await Promise.all([page.waitForEvent('filechooser'), page.locator('#tool-import').click()]);
    await chooser.setFiles(file);
    await stateIs(page, 'evil.csv');
    assert.ok((await page.locator('#state').innerText()).includes('<script>'));
    assert.equal(await page.evaluate(() => window.hurt), undefined);
  });
});

describe('many', () => {
  story('one of ten thousand markers follows the pointer, and is where it was left', async (page) => {
    const median = await page.evaluate(async () => {
      const { console: c } = window.lodestar;
      const markers = [];
      for (let i = 0; i < 10_000; ++i) markers.push({ id: i % 4096, x_m: 0.15 * (i % 100), y_m: 0.07 * Math.floor(i / 100), z_m: 2.6, yaw_deg: i % 360 });
      c.check = async () => {};
      c.editor.load({ alignment: { x_m: 0, y_m: 0, yaw_deg: 0 }, markers });
      const [key] = c.editor.markers.keys();
      c.editor.select([key]);
      await new Promise((done) => setTimeout(done, 500));
      const [marker] = c.editor.chosen();
      const times = [];
      for (let i = 0; i < 15; ++i) {
        const start = performance.now();
        c.editor.preview = new Map([[key, { ...marker, x: marker.x + 0.02 * i }]]);
        c.pointer.onDrag();
        await new Promise((done) => requestAnimationFrame(() => setTimeout(done)));
        times.push(performance.now() - start);
      }
      c.editor.change([...c.editor.preview.values()]);
      return times.sort((a, b) => a - b)[7];
    });
    near((await chosen(page))[0].x, 0.28, 1e-9);
    console.log(`drag one of 10,000 markers: median ${median.toFixed(0)} ms a frame`);
    assert.ok(median < 500);  // a frame is 16 ms; here only a machine that is busy with more is waited for
  });
});

describe('model', () => {
  story('random commands with undo and redo equal a list of states', async (page) => {
    const failure = await page.evaluate(() => {
      const { editor, actions } = window.lodestar.console;
      editor.onChange = () => {};
      let seed = 7;
      const random = (n) => {
        seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0;
        return Math.floor(seed / 2 ** 32 * n);
      };
      const state = () => JSON.stringify([...editor.markers.values()].sort((a, b) => a.key - b.key));
      const states = [state()];
      let at = 0;
      for (let step = 0; step < 400; ++step) {
        editor.select([...editor.markers.keys()].filter(() => random(4) === 0));
        const commands = [() => actions.duplicate(), () => actions.distribute(), () => actions.nudge(0.01 * random(9), 0.1), () => actions.turn(15),
          () => { if (editor.selection.size > 0) editor.remove([...editor.selection].slice(0, 3)); }, () => actions.addAt({ x: random(15), y: random(7) })];
        const choice = random(9);
        const before = state();
        if (choice < 6) {
          if (editor.markers.size > 60 && choice === 0) continue;
          commands[choice]();
          if (state() === before) continue;
          states.length = ++at;
          states.push(state());
        } else if (choice === 6 && at < states.length - 1) {
          editor.redo();
          ++at;
        } else if (at > 0) {
          editor.undo();
          --at;
        }
        if (state() !== states[at]) return `step ${step}, command ${choice}`;
      }
      return '';
    });
    assert.equal(failure, '');
  });
});
