// The live view and the replay, with a simulated robot behind them.
import assert from 'node:assert/strict';
import { existsSync, readFileSync } from 'node:fs';
import { connect } from 'node:net';
import { join } from 'node:path';
import { after, before, describe, test } from 'node:test';
import { axeSource, labCopy, launch, open, serve, serveRobot, serveRobotAt, withOutline } from './browser.mjs';

let browser;
let robot;
before(async () => {
  browser = await launch();
  robot = await serveRobot();
});
after(async () => {
  await browser?.close();
  await robot?.stop();
});

/** Waits for the robot to be in a state; `holds` sees the page's live view. */
const until = (page, holds, what) => page.waitForFunction(holds, what, { polling: 50, timeout: 30_000 });
const isIdle = () => { const s = window.lodestar.console.live.state; return s !== null && !s.moving && s.pose !== null && s.base_ready; };
const state = (page) => page.evaluate(() => window.lodestar.console.live.state);

async function watch(size, more, url = robot.url) {
  const page = await open(browser, url, size, more);
  await until(page, isIdle);
  return page;
}

async function placeOnScreen(page, x, y) {
  const box = await page.locator('#stage').boundingBox();
  const at = await page.evaluate(([mx, my]) => window.lodestar.console.view.toScreen({ x: mx, y: my }), [x, y]);
  return { x: box.x + at.x, y: box.y + at.y };
}

async function clickMap(page, x, y, ...keys) {
  const at = await placeOnScreen(page, x, y);
  for (const key of keys) await page.keyboard.down(key);
  await page.mouse.click(at.x, at.y);
  for (const key of keys) await page.keyboard.up(key);
}

const previewed = (page) => page.locator('#preview-words', { hasText: /about \d+ s/ }).waitFor();
const event = (page, words) => until(page, (w) => window.lodestar.console.live.state?.events.some((e) => e.words.includes(w)), words);

async function leave(page) {
  assert.deepEqual(page.complaints, []);
  await page.context().close();
}

describe('driving', () => {
  test('a click on the map previews the way, and Drive takes the robot there', async () => {
    const page = await watch();
    await clickMap(page, 3.2, 4.3);
    await previewed(page);
    const { points } = await page.evaluate(() => window.lodestar.console.live.preview);
    const goal = await page.evaluate(() => window.lodestar.console.live.goals.list[0]);
    assert.ok(Math.hypot(points.at(-1)[0] - goal.x, points.at(-1)[1] - goal.y) < 1e-3);
    assert.equal((await state(page)).moving, false);  // looking costs nothing

    await page.getByRole('button', { name: 'Drive', exact: true }).click();
    await event(page, 'arrived');
    await until(page, isIdle);
    await until(page, (g) => { const p = window.lodestar.console.live.state.pose; return Math.hypot(p.x_m - g.x, p.y_m - g.y) < 0.03; }, goal);
    await until(page, () => window.lodestar.console.live.state.driver === null);  // others may drive now
    await leave(page);
  });

  test('a heading is set by the arrow, several goals are driven in order', async () => {
    const page = await watch();
    await clickMap(page, 2.2, 4.3);
    await clickMap(page, 1.7, 5.6, 'Shift');
    await previewed(page);
    const end = await page.evaluate(() => { const { goals } = window.lodestar.console.live; return goals.arrowEnd(goals.list[1]); });
    const box = await page.locator('#stage').boundingBox();
    const goal = await placeOnScreen(page, 1.7, 5.6);
    await page.mouse.move(box.x + end.x, box.y + end.y);
    await page.mouse.down();
    await page.mouse.move(goal.x, goal.y - 60);
    await page.mouse.up();
    assert.equal(await page.getByLabel('Goal 2, heading in degrees, or nothing').inputValue(), '90');
    await previewed(page);
    await page.getByRole('button', { name: 'Drive', exact: true }).click();
    await event(page, 'goal 2: arrived');
    await until(page, isIdle);
    const { pose } = await state(page);
    assert.ok(Math.abs(pose.yaw_deg - 90) < 3, `${pose.yaw_deg}`);
    await leave(page);
  });

  test('what cannot be reached is said, with the nearest place that can', async () => {
    const page = await watch();
    await clickMap(page, 3.3, 6.2);  // in a cupboard
    await page.locator('#preview-words.error', { hasText: 'No path' }).waitFor();
    assert.equal(await page.locator('#drive-go').isDisabled(), true);
    await page.getByRole('button', { name: 'Nearest position instead' }).click();
    await previewed(page);
    await page.getByLabel('Goal 1, x in metres').fill('2.5');
    await page.keyboard.press('Enter');
    await page.getByLabel('Goal 1, y in metres').fill('5');
    await page.keyboard.press('Enter');
    await previewed(page);
    assert.deepEqual(await page.evaluate(() => window.lodestar.console.live.goals.list.map((g) => [g.x, g.y])), [[2.5, 5]]);
    await leave(page);
  });

  test('places and routes are kept in the site folder', async () => {
    const page = await watch();
    const keep = async (button, name) => {
      await page.locator(button).click();
      await page.getByLabel('Name').fill(name);
      await page.getByRole('button', { name: 'Keep', exact: true }).click();
      await page.locator('#places', { hasText: name }).waitFor();
    };
    await page.evaluate(() => window.lodestar.console.live.goals.set([{ x: 2.2, y: 4.3, yawDeg: 90 }]));
    await keep('#place-keep', 'by the door');
    await page.evaluate(() => window.lodestar.console.live.goals.set([{ x: 2.2, y: 4.3, yawDeg: 90 }, { x: 1.7, y: 5.6, yawDeg: null }]));
    await keep('#route-keep', '<b>round</b>');
    const text = readFileSync(join(robot.site, 'places.yaml'), 'utf8');
    assert.ok(text.includes('  - {name: "by the door", x_m: 2.2, y_m: 4.3, yaw_deg: 90}\n'), text);
    assert.ok(text.includes('  - {name: "<b>round</b>", places: ["by the door", "<b>round</b> 2"]}\n'), text);
    await page.reload();
    await until(page, () => window.lodestar?.console.live.hello !== null);
    await page.getByRole('button', { name: 'by the door', exact: true }).click();
    assert.deepEqual(await page.evaluate(() => window.lodestar.console.live.goals.list), [{ x: 2.2, y: 4.3, yawDeg: 90 }]);
    assert.equal(await page.locator('#places b').count(), 0);  // text stays text
    await leave(page);
  });
});

