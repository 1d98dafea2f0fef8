// From an empty folder to the first drive: the page without a site, by what is written on it.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { existsSync, mkdtempSync, readFileSync, readdirSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, describe, test } from 'node:test';
import { axeSource, launch, open, serve, serveRobot, serveRobotAt, serveSite } from './browser.mjs';
import { binary, source } from './programs.mjs';
import { isIdle, planned, setGoals, until } from './robot_page.mjs';

const pictures = process.env.LODESTAR_PICTURES;
let browser;
before(async () => { browser = await launch(); });
after(() => browser?.close());

const emptyPlace = () => {
  const folder = mkdtempSync(join(tmpdir(), 'lodestar-web-'));
  return { folder, site: join(folder, 'hall') };
};
const press = (page, name) => page.getByRole('button', { name, exact: true }).click();
const lacks = (page, step) => page.locator(`#new-lacks-${step}`);
const look = async (page, name) => { if (pictures) await page.screenshot({ path: join(pictures, `new-${name}.png`) }); };

/** A plan of 8 x 6 m at 50 pixels a metre, with walls of 10 cm: two rooms, and the architect's text in one of them. */
function drawPlan(file) {
  const [width, height, margin, perM] = [460, 360, 30, 50];
  const gray = new Uint8Array(width * height).fill(255);
  const box = (x0, y0, x1, y1) => {
    for (let y = y0; y < y1; ++y) gray.fill(20, y * width + x0, y * width + x1);
  };
  const [right, bottom] = [margin + 8 * perM, margin + 6 * perM];
  box(margin, margin, right, margin + 5); box(margin, bottom - 5, right, bottom);
  box(margin, margin, margin + 5, bottom); box(right - 5, margin, right, bottom);
  box(margin + 200, margin, margin + 205, margin + 130);  // between the rooms, with a door below
  for (let i = 0; i < 5; ++i) box(margin + 60 + 10 * i, margin + 200, margin + 64 + 10 * i, margin + 212);  // "ROOM 1"
  writeFileSync(file, Buffer.concat([Buffer.from(`P5\n${width} ${height}\n255\n`), gray]));
}

/** Pixels of the plan, on the screen. */
const onPlan = (page, x, y) => page.evaluate(([px, py]) => {
  const { view, canvas } = window.lodestar.newSite.stage;
  const at = view.toScreen({ x: px / 100, y: -py / 100 });
  const box = canvas.getBoundingClientRect();
  return [box.left + at.x, box.top + at.y];
}, [x, y]);
/** Cells of the map, likewise. */
const onMap = (page, x, y) => page.evaluate(([cx, cy]) => {
  const { view, canvas } = window.lodestar.newSite.stage;
  const at = view.toScreen({ x: cx, y: cy });
  const box = canvas.getBoundingClientRect();
  return [box.left + at.x, box.top + at.y];
}, [x, y]);
const cell = (page, x, y) => page.evaluate(([cx, cy]) => window.lodestar.newSite.paint.cells[cy * window.lodestar.newSite.paint.columns + cx], [x, y]);
async function drag(page, from, to) {
  await page.mouse.move(...from);
  await page.mouse.down();
  await page.mouse.move(...to, { steps: 4 });
  await page.mouse.up();
}

async function complaintsOfAxe(page) {
  await page.evaluate(axeSource);
  return page.evaluate(async () => (await window.axe.run()).violations.map((v) => `${v.id}: ${v.nodes.map((n) => n.target.join(' ')).join(', ')}`));
}

test('from a drive under markers, as the scanner saw the place', async () => {
  const place = emptyPlace();
  const drive = spawnSync(binary, ['replay', join(source, 'sites/lab'), '--people', '1', '--quiet', '-o', join(place.folder, 'runs/monday')], { encoding: 'utf8' });
  assert.equal(drive.status, 0, drive.stderr);
  const server = await serveSite(place, '--new');
  const page = await open(browser, server.url);
  await page.getByLabel('monday').waitFor();
  assert.ok(await page.getByRole('button', { name: 'Map of these drives' }).isDisabled(), 'none is chosen');
  await page.getByLabel('monday').check();
  await press(page, 'Map of these drives');
  await lacks(page, 'plan').filter({ hasText: /Of 1 drive, with \d\d markers/ }).waitFor({ timeout: 60_000 });
  const walls = await page.evaluate(() => window.lodestar.newSite.paint.cells.filter((cell) => cell === 100).length);
  assert.ok(walls > 1000, `${walls} cells of wall`);
  assert.ok(!await page.getByLabel('Hang markers wherever').isChecked(), 'they hang already');
  await look(page, '5-drive');
  await press(page, 'Make the site');
  await page.getByText('The site is made, with').waitFor({ timeout: 60_000 });
  const markers = (file) => [...readFileSync(file, 'utf8').matchAll(/id: (\d+)/g)].map((match) => match[1]);
  assert.deepEqual(markers(join(place.site, 'markers.yaml')), markers(join(place.folder, 'runs/monday/site/markers.yaml')));
  // While the console takes over the port from the page without a site, the page asks again and again.
  assert.deepEqual(page.complaints.filter((words) => !words.includes('ERR_CONNECTION_REFUSED')), []);
  await page.context().close();
  await server.end();
  const again = spawnSync(binary, ['replay', place.site, '--quiet', '-o', join(place.folder, 'runs/first')], { encoding: 'utf8' });
  await server.stop();
  assert.equal(again.status, 0, `the new site is driven on: ${again.stdout}${again.stderr}`);
});

