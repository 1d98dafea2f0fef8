// Zones, lanes and places: drawn on the map, saved, and obeyed by the robot that runs.
import assert from 'node:assert/strict';
import { appendFileSync, existsSync, readFileSync, readdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, describe, test } from 'node:test';
import { axeSource, labCopy, launch, open, serve, serveRobot, serveRobotAt, serveSite } from './browser.mjs';
import { isIdle, isMoving, leave, planned, setGoals, until } from './robot_page.mjs';

let browser;
before(async () => { browser = await launch(); });
after(() => browser?.close());

const pictures = process.env.LODESTAR_PICTURES;
const radiusM = 0.25;  // of the lab's robot, rounded down
const file = (site) => readFileSync(join(site.site, 'places.yaml'), 'utf8');
const stateIs = (page, text) => page.locator('#state', { hasText: text }).waitFor();
const editorOf = (page) => page.evaluate(() => window.lodestar.console.places.editor.document());
const isRead = (page) => page.waitForFunction(() => window.lodestar.console.places.etag !== '', undefined, { polling: 50 });

/** Where the robot believed to be, step by step in a drive, and what it was commanded: [x, y, m/s]. */
function drivenIn(robot, run) {
  const [names, ...rows] = readFileSync(join(robot.runs, run, 'steps.csv'), 'utf8').trim().split('\n').map((row) => row.split(','));
  const columns = ['x_m', 'y_m', 'commanded_mps'].map((name) => names.indexOf(name));
  return rows.filter((row) => row[columns[0]] !== '').map((row) => columns.map((column) => Number(row[column])));
}
/** In all its drives. */
const drivenTrack = (robot) => readdirSync(robot.runs).flatMap((run) => drivenIn(robot, run));

async function clickMap(page, x, y) {
  const box = await page.locator('#stage').boundingBox();
  const at = await page.evaluate(([mx, my]) => window.lodestar.console.view.toScreen({ x: mx, y: my }), [x, y]);
  await page.mouse.click(box.x + at.x, box.y + at.y);
}

async function drag(page, from, to) {
  const box = await page.locator('#stage').boundingBox();
  const [a, b] = await page.evaluate((points) => points.map(([x, y]) => window.lodestar.console.view.toScreen({ x, y })), [from, to]);
  await page.mouse.move(box.x + a.x, box.y + a.y);
  await page.mouse.down();
  await page.mouse.move(box.x + b.x, box.y + b.y, { steps: 4 });
  await page.mouse.up();
}

/** The mode, with the left room of the lab large on the screen. */
async function draw(page) {
  await isRead(page);
  await page.locator('#tool-places').click();
  await page.evaluate(() => window.lodestar.console.goTo([{ x: 0.4, y: 4.4 }, { x: 5.2, y: 7.4 }]));
}

async function polygon(page, tool, corners) {
  await page.locator(`#tool-draw-${tool}`).click();
  for (const [x, y] of corners) await clickMap(page, x, y);
  await page.keyboard.press('Enter');
}

async function rename(page, name) {
  await page.locator('#place-name').fill(name);
  await page.keyboard.press('Enter');
}

async function complaintsOfAxe(page) {
  await page.evaluate(axeSource);
  return page.evaluate(async () => (await window.axe.run()).violations.map((v) => `${v.id}: ${v.nodes.map((n) => n.target.join(' ')).join(', ')}`));
}

/** Below the cupboard of the left room: the way that the robot takes without it. */
const across = [[3, 4.9], [3.6, 4.9], [3.6, 5.9], [3, 5.9]];

describe('the dock', () => {
  test('is driven to by a button, and the battery says that it charges; goals come behind those of a drive', async () => {
    const place = labCopy();
    writeFileSync(join(place.site, 'places.yaml'), 'format: lodestar-places\nversion: 1\nplaces:\n  - {name: dock, x_m: 1, y_m: 5.6, yaw_deg: 180}\n');
    appendFileSync(join(place.site, 'site.yaml'), 'charging: {place: dock, full_v: 29}\n');
    const robot = await serveRobotAt(place, '--realtime');
    const page = await open(browser, robot.url);
    await until(page, isIdle);
    await page.locator('#tool-live').click();
    await setGoals(page, [2.4, 5.2]);
    await planned(page);
    assert.equal(await page.locator('#drive-more').isVisible(), false);
    await page.getByRole('button', { name: 'Drive', exact: true }).click();
    await until(page, isMoving);
    await setGoals(page, [1.6, 5.2]);
    await planned(page);
    await page.locator('#drive-more').click();
    await until(page, () => window.lodestar.console.live.state.goals.length === 2);
    await until(page, () => { const s = window.lodestar.console.live.state; return !s.moving && Math.hypot(s.pose.x_m - 1.6, s.pose.y_m - 5.2) < 0.02; });
    await page.locator('#drive-charge').click();
    await until(page, () => window.lodestar.console.live.state.charging === 'charging');
    assert.match(await page.locator('#robot').textContent(), /Battery2[67]\.\d.V, charging/);
    assert.deepEqual(await complaintsOfAxe(page), []);
    if (pictures) await page.screenshot({ path: join(pictures, 'charging.png') });
    await page.locator('#live-stop').click();
    await leave(page);
    await robot.stop();
  });
});

