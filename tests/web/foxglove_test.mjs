// The console's port as Foxglove's own client sees it.
import assert from 'node:assert/strict';
import { after, before, describe, test } from 'node:test';
import { labCopy, packages, serve, serveRobot, serveRobotAt, withOutline } from './programs.mjs';
import { complaints, officialSchema } from './schemas.mjs';

const { FoxgloveClient } = packages('@foxglove/ws-protocol');
const { WebSocket } = packages('ws');

/** The first event of this name that fits. */
const event = (emitter, name, fits = () => true) => new Promise((found) => {
  emitter.on(name, function hear(what) {
    if (!fits(what)) return;
    emitter.off(name, hear);
    found(what);
  });
});
const within = (promise, ms = 5000) => Promise.race([promise,
  new Promise((_, failed) => setTimeout(() => failed(new Error(`nothing came within ${ms} ms`)), ms).unref())]);

/** Connects, and gives what the server says first. */
async function connect(url, subprotocol, options = {}) {
  const socket = new WebSocket(url.replace('http', 'ws'), [subprotocol], options);
  const client = new FoxgloveClient({ ws: socket });
  const [info, channels] = await within(Promise.all([event(client, 'serverInfo'), event(client, 'advertise')]));
  const channel = (topic) => channels.find((c) => c.topic === topic);
  const hear = async (topic) => {
    const id = client.subscribe(channel(topic).id);
    const message = await within(event(client, 'message', (m) => m.subscriptionId === id));
    return JSON.parse(new TextDecoder().decode(message.data));
  };
  return { client, socket, info, channels, channel, hear };
}

describe('Foxglove and a robot that drives', () => {
  let server;
  before(async () => { server = await serveRobot(); });
  after(() => server?.stop());

  test('poses, numbers, words and pictures come as it goes', async () => {
    const { client, channel, hear } = await connect(server.url, 'foxglove.sdk.v1');
    for (const topic of ['/tf', '/pose', '/robot', '/path', '/log', '/camera']) {
      const json = await hear(topic);
      assert.deepEqual(complaints(officialSchema(channel(topic).schemaName), json), [], topic);
    }
    const id = client.subscribe(channel('/drive').id);
    const times = [];
    client.on('message', (m) => { if (m.subscriptionId === id) times.push(m.timestamp); });
    await within(event(client, 'message', () => times.length >= 10), 20_000);
    assert.ok(times.every((time, i) => i === 0 || time > times[i - 1]));
    const before = times.length;
    client.unsubscribe(id);
    await hear('/map');  // the server has read all of that
    const after = times.length;
    await new Promise((done) => setTimeout(done, 400));
    assert.equal(times.length, after, `${before}`);
    client.close();
  });

  test('a robot with an outline is shown as one', async () => {
    const long = await serveRobotAt(withOutline(labCopy()));
    const { client, hear } = await connect(long.url, 'foxglove.sdk.v1');
    const scene = await hear('/robot');
    assert.deepEqual(complaints(officialSchema('foxglove.SceneUpdate'), scene), []);
    const body = scene.entities.find((e) => e.id === 'robot');
    assert.equal(body.cylinders.length, 0);
    assert.deepEqual(body.lines[0].points.map((p) => [p.x, p.y]), [[-0.3, -0.15], [0.4, -0.15], [0.4, 0.15], [-0.3, 0.15]]);
    client.close();
    await long.stop();
  });

  test('a viewer that never reads stops nobody', async () => {
    const slow = new WebSocket(server.url.replace('http', 'ws'), ['foxglove.sdk.v1']);
    await within(event(slow, 'open'));
    for (let i = 0; i < 12; ++i) slow.send(JSON.stringify({ op: 'subscribe', subscriptions: [{ id: i, channelId: i }] }));
    slow._socket.pause();
    const { client, hear } = await connect(server.url, 'foxglove.sdk.v1');
    for (const topic of ['/pose', '/drive', '/robot']) await hear(topic);
    client.close();
    slow.terminate();
  });
});