test('from a plan to the first drive', async () => {
  const place = emptyPlace();
  const plan = join(place.folder, 'plan.pgm');
  drawPlan(plan);
  let server = await serveSite(place, '--new');
  const page = await open(browser, server.url);
  assert.equal(await lacks(page, 'plan').innerText(), 'Missing: a plan, a hall, or a drive');
  assert.ok(await page.getByRole('button', { name: 'Make the site' }).isDisabled());
  await look(page, '1-empty');

  await page.getByLabel('Picture, PDF (first page) or DXF').setInputFiles(plan);
  await lacks(page, 'plan').filter({ hasText: 'plan.pgm: 460 x 360 pixels' }).waitFor();
  assert.match(await lacks(page, 'scale').innerText(), /Missing: two points/);
  await page.mouse.click(...await onPlan(page, 30, 30));
  assert.match(await lacks(page, 'scale').innerText(), /Missing: the second point/);
  await page.mouse.click(...await onPlan(page, 430, 30));
  assert.match(await lacks(page, 'scale').innerText(), /Missing: the metres between/);
  await page.getByLabel('Metres between the two points').fill('8');
  const size = (await lacks(page, 'scale').innerText()).match(/The plan is ([\d.]+) x ([\d.]+) m/).slice(1).map(Number);
  assert.ok(Math.abs(size[0] - 9.2) < 0.1 && Math.abs(size[1] - 7.2) < 0.1, `${size}`);
  await look(page, '2-scale');

  await press(page, 'Make the map');
  await lacks(page, 'map').filter({ hasText: 'm.' }).waitFor();
  await page.locator('#map-tool-line-wall').waitFor();
  const at = [Math.round(1.3 / 0.05), Math.round((6 - 4.1) / 0.05)];
  const isWall = async () => (await page.evaluate(([x, y]) => {
    const { paint } = window.lodestar.newSite;
    let walls = 0;
    for (let dx = -6; dx < 26; ++dx) for (let dy = -10; dy < 10; ++dy) walls += paint.cells[(y + dy) * paint.columns + x + dx] === 100 ? 1 : 0;
    return walls;
  }, at)) > 0;
  assert.ok(await isWall(), 'the text is taken for walls');
  await press(page, 'Clear');
  await drag(page, await onMap(page, at[0] - 6, at[1] - 10), await onMap(page, at[0] + 26, at[1] + 10));
  assert.ok(!await isWall(), 'it is taken out');
  await page.keyboard.press('Control+z');
  assert.ok(await isWall(), 'undone');
  await page.keyboard.press('Control+Shift+Z');
  assert.ok(!await isWall(), 'done again');
  await press(page, 'Block');
  await drag(page, await onMap(page, 130, 20), await onMap(page, 140, 30));
  assert.equal(await cell(page, 135, 25), 100);
  await press(page, 'Wall');
  await drag(page, await onMap(page, 120.5, 80.5), await onMap(page, 150.5, 80.5));
  assert.equal(await cell(page, 135, 80), 100);
  assert.equal(await cell(page, 135, 81), 0);
  await press(page, 'Erase');
  await drag(page, await onMap(page, 115.5, 80.5), await onMap(page, 155.5, 80.5));
  assert.equal(await cell(page, 135, 80), 0);
  await look(page, '3-map');
  await press(page, 'Make the map');
  await page.getByText('What you have drawn on the present one is lost.').waitFor();
  await press(page, 'Keep it');
  assert.equal(await cell(page, 135, 25), 100);

  await page.getByLabel('Ceiling above the floor').fill('1.2');
  assert.match(await lacks(page, 'robot').innerText(), /wanted a number from 1.5 to 30/);
  await page.getByLabel('Ceiling above the floor').fill('2.7');
  await page.getByLabel('Camera above the floor').fill('0.9');
  await page.getByLabel('Radius of the robot').fill('0.3');
  assert.deepEqual(await complaintsOfAxe(page), []);
  assert.ok(!existsSync(place.site), 'nothing is written so far');
  await press(page, 'Make the site');
  await page.getByText('The site is made, with').waitFor({ timeout: 60_000 });
  await page.getByText('of the floor where the robot can stand').waitFor();
  const covered = Number((await page.getByText('of the floor where the robot can stand').innerText()).match(/([\d.]+) %/)[1]);
  assert.ok(covered > 99, `${covered} %`);
  await look(page, '4-console');
  assert.match(readFileSync(join(place.site, 'robot.yaml'), 'utf8'), /^radius_m: 0.3\n[^]*z_m: 0.9,/m);
  assert.match(readFileSync(join(place.site, 'markers.yaml'), 'utf8'), /z_m: 2.7/);
  // While the console takes over the port from the page without a site, the page asks again and again.
  assert.deepEqual(page.complaints.filter((words) => !words.includes('ERR_CONNECTION_REFUSED')), []);
  await page.context().close();
  await server.end();

  server = await serveRobotAt({ ...place }, '--goal', '1,1');
  const live = await open(browser, server.url);
  await until(live, isIdle);
  const { x_m: x, y_m: y } = await live.evaluate(() => window.lodestar.console.live.state.pose);
  const goal = [x > 4 ? 1.5 : 6.5, y > 3 ? 1.0 : 5.0];
  await setGoals(live, goal);
  await planned(live);
  await live.getByRole('button', { name: 'Drive', exact: true }).click();
  await live.waitForFunction(([gx, gy]) => {
    const s = window.lodestar.console.live.state;
    return !s.moving && s.pose !== null && Math.hypot(s.pose.x_m - gx, s.pose.y_m - gy) < 0.03;
  }, goal, { polling: 50, timeout: 60_000 });
  await look(live, '5-drive');
  assert.deepEqual(live.complaints, []);
  await live.context().close();
  await server.stop();
});

