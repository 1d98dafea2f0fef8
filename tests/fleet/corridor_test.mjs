// Ten robots of one process go through a corridor that has room for one: a master releases the edges.
import assert from 'node:assert/strict';
import { execFileSync, spawn } from 'node:child_process';
import { mkdirSync, mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { test } from 'node:test';
import { Witness, binary, freePort, message, startBroker, until } from './robot.mjs';

const count = 10;
/** Where a robot waits before the corridor and at its end, and where it has left the room and the corridor. */
const [before, inside, end, beyond] = [[5.6, 3], [6.8, 3], [9.2, 3], [10.4, 3]];
const apart = (a, b) => Math.hypot(a[0] - b[0], a[1] - b[1]);

/** Two rooms of 6 x 6 m, and 3 m of a corridor between them, 1.6 m wide. */
function twoRooms(folder) {
  const [columns, rows] = [320, 120];
  const cells = Buffer.alloc(columns * rows, 254);
  for (let i = 0; i < cells.length; ++i) {
    const [x, y] = [(i % columns + 0.5) * 0.05, (Math.floor(i / columns) + 0.5) * 0.05];
    const isBetween = x > 6.5 && x < 9.5 && (y < 2.2 || y > 3.8);
    if (x < 0.1 || x > 15.9 || y < 0.1 || y > 5.9 || isBetween) cells[i] = 0;
  }
  mkdirSync(join(folder, 'map'));
  writeFileSync(join(folder, 'map', 'map.pgm'), Buffer.concat([Buffer.from(`P5\n${columns} ${rows}\n255\n`), cells]));
  writeFileSync(join(folder, 'map', 'map.yaml'),
    'image: map.pgm\nresolution: 0.05\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n');
  const site = join(folder, 'rooms');
  execFileSync(binary, ['site', 'new', join(folder, 'map', 'map.yaml'), '-o', site]);
  execFileSync(binary, ['markers', 'fill', site]);
  return site;
}

/** Places in the room beyond, the farthest from the corridor first. */
const places = [14.9, 13.4, 11.9].flatMap((x) => [0.9, 2.3, 3.7, 5.1].map((y) => [x, y]))
  .sort((a, b) => apart(b, beyond) - apart(a, beyond)).slice(0, count);

/** First room, corridor and second room: each for one robot at a time. A stage leads through each. */
const [lastOf, leftAt] = [[1, 3, 5], [2, 4, 5]];

class Trip {
  constructor(robot, target, rooms) {
    const { x, y } = robot.witness.state().agvPosition;
    this.points = [[x, y], before, inside, end, beyond, target];
    Object.assign(this, { robot, rooms, stages: 0, isDone: false });
  }
  get released() { return this.stages === 0 ? 0 : lastOf[this.stages - 1]; }
  advance() {
    const { robot, rooms } = this;
    const state = robot.witness.state();
    const reached = state.orderId === robot.serial ? state.lastNodeSequenceId / 2 : 0;
    rooms.forEach((holder, room) => { if (holder === this && reached >= leftAt[room]) rooms[room] = null; });
    this.isDone = reached === 5 && !state.nodeStates.length;
    while (this.stages < 3 && !rooms[this.stages]) {
      const first = this.released;
      rooms[this.stages++] = this;
      this.send(first);
    }
  }
  send(first) {
    const nodes = this.points.map(([x, y], i) => ({
      nodeId: `n${i}`, sequenceId: 2 * i, released: i <= this.released, nodePosition: { x, y, mapId: 'rooms' }, actions: [],
    }));
    const edges = this.points.slice(1).map((_, i) => ({
      edgeId: `e${i}`, sequenceId: 2 * i + 1, released: i < this.released, startNodeId: `n${i}`, endNodeId: `n${i + 1}`, actions: [],
    }));
    const order = { manufacturer: 'lodestar', orderId: this.robot.serial, orderUpdateId: this.stages, nodes: nodes.slice(first), edges: edges.slice(first) };
    this.robot.witness.send('order', message(this.robot.serial, '2.0.0', order));
  }
}

test('ten robots, one broker, one corridor: no contact and no deadlock', async (run) => {
  const folder = mkdtempSync(join(tmpdir(), 'lodestar-corridor-'));
  const port = await freePort();
  const url = `mqtt://127.0.0.1:${port}`;
  const broker = await startBroker(port);
  const demo = spawn(binary, ['fleet', 'demo', String(count), twoRooms(folder), '--broker', url], { stdio: ['ignore', 'pipe', 'pipe'] });
  let words = '';
  for (const stream of [demo.stdout, demo.stderr]) stream.on('data', (bytes) => { words += bytes; });
  const ended = new Promise((done) => demo.on('exit', done));
  run.after(() => { demo.kill('SIGKILL'); return broker.kill(); });
  let isOver = false;
  void ended.then(() => { isOver = true; });
  await until('the robots have names', () => isOver || words.includes(`lodestar/rooms-${count}\n`), () => words);
  assert.ok(!isOver, words);
  const serials = Array.from({ length: count }, (_, i) => `rooms-${i + 1}`);
  const robots = serials.map((serial) => ({ serial, witness: new Witness(url, serial, '2.0.0', { manufacturer: 'lodestar' }) }));
  run.after(() => robots.forEach(({ witness }) => witness.end()));
  await until('all know where they are', () => robots.every((robot) => robot.witness.state()?.agvPosition?.positionInitialized), () => words);

  const rooms = [null, null, null];
  const at = (robot) => { const { x, y } = robot.witness.state().agvPosition; return [x, y]; };
  const queue = robots.slice().sort((a, b) => apart(at(a), before) - apart(at(b), before));
  const trips = queue.map((robot, i) => new Trip(robot, places[i], rooms));
  for (const trip of trips) {  // whoever is nearest to the corridor leaves first
    await until(`${trip.robot.serial} has left the room`, () => {
      for (const one of trips) if (one === trip || one.stages > 0) one.advance();
      return trip.stages >= 2;
    }, () => words);
  }
  await until('all are there', () => { trips.forEach((trip) => trip.advance()); return trips.every((trip) => trip.isDone); }, () => words);
  trips.forEach((trip, i) => assert.ok(apart(at(trip.robot), places[i]) < 0.05, trip.robot.serial));
  for (const { witness } of robots) assert.deepEqual(witness.faults, []);
  demo.kill('SIGINT');
  assert.equal(await ended, 0, words);
  assert.equal([...words.matchAll(/robot \d+: [\d.]+ m driven, 0 contacts/g)].length, count, words);
  rmSync(folder, { recursive: true, force: true });
});
