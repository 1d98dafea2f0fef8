// Ladder mode: who hangs the markers reads where each goes, says that it hangs, and the robot verifies it.
import assert from 'node:assert/strict';
import { existsSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { axeSource, launch, open, serve, serveRobot } from './browser.mjs';
import { isIdle, until } from './robot_page.mjs';

const pictures = process.env.LODESTAR_PICTURES;
let browser;
before(async () => { browser = await launch(); });
after(() => browser?.close());

const press = (page, name) => page.getByRole('button', { name, exact: true }).click();
const hanging = (site) => readFileSync(join(site.site, 'hanging.yaml'), 'utf8');
const progress = (page, words) => page.locator('#hang-progress', { hasText: words }).waitFor();
const idOf = async (page) => Number((await page.locator('#hang-id').innerText()).replace('Marker ', ''));

test('on a phone: each marker with its two walls, hung one after the other, with a photo', async () => {
  const site = await serve();
  const page = await open(browser, site.url, { width: 390, height: 844 }, { hasTouch: true });
  await press(page, 'Hang');
  await progress(page, /^0 of 25 hang, 0 verified$/);
  const first = await idOf(page);
  assert.match(await page.locator('.hang-ways').innerText(), /\d\.\d{3} m from the wall on the (left|right)\n\d\.\d{3} m from the wall (below|above)\n\d\.\d\d m above the floor/);
  await press(page, 'Hung');
  await progress(page, /^1 of 25 hang/);
  const second = await idOf(page);
  assert.notEqual(second, first);
  const { markers } = await page.evaluate(() => ({ markers: window.lodestar.console.hang.markers }));
  const place = (id) => markers.find((marker) => marker.id === id);
  const apart = (a, b) => Math.hypot(a.x_m - b.x_m, a.y_m - b.y_m);
  for (const marker of markers.filter((one) => one.state === 'planned'))
    assert.ok(apart(marker, place(first)) >= apart(place(second), place(first)) - 1e-9, `${marker.id} is nearer than ${second}`);
  assert.match(hanging(site), new RegExp(`- \\{id: ${first}, state: hung, at: "\\d{4}-\\d\\d-\\d\\dT`));

  const jpeg = await page.evaluate(() => {
    const canvas = document.createElement('canvas');
    [canvas.width, canvas.height] = [2400, 1200];
    canvas.getContext('2d').fillRect(0, 0, 900, 900);
    return canvas.toDataURL('image/jpeg').split(',')[1];
  });
  await page.locator('#hang-photo').setInputFiles({ name: 'photo.jpg', mimeType: 'image/jpeg', buffer: Buffer.from(jpeg, 'base64') });
  await page.getByRole('img', { name: `Photo of marker ${second}` }).waitFor();
  assert.equal(await page.getByRole('img', { name: `Photo of marker ${second}` }).evaluate(async (image) => { await image.decode(); return image.naturalWidth; }), 1600);
  assert.ok(existsSync(join(site.site, 'photos', `${second}.jpg`)));
  await press(page, 'Hung');
  await progress(page, /^2 of 25 hang/);
  if (pictures) await page.screenshot({ path: join(pictures, 'hang-phone.png') });

  await page.evaluate(axeSource);
  assert.deepEqual(await page.evaluate(async () => (await window.axe.run()).violations.map((v) => v.id)), []);
  await page.reload();
  await page.waitForFunction(() => window.lodestar !== undefined, undefined, { polling: 100 });
  await press(page, 'Hang');
  await progress(page, /^2 of 25 hang/);
  assert.deepEqual(page.complaints, []);
  await page.context().close();
  await site.stop();
});

test('a click on the map chooses; what hangs and is read by the robot is verified by it', async () => {
  const robot = await serveRobot();
  const page = await open(browser, robot.url);
  await until(page, isIdle);
  const seen = await page.evaluate(() => window.lodestar.console.live.state.markers[0]);
  await press(page, 'Hang');
  await progress(page, /^0 of 25/);
  const at = await page.evaluate((id) => {
    const { stage, view } = window.lodestar.console;
    return view.toScreen(stage.placeOfId(id));
  }, seen);
  const box = await page.locator('#stage').boundingBox();
  await page.mouse.click(box.x + at.x, box.y + at.y);
  assert.equal(await idOf(page), seen);
  await page.locator('#hang-reading', { hasText: 'The robot reads it now' }).waitFor();
  await press(page, 'Hung');
  await progress(page, /^1 of 25 hang, 1 verified$/);
  assert.match(hanging(robot), new RegExp(`- \\{id: ${seen}, state: verified, at: "[^"]*", by: "the robot"`));
  if (pictures) await page.screenshot({ path: join(pictures, 'hang-robot.png') });
  await page.mouse.click(box.x + at.x, box.y + at.y);
  await press(page, 'Not hung');
  await progress(page, /^0 of 25/);
  assert.deepEqual(page.complaints, []);
  await page.context().close();
  await robot.stop();
});