describe('a keep-out', () => {
  test('and a one-way lane are drawn, saved and read again, and the running robot keeps out', async () => {
    const robot = await serveRobot();
    const page = await open(browser, robot.url);
    await until(page, isIdle);
    await draw(page);
    await polygon(page, 'keep_out', across);
    await rename(page, 'glass');
    await page.keyboard.press('Escape');
    await page.locator('#tool-draw-edge').click();
    await clickMap(page, 1.5, 5.2);
    await clickMap(page, 2.4, 5.2);
    await page.locator('#stage').press('Escape');
    await page.locator('#place-one-way').check();
    await page.waitForFunction(() => Object.keys(localStorage).some((key) => key.startsWith('lodestar-places-draft')), undefined, { polling: 50 });
    await page.locator('#place-speed').fill('0.3');
    await page.keyboard.press('Enter');
    await page.keyboard.press('Control+s');
    await stateIs(page, 'the robot obeys');
    assert.match(file(robot), /- \{name: "glass", corners_m: \[\[3, 4.9\], \[3.6, 4.9\], \[3.6, 5.9\], \[3, 5.9\]\]\}/);
    assert.match(file(robot), /- \{from: "N1", to: "N2", one_way: true, max_mps: 0.3\}/);

    assert.equal(await page.evaluate(() => Object.keys(localStorage).find((key) => key.startsWith('lodestar-places-draft'))), undefined);

    await page.reload();
    await until(page, isIdle);
    await isRead(page);
    assert.equal((await editorOf(page)).keep_out[0].name, 'glass');
    await until(page, () => window.lodestar.console.live.state.events.some((e) => e.words.includes('1 keep-out')));
    await setGoals(page, [4.6, 5.4]);
    await planned(page);
    const { points } = await page.evaluate(() => window.lodestar.console.live.preview);
    assert.ok(points.some(([, y]) => y > 6.6), `the preview goes over the cupboard: ${JSON.stringify(points)}`);
    await page.getByRole('button', { name: 'Drive', exact: true }).click();
    await until(page, () => window.lodestar.console.live.state.events.some((e) => e.words.includes('arrived')) && !window.lodestar.console.live.state.moving
      && Math.abs(window.lodestar.console.live.state.pose.x_m - 4.6) < 0.05);
    await leave(page);
    await robot.end();  // the page sees a drive faster than real time in leaps; its record has each step
    const track = drivenTrack(robot);
    assert.ok(track.some(([x]) => x > 4.5), 'the record has the drive to the goal');
    for (const [x, y] of track) {
      const apart = Math.hypot(Math.max(3 - x, 0, x - 3.6), Math.max(4.9 - y, 0, y - 5.9));
      assert.ok(apart > radiusM, `${x}, ${y}: ${apart} m from the keep-out`);
    }
    await robot.stop();
  });

  test('is dragged by its corners, and all of it can be undone', async () => {
    const site = await serve();
    const page = await open(browser, site.url);
    await draw(page);
    await polygon(page, 'keep_out', across);
    await drag(page, [3.6, 5.9], [4.2, 5.5]);
    assert.deepEqual((await editorOf(page)).keep_out[0].corners_m[2], [4.2, 5.5]);
    await drag(page, [3, 5.4], [2.6, 5.4]);  // the middle of a side: another corner
    assert.equal((await editorOf(page)).keep_out[0].corners_m.length, 5);
    await page.locator('#stage').press('Delete');
    assert.equal((await editorOf(page)).keep_out[0].corners_m.length, 4);
    await page.locator('#stage').press('ArrowRight');
    assert.deepEqual((await editorOf(page)).keep_out[0].corners_m[0], [3.01, 4.9]);
    for (let i = 0; i < 4; ++i) await page.keyboard.press('Control+z');
    assert.deepEqual((await editorOf(page)).keep_out[0].corners_m, across);
    await page.keyboard.press('Control+z');
    assert.deepEqual((await editorOf(page)).keep_out, []);
    await page.keyboard.press('Control+Shift+Z');
    assert.equal((await editorOf(page)).keep_out.length, 1);
    await leave(page);
    await site.stop();
  });
});