describe('stopping', () => {
  let slow;
  before(async () => { slow = await serveRobot('--realtime'); });
  after(() => slow?.stop());

  const begin = async (page) => {
    await page.evaluate(() => window.lodestar.console.live.goals.set([{ x: 5.4, y: 4.3, yawDeg: null }]));
    await previewed(page);
    await page.getByRole('button', { name: 'Drive', exact: true }).click();
    await until(page, () => window.lodestar.console.live.state.measured.forward_mps > 0.2);
  };
  const isAtRest = () => { const { measured } = window.lodestar.console.live.state; return Math.abs(measured.forward_mps) < 0.005 && Math.abs(measured.turn_degps) < 0.6; };

  test('pause keeps the goal, stop forgets it, and everyone may stop', async () => {
    const page = await watch(undefined, undefined, slow.url);
    const other = await watch(undefined, undefined, slow.url);
    await begin(page);
    await until(other, () => window.lodestar.console.live.state.driver !== null);
    assert.equal(await other.locator('#live-pause').isDisabled(), true);  // another client has control
    await page.locator('#live-pause').click();
    await until(page, () => window.lodestar.console.live.state.paused);
    await until(page, isAtRest);
    await page.locator('#live-resume').click();
    await until(page, () => window.lodestar.console.live.state.measured.forward_mps > 0.2);
    await other.locator('#live-stop').click();
    await event(page, 'stopped by the operator');
    await until(page, isAtRest);
    assert.equal((await state(page)).moving, false);
    await leave(other);
    await leave(page);
  });

  test('a driver who goes away leaves a robot that comes to rest, and another may go on', async () => {
    const page = await watch(undefined, undefined, slow.url);
    await page.evaluate(() => window.lodestar.console.live.goals.set([{ x: 5.4, y: 4.3, yawDeg: null }]));
    await previewed(page);
    await begin(page);
    await page.context().close();
    const other = await open(browser, slow.url);
    await event(other, 'no client has control any more');
    await until(other, isAtRest);
    assert.equal((await state(other)).paused, true);
    await other.locator('#live-resume').click();
    await until(other, () => window.lodestar.console.live.state.measured.forward_mps > 0.1);
    await other.keyboard.press('Escape');
    await other.locator('#stage').focus();
    await other.keyboard.press(' ');  // the space bar stops
    await until(other, () => !window.lodestar.console.live.state.moving);
    await leave(other);
  });

  test('when the robot falls silent the page says so, and comes back by itself', async () => {
    const mortal = await serveRobot('--realtime');
    const page = await watch(undefined, undefined, mortal.url);
    await mortal.stop();
    await page.locator('#stale', { hasText: /No connection to the robot, and no data for \d+ s/ }).waitFor();
    const heir = await serveRobot('--realtime', '--port', new URL(mortal.url).port);
    await page.locator('#stale').waitFor({ state: 'hidden' });
    await page.context().close();  // its complaints are of the connection that was cut
    await heir.stop();
  });
});

