// What the scanner sees, on the page and in the files that others read.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, describe, test } from 'node:test';
import { axeSource, labCopy, launch, open, serveRobotAt } from './browser.mjs';
import { binary, packages, source } from './programs.mjs';
import { isIdle, leave, setGoals, planned, until } from './robot_page.mjs';
import { complaints, officialSchema } from './schemas.mjs';

let browser;
let robot;
before(async () => {
  browser = await launch();
  robot = await serveRobotAt(labCopy(), '--realtime', '--people', '6', '--people-kind', 'threatening');
});
after(async () => {
  await browser?.close();
  await robot?.stop();
});

async function among(size, more) {
  const page = await open(browser, robot.url, size, more);
  await until(page, isIdle);
  await until(page, () => window.lodestar.console.live.seen !== null);
  return page;
}

describe('on the page', () => {
  test('beams that may be people stand out from those that the map explains', async () => {
    const page = await among();
    await until(page, () => window.lodestar.console.live.seen.person.length > 4);
    const painted = await page.evaluate(async () => {
      const { live, view, stage } = window.lodestar.console;
      const { seen } = live;
      live.onSeen = () => {};  // this one stays
      live.seenAt = performance.now() + 5000;
      stage.redrawOverlay();
      await new Promise((done) => setTimeout(done, 300));
      const context = document.getElementById('overlay').getContext('2d');
      const at = (flat, i) => {
        const p = view.toScreen({ x: flat[i], y: flat[i + 1] });
        return [...context.getImageData(Math.round(p.x * devicePixelRatio), Math.round(p.y * devicePixelRatio), 1, 1).data];
      };
      const isPink = ([r, g, b, a]) => a > 200 && r > 180 && g < 80 && b > 80;
      const share = (flat, holds) => { let n = 0; for (let i = 0; i < flat.length; i += 2) n += holds(at(flat, i)) ? 1 : 0; return n / (flat.length / 2); };
      return { mapped: seen.mapped.length, pinkOnPeople: share(seen.person, isPink), pinkOnMap: share(seen.mapped, isPink) };
    });
    assert.ok(painted.mapped > 100, JSON.stringify(painted));
    assert.ok(painted.pinkOnPeople > 0.8 && painted.pinkOnMap < 0.2, JSON.stringify(painted));
    assert.match(await page.locator('#legend').textContent(), /person, or moves/);
    await leave(page);
  });

  test('the protective field says in plain words why it slows the robot or lets it wait', async () => {
    const page = await among();
    const isHeld = () => { const { state } = window.lodestar.console.live; return state.moving && state.field.state !== 'free'; };
    for (let i = 0; i < 6; ++i) {
      await setGoals(page, i % 2 ? [1.7, 5.6] : [5.4, 4.3]);
      await planned(page);
      await page.getByRole('button', { name: 'Drive', exact: true }).click();
      const held = await page.waitForFunction(isHeld, undefined, { polling: 20, timeout: 8000 }).catch(() => null);
      if (held) break;
      await until(page, isIdle);
    }
    const said = await page.evaluate(async () => {
      const { live } = window.lodestar.console;
      for (let i = 0; i < 200 && live.state.field.state === 'free'; ++i) await new Promise((done) => setTimeout(done, 20));
      return [live.words(), live.state.field.why, document.getElementById('robot').textContent];
    });
    assert.match(said[0], /(waits|slowed): /);
    assert.match(said[1], /person|corner|map/);
    assert.match(said[2], /Scanner/);
    if (process.env.LODESTAR_PICTURES) await page.screenshot({ path: join(process.env.LODESTAR_PICTURES, 'seen.png') });
    await page.keyboard.press(' ');
    await leave(page);
  });

  for (const [width, height, scheme] of [[1280, 800, 'light'], [1280, 800, 'dark'], [390, 844, 'light'], [390, 844, 'dark']]) {
    test(`no serious finding of axe at ${width} pixels, ${scheme}`, async () => {
      const page = await among({ width, height }, { colorScheme: scheme, bypassCSP: true });
      await page.evaluate(axeSource);
      for (const mode of ['live', 'edit', 'replay']) {
        await page.locator(`#tool-${mode}`).click();
        await page.waitForTimeout(400);
        if (process.env.LODESTAR_PICTURES) await page.screenshot({ path: join(process.env.LODESTAR_PICTURES, `${mode}-${width}-${scheme}.png`) });
        const findings = await page.evaluate(async () => (await window.axe.run()).violations
          .filter((v) => v.impact === 'serious' || v.impact === 'critical').map((v) => `${v.id}: ${v.nodes[0].html}`));
        assert.deepEqual(findings, [], mode);
      }
      await page.context().close();
    });
  }
});

describe('in run.mcap and the report', () => {
  const { McapIndexedReader } = packages('@mcap/core');
  const fzstd = packages('fzstd');
  const decompressHandlers = { zstd: (bytes, size) => fzstd.decompress(bytes, new Uint8Array(Number(size))) };
  const folder = mkdtempSync(join(tmpdir(), 'lodestar-seen-'));
  after(() => rmSync(folder, { recursive: true, force: true }));

  test('scan and memory are as Foxglove wants them, and a wait has its place and its reason', async () => {
    const run = join(folder, 'run');
    try {
      execFileSync(binary, ['replay', join(source, 'sites/lab'), '--people', '12', '--people-kind', 'threatening', '--seed', '1', '--goal', '3.2,4.3', '--quiet', '-o', run],
        { stdio: ['ignore', 'ignore', 'inherit'] });
    } catch { /* arrived or not: it is the waiting that counts */ }
    const bytes = readFileSync(join(run, 'run.mcap'));
    const readable = { size: () => Promise.resolve(BigInt(bytes.length)), read: (at, size) => Promise.resolve(bytes.subarray(Number(at), Number(at + size))) };
    const reader = await McapIndexedReader.Initialize({ readable, decompressHandlers });
    const count = { '/scan': 0, '/obstacles': 0 };
    let people = 0;
    for await (const message of reader.readMessages({ topics: Object.keys(count) })) {
      const channel = reader.channelsById.get(message.channelId);
      const json = JSON.parse(new TextDecoder().decode(message.data));
      assert.deepEqual(complaints(officialSchema(reader.schemasById.get(channel.schemaId).name), json), [], channel.topic);
      ++count[channel.topic];
      const data = Buffer.from(json.data, 'base64');
      if (channel.topic === '/obstacles') {
        assert.equal(data.length % json.column_count, 0);
        continue;
      }
      assert.equal(data.length % json.point_stride, 0);
      const presence = json.fields.find((f) => f.name === 'presence').offset;
      for (let at = 0; at < data.length; at += json.point_stride) {
        assert.ok(data[at + presence] <= 3, 'as docs/viewers.md lists them');
        if (data[at + presence] === 2) ++people;
      }
    }
    assert.ok(count['/scan'] > 20 && count['/obstacles'] > 20, JSON.stringify(count));
    assert.ok(people > 0);
    const { waits } = JSON.parse(readFileSync(join(run, 'summary.json'), 'utf8'));
    assert.ok(waits.length > 0);
    for (const wait of waits) assert.ok(wait.duration_s >= 0.5 && wait.why.length > 5 && wait.x_m > 0, JSON.stringify(wait));
    const report = readFileSync(join(run, 'report.html'), 'utf8');
    assert.match(report, /Where it waited, and why/);
    assert.ok(report.includes(waits[0].why.replaceAll("'", '&#39;')) || report.includes(waits[0].why));
  });
});
