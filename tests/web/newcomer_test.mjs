// Somebody who has never seen the page goes all the way with what it says: no keys, no functions of the page, only what
// is written on it. With LODESTAR_PICTURES=FOLDER each step leaves a picture there.
import assert from 'node:assert/strict';
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { labCopy, launch, open, serveRobotAt, serveSite } from './browser.mjs';

const pictures = process.env.LODESTAR_PICTURES;
const wanted = 15;
let browser;
let server;
before(async () => { browser = await launch(); });
after(async () => {
  await browser?.close();
  await server?.stop();
});

let taken = 0;
async function look(page, name) {
  if (pictures) await page.screenshot({ path: join(pictures, `${String(++taken).padStart(2, '0')}-${name}.png`) });
}

const press = (page, name) => page.getByRole('button', { name, exact: true }).click();
const says = (page, words) => page.getByRole('status').filter({ hasText: words }).waitFor({ timeout: 60_000 });
const numberIn = async (place, pattern) => Number((await place.innerText()).match(pattern)?.[1] ?? NaN);

/** What the page says of its coverage, once it says that something has changed. */
async function coverageAfter(page, act) {
  const words = page.getByText('of the floor where the robot can stand');
  const before = await words.innerText();
  await act();
  await page.waitForFunction((old) => !document.body.innerText.includes(old), before, { polling: 50 });
  return numberIn(words, /([\d.]+) %/);
}

/** The largest gap that the page lists, in square metres. */
const largestGap = async (page) => Math.max(0, ...(await page.getByRole('button', { name: 'without any marker' }).allInnerTexts()).map(Number.parseFloat));

/** Where a place of the map is drawn. */
const drawnAt = (page, x, y) => page.evaluate(([mx, my]) => window.lodestar.console.view.toScreen({ x: mx, y: my }), [x, y]);

/** Drags on the map; places as shares of its width and height. */
async function dragOnMap(page, [fromX, fromY], [toX, toY]) {
  const box = await page.getByRole('application').boundingBox();
  const at = (x, y) => [box.x + x * box.width, box.y + y * box.height];
  await page.mouse.move(...at(fromX, fromY));
  await page.mouse.down();
  await page.mouse.move(...at((fromX + toX) / 2, (fromY + toY) / 2));
  await page.mouse.move(...at(toX, toY));
  await page.mouse.up();
}

test('a newcomer hangs fifteen markers, prints them, drives by them, and looks at the run', async () => {
  const place = labCopy();
  const file = join(place.site, 'markers.yaml');
  writeFileSync(file, readFileSync(file, 'utf8').replace(/markers:[^]*/, 'markers: []\n'));
  server = await serveSite(place);
  let page = await open(browser, server.url);
  const coverage = page.getByText('of the floor where the robot can stand');
  await page.getByText('0.0 % of the floor').waitFor();
  await page.getByText('the usual route sees no marker').first().waitFor();
  const emptyGap = await largestGap(page);
  assert.ok(emptyGap > 50, `${emptyGap}`);
  await look(page, 'empty');

  // One by hand, one by numbers, the others where the page would hang them.
  let share = await coverageAfter(page, () => press(page, 'Add'));
  await dragOnMap(page, [0.5, 0.5], [0.4, 0.42]);
  await page.getByLabel('z (m)').fill('2.6');
  await look(page, 'first');
  await press(page, 'Add');
  await page.getByLabel('x (m)').fill('1.3');
  await page.getByLabel('y (m)').fill('5.7');
  share = await coverageAfter(page, () => page.keyboard.press('Tab'));
  assert.ok(share > 5, `${share}`);
  for (let i = 2; i < wanted; ++i) {
    const next = await coverageAfter(page, () => press(page, 'Suggest next marker'));
    assert.ok(next > share, `marker ${i + 1}: ${share} to ${next} %`);
    share = next;
    if (i === 7) await look(page, 'half');
  }
  console.log(`fifteen markers: ${(await coverage.innerText()).split(',')[0]}`);
  assert.ok(share > 50, `${share}`);
  await page.waitForFunction((n) => Number.parseInt(document.body.innerText.match(/(\d+) warnings/)?.[1] ?? '0', 10) > n, 5, { polling: 100 });
  const gap = await largestGap(page);
  assert.ok(gap > 0 && gap < 0.3 * emptyGap, `${emptyGap} to ${gap} m²`);
  await look(page, 'fifteen');
  await page.getByRole('button', { name: 'without any marker' }).first().click();
  await look(page, 'gap');
  await press(page, 'Fit');

  await press(page, 'Save');
  await says(page, 'Saved 15 markers');
  assert.equal(server.markersFile().match(/- \{id:/g).length, wanted);
  await page.getByRole('application').click({ position: { x: 5, y: 300 } });  // nothing is chosen any more: all are meant
  await press(page, 'Print');
  await page.getByText('15 sheets').waitFor();
  await look(page, 'print');
  const [sheets] = await Promise.all([page.waitForEvent('download'), press(page, 'Download')]);
  const pdf = readFileSync(await sheets.path(), 'latin1');
  assert.equal(pdf.match(/\/Type \/Page\b(?!s)/g).length, wanted);
  assert.deepEqual(page.complaints, []);
  await page.context().close();
  await server.end();

  // The sheets hang; the robot is switched on.
  server = await serveRobotAt(place);
  page = await open(browser, server.url);
  await page.getByText('waiting for a goal').waitFor({ timeout: 30_000 });
  await look(page, 'live');
  const map = await page.getByRole('application').boundingBox();
  const goal = await drawnAt(page, 2.3, 4.9);
  await page.mouse.click(map.x + goal.x, map.y + goal.y);
  await page.getByText(/about \d+ s/).waitFor();
  await look(page, 'preview');
  await press(page, 'Drive');
  await page.waitForFunction(() => document.body.innerText.match(/arrived/g)?.length >= 2, undefined, { polling: 100 });  // as it did when it was switched on
  await page.getByText('nobody', { exact: true }).waitFor();
  await look(page, 'arrived');

  await press(page, 'Replay');
  const time = page.getByLabel('Time', { exact: true });
  await look(page, 'runs');
  await time.waitFor();
  await page.getByRole('option', { name: 'run-2' }).waitFor({ state: 'attached' });
  await page.getByRole('combobox', { name: 'Run', exact: true }).selectOption('run-2');
  await page.getByText(/2\.30, 4\.90 m: reached/).waitFor();
  const [begin, end] = [Number(await time.getAttribute('min')), Number(await time.getAttribute('max'))];
  assert.ok(begin > 1 && end > begin + 1, `${begin} to ${end}`);  // the clock of the robot went on
  const middle = (Math.round(5 * (begin + end)) + 0.2) / 10;  // no digit that rounding could change
  await time.fill(middle.toFixed(2));
  await page.getByText(`${middle.toFixed(1)} of ${end.toFixed(1)} s`).waitFor();
  await look(page, 'replay');
  assert.deepEqual(page.complaints, []);
  await page.context().close();
}, { timeout: 240_000 });