describe('seeing', () => {
  test('the camera picture and what is read in it', async () => {
    const page = await watch();
    await until(page, () => window.lodestar.console.live.camera.shown !== null);
    const shown = await page.evaluate(() => {
      const { camera, state: s } = window.lodestar.console.live;
      return { size: [camera.element.width, camera.element.height], ids: camera.shown.markers.map((m) => m.id), used: s.markers };
    });
    assert.deepEqual(shown.size, [640, 480]);
    assert.ok(shown.ids.length > 0 && shown.used.every((id) => shown.ids.includes(id)), JSON.stringify(shown));
    await leave(page);
  });

  test('a robot with an outline is drawn as one, live and in the replay', async () => {
    const long = await serveRobotAt(withOutline(labCopy()));
    const page = await watch(undefined, undefined, long.url);
    /** Is a place, given in the robot's frame, painted? */
    const painted = (pose) => page.evaluate(async ([robot, places]) => {
      const { stage, view } = window.lodestar.console;
      view.fit([robot], 2);
      stage.redraw();
      await new Promise((done) => setTimeout(done, 200));
      const context = document.getElementById('overlay').getContext('2d');
      const [sin, cos] = [Math.sin(robot.yawDeg * Math.PI / 180), Math.cos(robot.yawDeg * Math.PI / 180)];
      return places.map(([x, y]) => {
        const p = view.toScreen({ x: robot.x + cos * x - sin * y, y: robot.y + sin * x + cos * y });
        return context.getImageData(Math.round(p.x * devicePixelRatio), Math.round(p.y * devicePixelRatio), 1, 1).data[3] > 0;
      });
    }, [pose, [[0.37, 0.12], [-0.27, -0.12], [0.05, 0.19], [-0.1, 0.19], [-0.34, 0.05], [0.44, 0.05]]]);
    const asOutline = [true, true, false, false, false, false];
    const { pose } = await state(page);
    assert.deepEqual(await painted({ x: pose.x_m, y: pose.y_m, yawDeg: pose.yaw_deg }), asOutline);
    while (!existsSync(join(long.runs, 'run', 'estimate.tum'))) await new Promise((done) => setTimeout(done, 50));
    await page.locator('#tool-replay').click();
    await until(page, () => window.lodestar.console.replay.run !== null);
    const [, x, y, yawDeg] = await page.evaluate(() => window.lodestar.console.replay.run.estimate[0]);
    assert.deepEqual(await painted({ x, y, yawDeg }), asOutline);
    await leave(page);
    await long.stop();
  });

  test('a client that never reads is no burden to those who do', async () => {
    const { hostname, port } = new URL(robot.url);
    const sleeper = connect(Number(port), hostname);
    sleeper.pause();
    sleeper.write(`GET /api/socket HTTP/1.1\r\nHost: ${hostname}:${port}\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n`
      + 'Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Protocol: lodestar.v1\r\n\r\n');
    const frame = Buffer.from('{"type":"camera","on":true}');
    sleeper.write(Buffer.concat([Buffer.from([0x81, 0x80 | frame.length, 0, 0, 0, 0]), frame]));
    const page = await watch();
    await until(page, () => window.lodestar.console.live.state.viewers >= 2);
    const from = (await state(page)).time_s;
    await until(page, (t) => window.lodestar.console.live.state.time_s > t + 2, from);
    assert.equal(await page.evaluate(() => window.lodestar.console.live.isStale), false);
    sleeper.destroy();
    await leave(page);
  });

  test('a drive just made is scrubbed: map, plots and picture show the same time', async () => {
    const page = await watch();
    assert.ok(existsSync(join(robot.runs, 'run', 'steps.csv')));
    await page.locator('#tool-replay').click();
    await until(page, () => window.lodestar.console.replay.run !== null);
    await page.locator('#replay').getByLabel('Run', { exact: true }).selectOption('run');
    await until(page, () => window.lodestar.console.replay.run.name === 'run');
    await page.getByLabel('Time').fill('2.5');
    await page.locator('#replay-words', { hasText: /^2\.5 of/ }).waitFor();
    await until(page, () => document.getElementById('replay-picture').naturalWidth === 640);
    const shown = await page.evaluate(() => {
      const { replay } = window.lodestar.console;
      const step = replay.run.steps.findLast((s) => s[0] <= 2.5);
      return { picture: Number(document.getElementById('replay-picture').dataset.time), sigma: step[4],
        words: document.querySelector('#replay-plots figcaption').textContent };
    });
    assert.ok(shown.picture <= 2.5 && shown.picture > 1.9, `${shown.picture}`);
    assert.ok(shown.words.includes(`3σ ${(3000 * shown.sigma).toFixed(1)} mm`), `${shown.words} ${shown.sigma}`);
    const box = await page.locator('#replay-plots .u-over').first().boundingBox();
    await page.mouse.click(box.x + box.width - 2, box.y + 20);
    const { time, end } = await page.evaluate(() => ({ time: window.lodestar.console.replay.time, end: window.lodestar.console.replay.end() }));
    assert.ok(time > 0.9 * end, `${time} of ${end}`);
    await leave(page);
  });

  for (const [width, scheme] of [[1280, 'light'], [800, 'dark']]) {
    test(`no serious finding of axe at ${width} pixels, ${scheme}`, async () => {
      const page = await watch({ width, height: 700 }, { colorScheme: scheme, bypassCSP: true });
      await clickMap(page, 2.2, 4.3);
      await previewed(page);
      await page.evaluate(axeSource);
      const findings = () => page.evaluate(async () => (await window.axe.run()).violations
        .filter((v) => v.impact === 'serious' || v.impact === 'critical').map((v) => `${v.id}: ${v.nodes[0].html}`));
      assert.deepEqual(await findings(), []);
      await page.locator('#tool-replay').click();
      await until(page, () => window.lodestar.console.replay.run !== null);
      assert.deepEqual(await findings(), []);
      await page.context().close();
    });
  }
});

