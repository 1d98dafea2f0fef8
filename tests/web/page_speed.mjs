// How fast the page is on the largest site there may be: 4,096 markers on a map of 4000 x 4000 cells. Prints one line a
// figure beside its bar. Not a test: machines are shared.
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { launch, open, serveSite } from './browser.mjs';
import { labCopy } from './programs.mjs';

const cells = 4000;
const cellM = 0.05;
const roomCells = 200;  // a room of 10 x 10 m
const doorCells = 24;
const perSide = 64;     // markers: all 4,096 IDs

/** Rooms with a door in each wall. */
function drawRooms(file) {
  const gray = new Uint8Array(cells * cells).fill(254);
  const wall = (at, along) => at % roomCells < 2 && Math.abs((along % roomCells) - roomCells / 2) > doorCells / 2;
  for (let y = 0; y < cells; ++y)
    for (let x = 0; x < cells; ++x)
      if (wall(x, y) || wall(y, x) || x > cells - 3 || y > cells - 3) gray[y * cells + x] = 0;
  writeFileSync(file, Buffer.concat([Buffer.from(`P5\n${cells} ${cells}\n255\n`), gray]));
}

function largestSite() {
  const place = labCopy();
  drawRooms(join(place.site, 'map.pgm'));
  const apartM = cells * cellM / perSide;
  const rows = Array.from({ length: perSide * perSide }, (_, id) =>
    `  - {id: ${id}, x_m: ${((id % perSide + 0.4) * apartM).toFixed(3)}, y_m: ${((Math.floor(id / perSide) + 0.4) * apartM).toFixed(3)}, z_m: 2.6, yaw_deg: ${id % 360}}`);
  writeFileSync(join(place.site, 'markers.yaml'), `format: lodestar-markers\nversion: 1\nalignment: {x_m: 0, y_m: 0, yaw_deg: 0}\nmarkers:\n${rows.join('\n')}\n`);
  const site = join(place.site, 'site.yaml');
  const text = readFileSync(site, 'utf8').replace(/start: .*/, 'start: {x_m: 5, y_m: 5, yaw_deg: 0}').replace(/goals:\n(  - .*\n)+/, 'goals:\n  - {x_m: 35, y_m: 5, yaw_deg: 0}\n');
  writeFileSync(site, text);
  return place;
}

/** Begins to note the time between frames. */
const watchFrames = (page) => page.evaluate(() => {
  window.gaps = [];
  let last = performance.now();
  const next = (now) => {
    window.gaps.push(now - last);
    last = now;
    if (window.gaps !== null) window.watch = requestAnimationFrame(next);
  };
  window.watch = requestAnimationFrame(next);
});
const framesWere = (page) => page.evaluate(() => {
  cancelAnimationFrame(window.watch);
  const gaps = window.gaps.slice(1).sort((a, b) => a - b);
  return { median: gaps[Math.floor(gaps.length / 2)], p95: gaps[Math.floor(gaps.length * 0.95)], most: gaps.at(-1) };
});

const results = [];
const tell = (what, value, bar, unit = 'ms') => {
  results.push(value <= bar);
  console.log(`${what.padEnd(58)} ${value.toFixed(0).padStart(7)} ${unit}   bar ${bar} ${unit}${value <= bar ? '' : '   MISSED'}`);
};

async function dragOver(page, from, by, button, steps) {
  await page.mouse.move(...from);
  await page.mouse.down({ button });
  await watchFrames(page);
  for (let i = 1; i <= steps; ++i) await page.mouse.move(from[0] + by[0] * i / steps, from[1] + by[1] * i / steps);
  const frames = await framesWere(page);
  await page.mouse.up({ button });
  return frames;
}

/** Milliseconds from its sending to its answer. */
async function answered(page, path, ask) {
  const [response] = await Promise.all([page.waitForResponse((r) => r.url().endsWith(path), { timeout: 600_000 }), ask()]);
  await response.finished();
  return response.request().timing().responseEnd;
}

const screenOf = (page, id) => page.evaluate((wanted) => {
  const { view, stage } = window.lodestar.console;
  const marker = window.lodestar.marker(wanted);
  const at = view.toScreen({ x: marker.x + 0.04, y: marker.y + 0.04 });
  const box = document.getElementById('stage').getBoundingClientRect();
  return [box.left + at.x, box.top + at.y, stage !== undefined];
}, id);

const browser = await launch();
const server = await serveSite(largestSite());
try {
  const begin = performance.now();
  const page = await open(browser, server.url);
  page.setDefaultTimeout(600_000);  // what blocks the page is measured, not given up
  console.log(`${'page opened, coverage painted'.padEnd(58)} ${(performance.now() - begin).toFixed(0).padStart(7)} ms`);
  await page.locator('#issues', { hasText: /warning|error|None/ }).waitFor({ timeout: 600_000 });
  const middle = [500, 420];
  const far = await dragOver(page, middle, [180, 90], 'right', 60);
  tell('pan, the whole map in view: time between frames, p95', far.p95, 20);
  await page.evaluate(() => window.lodestar.console.view.fit([window.lodestar.marker(2080)], 12));
  await page.evaluate(() => window.lodestar.console.fit && window.lodestar.console.stage.redraw());
  const near = await dragOver(page, middle, [180, 90], 'right', 60);
  tell('pan, some rooms in view: time between frames, p95', near.p95, 20);

  await page.evaluate(() => { window.lodestar.console.view.fit([window.lodestar.marker(2080)], 12); window.lodestar.console.stage.redraw(); });
  const at = (await screenOf(page, 2080)).slice(0, 2);
  const check = answered(page, '/api/markers/check', async () => {
    const drag = await dragOver(page, at, [60, 30], 'left', 60);
    tell('drag of a marker, coverage follows: time between frames, p95', drag.p95, 50);
  });
  tell('check of 4,096 markers', await check, 2000);

  await watchFrames(page);
  const markers = () => page.evaluate(() => window.lodestar.console.editor.markers.size);
  const before = await markers();
  const asked = performance.now();
  await page.evaluate(() => { const { editor } = window.lodestar.console; editor.remove([...editor.markers.keys()].slice(100, 140)); });
  await page.getByRole('button', { name: 'Suggest next marker' }).click();
  await page.waitForFunction((n) => window.lodestar.console.editor.markers.size === n - 39, before, { polling: 20, timeout: 600_000 });
  const took = performance.now() - asked;
  tell('suggest: longest time between frames meanwhile', (await framesWere(page)).most, 200);
  console.log(`${'suggest: until the marker stands'.padEnd(58)} ${took.toFixed(0).padStart(7)} ms`);

  await page.locator('#stage').focus();
  tell('deviations', await answered(page, '/api/markers/deviations', () => page.keyboard.press('v')), 5000);
  tell('save', await answered(page, '/api/markers', () => page.keyboard.press('Control+s')), 1000);
} finally {
  await browser.close();
  await server.stop();
}
process.exit(results.every(Boolean) ? 0 : 1);