describe('one-way lanes', () => {
  /** A round in the left room, one way only. */
  const round = { A: [1.4, 5.6], B: [2.3, 5.6], C: [1.9, 5.2] };
  const lanes = `format: lodestar-places
version: 1
places: []
nodes:
${Object.entries(round).map(([name, [x, y]]) => `  - {name: "${name}", x_m: ${x}, y_m: ${y}}`).join('\n')}
edges:
  - {from: "A", to: "B", one_way: true, max_mps: 0.3}
  - {from: "B", to: "C", one_way: true}
  - {from: "C", to: "A", one_way: true}
keep_out: []
speed_zones: []
missions: []
`;
  const goTo = async (page, [x, y]) => {
    await setGoals(page, [x, y]);
    await planned(page);
    await page.getByRole('button', { name: 'Drive', exact: true }).click();
    await until(page, ([gx, gy]) => { const s = window.lodestar.console.live.state; return !s.moving && Math.hypot(s.pose.x_m - gx, s.pose.y_m - gy) < 0.05; }, [x, y]);
  };
  const passes = (track, [x, y]) => track.some(([tx, ty]) => Math.hypot(tx - x, ty - y) < 0.06);

  test('are driven their way only, and at their speed; without the tick the robot drives as it likes', async () => {
    const place = labCopy();
    writeFileSync(join(place.site, 'places.yaml'), lanes);
    const robot = await serveRobotAt(place);
    const page = await open(browser, robot.url);
    await until(page, isIdle);
    await until(page, () => !document.getElementById('along-lanes').parentElement.parentElement.hidden);
    assert.ok(await page.locator('#along-lanes').isChecked());
    await goTo(page, round.A);
    await goTo(page, round.B);
    await goTo(page, round.A);  // only by way of C
    await page.getByLabel('Along the lanes').uncheck();
    await goTo(page, round.B);
    await goTo(page, round.A);  // straight back
    assert.deepEqual(page.complaints, []);
    await leave(page);
    await robot.end();
    const drives = readdirSync(robot.runs).sort((a, b) => a.localeCompare(b, undefined, { numeric: true })).map((run) => drivenIn(robot, run));
    assert.equal(drives.length, 6);
    assert.ok(!passes(drives[2], round.C) && passes(drives[3], round.C) && !passes(drives[5], round.C));
    for (const [x, y] of drives[2].filter(([at]) => at > 1.45)) assert.ok(Math.abs(y - 5.6) < 0.03, `${x}, ${y}: beside the lane`);
    assert.ok(Math.max(...drives[2].map(([,, mps]) => mps)) < 0.31 && Math.max(...drives[4].map(([,, mps]) => mps)) > 0.31);
    await robot.stop();
  });
});