/** Cells of the map that is drawn on, on the screen, and their values. */
const drawnAt = (page, x, y) => page.evaluate(([cx, cy]) => {
  const { view, canvas } = window.lodestar.console.map.stage;
  const at = view.toScreen({ x: cx, y: cy });
  const box = canvas.getBoundingClientRect();
  return [box.left + at.x, box.top + at.y];
}, [x, y]);
const served = (page, x, y) => page.evaluate(([cx, cy]) => {
  const { floor } = window.lodestar.console;
  return floor.cells[cy * floor.info.columns + cx];
}, [x, y]);

describe('the map of a site that is there', () => {
  test('is drawn on and saved, the site is loaded anew, and what was before is kept', async () => {
    const site = await serve();
    const page = await open(browser, site.url);
    const [x, y] = [30, 100];  // in the upper left room
    assert.equal(await served(page, x, y), 0);
    await press(page, 'Map');
    await page.getByText('Nothing has changed').waitFor();
    await press(page, 'Block');
    await drag(page, await drawnAt(page, x - 2, y - 2), await drawnAt(page, x + 3, y + 2));
    await page.getByText(/0\.\d\d m² changed/).waitFor();
    await look(page, 'map');
    assert.deepEqual(await complaintsOfAxe(page), []);
    await press(page, 'Save the map');
    await page.getByText('The map is saved.').waitFor({ timeout: 60_000 });
    assert.equal(await served(page, x, y), 100);
    assert.equal(readdirSync(join(site.site, '.history', 'map')).length, 1);
    assert.deepEqual(page.complaints.filter((words) => !words.includes('ERR_CONNECTION_REFUSED')), []);
    await page.context().close();
    await site.stop();
  });

  test('stays as it is under a robot', async () => {
    const robot = await serveRobot();
    const page = await open(browser, robot.url);
    await until(page, isIdle);
    await press(page, 'Map');
    await page.getByText('A robot runs on this map.').waitFor();
    assert.deepEqual(page.complaints, []);
    await page.context().close();
    await robot.stop();
  });
});

describe('what cannot be', () => {
  test('is said: no plan, no scale of a drawing, a name that is taken', async () => {
    const place = emptyPlace();
    const server = await serveSite(place, '--new');
    const page = await open(browser, server.url, { width: 390, height: 844 });
    const file = join(place.folder, 'notes.png');
    writeFileSync(file, 'no picture');
    await page.getByLabel('Picture, PDF (first page) or DXF').setInputFiles(file);
    await page.getByText('notes.png: found no picture that can be read').waitFor();
    await page.getByLabel('Width (m)').fill('0.5');
    await press(page, 'Empty hall');
    await page.getByText('Width (m): wanted a number from 1 to 1000').waitFor();
    await page.getByLabel('Width (m)').fill('5');
    await press(page, 'Empty hall');
    await lacks(page, 'map').filter({ hasText: '5.10 x 6.10 m' }).waitFor();
    await look(page, 'phone');
    writeFileSync(place.site, 'somebody was faster');
    await press(page, 'Make the site');
    await page.getByText('found something of that name').waitFor();
    assert.equal(readFileSync(place.site, 'utf8'), 'somebody was faster');
    assert.deepEqual(page.complaints, []);
    await page.context().close();
    await server.stop();
  });

  test('is not for those who only look', async () => {
    const place = emptyPlace();
    const server = await serveSite(place, '--new', '--view-token', 'only-looking-0123456', '--token', 'may-do-all-0123456789');
    const put = (token) => fetch(`${server.url.split('#')[0]}api/new/map`, { method: 'PUT', body: JSON.stringify({ hall_m: [5, 5], cell_m: 0.05 }),
      headers: { 'Content-Type': 'application/json', 'X-Lodestar': '1', Authorization: `Bearer ${token}` } }).then((answer) => answer.status);
    assert.equal(await put('only-looking-0123456'), 403);
    assert.equal(await put('may-do-all-0123456789'), 200);
    assert.deepEqual(readdirSync(place.folder), []);
    await server.stop();
  });
});