describe('with strangers', () => {
  const offered = (page, url, protocol = 'lodestar.v1') => page.evaluate(([u, p]) => new Promise((told) => {
    const socket = new WebSocket(u, p);
    socket.onopen = () => told('open');
    socket.onerror = () => told('refused');
  }), [url.replace('http', 'ws') + 'api/socket', protocol]);

  test('a page of another origin has no socket, nor has one by another name', async () => {
    const stranger = await serve();
    const page = await (await browser.newContext()).newPage();
    await page.goto(`${stranger.url}style.css`);
    assert.equal(await offered(page, stranger.url), 'open');  // its own
    assert.equal(await offered(page, robot.url), 'refused');
    assert.equal(await offered(page, stranger.url, 'other.v1'), 'refused');
    await page.context().close();
    await stranger.stop();
  });

  test('who has a token to view may look and stop, and neither edit nor drive', async () => {
    const [all, view] = ['drive-drive-drive-drive', 'look-look-look-look-look'];
    const guarded = await serveRobot('--token', all, '--view-token', view);
    const page = await open(browser, `${guarded.url}#t=${view}`);
    await until(page, isIdle);
    assert.equal(await page.locator('#live-stop').isDisabled(), false);
    assert.equal(await page.locator('#live-resume').isDisabled(), true);
    await clickMap(page, 2.2, 4.3);
    assert.equal(await page.evaluate(() => window.lodestar.console.live.goals.list.length), 0);
    await page.locator('#issues', { hasText: 'needs the token to edit' }).waitFor({ state: 'attached' });  // with the editor, which driving hides
    await page.evaluate(() => window.lodestar.console.live.socket.send({ type: 'take' }));
    await page.locator('#state', { hasText: 'the token to drive' }).waitFor();
    const status = await page.evaluate(() => fetch('/api/routes', { method: 'PUT', body: '{}',
      headers: { 'X-Lodestar': '1', 'Content-Type': 'application/json', 'If-Match': '*' } }).then((r) => r.status));
    assert.equal(status, 403);
    const without = await (await browser.newContext()).newPage();
    await without.goto(guarded.url);
    assert.equal(await offered(without, guarded.url), 'refused');
    await without.context().close();
    await page.context().close();
    await guarded.stop();
  });

  test('nonsense and frames too large end the connection, and only that one', async () => {
    const page = await watch();
    const ending = (bytes) => page.evaluate(([url, n]) => new Promise((told) => {
      const socket = new WebSocket(url, 'lodestar.v1');
      socket.onopen = () => socket.send(n === 0 ? '{"type": ' : 'x'.repeat(n));
      socket.onclose = () => told('closed');
    }), [robot.url.replace('http', 'ws') + 'api/socket', bytes]);
    assert.equal(await ending(0), 'closed');
    assert.equal(await ending(200_000), 'closed');
    const from = (await state(page)).time_s;
    await until(page, (t) => window.lodestar.console.live.state.time_s > t, from);
    await page.context().close();
  });
});