describe('by the keyboard alone', () => {
  test('a speed zone is made by numbers, and what is refused says why and keeps what was', async () => {
    const site = await serve();
    const page = await open(browser, site.url);
    await draw(page);
    await page.locator('#new-speed_zone').press('Enter');
    assert.equal(await page.evaluate(() => document.activeElement.id), 'place-name');
    await page.keyboard.type('ward');
    await page.keyboard.press('Tab');
    await page.locator('#place-speed').fill('9');
    await page.keyboard.press('Enter');
    await page.locator('#place-reason', { hasText: '0.02 to 5' }).waitFor();
    assert.equal(await page.locator('#place-speed').getAttribute('aria-invalid'), 'true');
    assert.equal((await editorOf(page)).speed_zones[0].max_mps, 0.25);
    await page.locator('#place-speed').fill('0.4');
    await page.keyboard.press('Enter');
    await page.locator('#corner-x-0').fill('1.5');
    await page.keyboard.press('Enter');
    await page.locator('#new-place').press('Enter');
    await rename(page, '1,2');
    await page.locator('#place-reason', { hasText: 'pair of numbers' }).waitFor();
    await rename(page, 'desk');
    await page.locator('#place-heading').fill('90');
    await page.keyboard.press('Enter');
    await page.keyboard.press('Control+s');
    await stateIs(page, 'Saved');
    assert.match(file(site), /- \{name: "ward", corners_m: \[\[1.5, .*max_mps: 0.4\}/);
    assert.match(file(site), /- \{name: "desk", x_m: .*, yaw_deg: 90\}/);
    await leave(page);
    await site.stop();
  });

  test('the server blames the zone that crosses itself, and nothing is written', async () => {
    const site = await serve();
    const page = await open(browser, site.url);
    await draw(page);
    await polygon(page, 'keep_out', [[1, 5], [2, 6], [2, 5], [1, 6]]);
    await rename(page, 'bow');
    const blamed = page.locator('#place-issues button[data-kind="refused"]', { hasText: 'bow: found 4 corners of no polygon' });
    await blamed.waitFor();
    await page.keyboard.press('Control+s');
    await stateIs(page, 'no polygon');
    assert.equal(existsSync(join(site.site, 'places.yaml')), false);
    await leave(page);
    await site.stop();
  });
});

describe('others', () => {
  test('read what was saved, and whoever saves second is asked and can merge', async () => {
    const site = await serve();
    const one = await open(browser, site.url);
    const two = await open(browser, site.url);
    await draw(one);
    await draw(two);
    await polygon(one, 'keep_out', across);
    await one.keyboard.press('Control+s');
    await stateIs(one, 'Saved');
    await stateIs(two, 'Somebody else saved');
    assert.equal((await editorOf(two)).keep_out.length, 1);

    await polygon(two, 'speed_zone', [[1, 5], [2, 5], [2, 6]]);
    await polygon(one, 'speed_zone', [[4, 5], [5, 5], [5, 6]]);
    await rename(one, 'mine');
    await two.keyboard.press('Control+s');
    await stateIs(two, 'Saved');
    await stateIs(one, 'Somebody else saved');
    await one.keyboard.press('Control+s');
    await one.locator('#dialog', { hasText: 'speed zone mine: added' }).waitFor();
    await one.getByRole('button', { name: 'Merge and save' }).click();
    await stateIs(one, 'Merged');
    assert.match(file(site), /"mine"/);
    assert.match(file(site), /"Speed zone 1"/);
    await one.locator('#tool-places-history').click();
    await one.locator('#dialog', { hasText: 'Changed since then' }).waitFor();
    await one.keyboard.press('Escape');
    await leave(two);
    await leave(one);
    await site.stop();
  });

  test('a draft survives the page, and findings follow what is drawn', async () => {
    const place = labCopy();
    const site = await serveSite(place);
    const page = await open(browser, site.url);
    await draw(page);
    await page.locator('#tool-draw-place').click();
    await clickMap(page, 2, 5.5);
    await page.locator('#stage').press('Escape');
    await polygon(page, 'keep_out', [[1.5, 5], [2.5, 5], [2.5, 6], [1.5, 6]]);
    await page.locator('#place-issues button[data-kind="in-keep-out"]', { hasText: 'Place 1' }).waitFor();
    page.on('dialog', (dialog) => dialog.accept());
    await page.reload();
    await page.getByRole('button', { name: 'Bring them back' }).click();
    await stateIs(page, 'Brought');
    assert.equal((await editorOf(page)).keep_out.length, 1);
    await leave(page);
    await site.stop();
  });
});

describe('legible and accessible', () => {
  for (const [name, size] of [['wide', { width: 1280, height: 800 }], ['phone', { width: 390, height: 844 }]]) {
    for (const theme of ['light', 'dark']) {
      test(`${name}, ${theme}`, async () => {
        const site = await serve();
        const page = await open(browser, site.url, size, { colorScheme: theme, bypassCSP: true });
        await isRead(page);
        await page.locator('#tool-places').click();
        await page.evaluate(() => {
          const { places } = window.lodestar.console;
          places.editor.replaceAll({ format: 'lodestar-places', version: 1,
            places: [{ name: 'desk', x_m: 2.5, y_m: 5.2, yaw_deg: 90 }, { name: 'door', x_m: 13.5, y_m: 2 }], nodes: [{ name: 'N1', x_m: 1.7, y_m: 4.1 }, { name: 'N2', x_m: 7.5, y_m: 4.1 }],
            edges: [{ from: 'N1', to: 'desk', one_way: true, max_mps: 0.3 }, { from: 'N1', to: 'N2', one_way: true }, { from: 'N2', to: 'door' }],
            keep_out: [{ name: 'stairs', corners_m: [[9, 5.5], [10.4, 5.3], [10.6, 6.9], [9.2, 7]] }, { corners_m: [[4, 1.5], [5, 1.5], [5, 2.4], [4, 2.4]] }],
            speed_zones: [{ name: 'ward', corners_m: [[5.2, 3.2], [8.6, 3.2], [8.6, 4.8], [5.2, 4.8]], max_mps: 0.25 }], missions: [] });
          places.editor.select(places.editor.state.items.find((i) => i.name === 'stairs').key, 1);
        });
        await page.locator('#place-issues button').first().waitFor();
        assert.deepEqual(await complaintsOfAxe(page), []);
        if (pictures) await page.screenshot({ path: join(pictures, `zones-${name}-${theme}.png`) });
        await page.evaluate(() => window.lodestar.console.places.editor.load(window.lodestar.console.places.base));
        await leave(page);
        await site.stop();
      });
    }
  }
});