describe('Foxglove', () => {
  let server;
  before(async () => { server = await serve(); });
  after(() => server?.stop());

  for (const subprotocol of [FoxgloveClient.SUPPORTED_SUBPROTOCOL, 'foxglove.sdk.v1']) {
    test(`${subprotocol}: the map and the markers are there as soon as one asks`, async () => {
      const { client, socket, info, channels, channel, hear } = await connect(server.url, subprotocol);
      assert.equal(socket.protocol, subprotocol);
      assert.deepEqual([info.name, info.capabilities], ['Lodestar: lab', []]);
      assert.ok(channels.every((c) => c.encoding === 'json' && c.schemaEncoding === 'jsonschema' && JSON.parse(c.schema).title === c.schemaName));
      for (const topic of ['/map', '/markers', '/tf_static', '/camera/calibration']) {
        const json = await hear(topic);
        assert.deepEqual(complaints(officialSchema(channel(topic).schemaName), json), [], topic);
        if (topic === '/map') assert.equal(Buffer.from(json.data, 'base64').length, 306 * 150);
        if (topic === '/markers') assert.ok(json.entities.some((e) => e.id === 'marker 447'));
      }
      client.close();
    });
  }

  test('who looks at the markers sees them as they have just been saved, and those who come later too', async () => {
    const early = await connect(server.url, 'foxglove.sdk.v1');
    const names = (scene) => scene.entities.map((e) => e.id);
    const xOf = (scene, id) => scene.entities.find((e) => e.id === `marker ${id}`).cubes[0].pose.position.x;
    const before = await early.hear('/markers');
    const saved = within(event(early.client, 'message'));
    const api = `${server.url}api/markers`;
    const read = await fetch(api);
    const registry = await read.json();
    const [gone, moved] = registry.markers;
    const markers = registry.markers.slice(1).map((m) => m.id === moved.id ? { ...m, x_m: m.x_m + 0.5 } : m);
    const answer = await fetch(api, { method: 'PUT', body: JSON.stringify({ ...registry, markers }),
      headers: { 'If-Match': read.headers.get('ETag'), 'X-Lodestar': '1', 'Content-Type': 'application/json' } });
    assert.equal(answer.status, 200);
    const after = JSON.parse(new TextDecoder().decode((await saved).data));
    assert.deepEqual(complaints(officialSchema('foxglove.SceneUpdate'), after), []);
    assert.deepEqual(after.deletions.map((d) => d.type), [1]);  // all that were shown, the one that is gone among them
    assert.deepEqual(names(after), names(before).filter((name) => name !== `marker ${gone.id}`));
    assert.ok(Math.abs(xOf(after, moved.id) - xOf(before, moved.id) - 0.5) < 1e-5);
    const late = await connect(server.url, 'foxglove.websocket.v1');
    assert.deepEqual(await late.hear('/markers'), after);
    early.client.close();
    late.client.close();
  });

  test('an app may offer both names at once', async () => {
    const socket = new WebSocket(server.url.replace('http', 'ws'), ['foxglove.websocket.v1', 'foxglove.sdk.v1']);
    await within(event(socket, 'open'));
    assert.match(socket.protocol, /^foxglove\./);
    socket.close();
  });

  test('a page of another origin is turned away, a client that publishes is told no', async () => {
    const stranger = new WebSocket(server.url.replace('http', 'ws'), ['foxglove.sdk.v1'], { origin: 'https://elsewhere.example' });
    const response = await within(new Promise((found) => stranger.once('unexpected-response', (_, answer) => found(answer.statusCode))));
    assert.equal(response, 403);
    const { client } = await connect(server.url, 'foxglove.sdk.v1');
    const told = event(client, 'status');
    client.advertise({ topic: '/goal_pose', encoding: 'json', schemaName: 'x' });
    assert.match((await within(told)).message, /does not know 'advertise'/);
    client.close();
  });
});
