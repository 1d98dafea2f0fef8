// roslib, the JavaScript library of ROS, drives the robot through rosbridge on the console's socket.
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { mkdtempSync, rmSync } from 'node:fs';
import { createRequire } from 'node:module';
import { createServer } from 'node:net';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { after, before, describe, test } from 'node:test';
import { pathToFileURL } from 'node:url';
import { binary, patience_ms, source, until } from './peer.mjs';

const folder = resolve(process.env.LODESTAR_ROS2_PACKAGES ?? '.');
const { Action, Ros, Service, Topic } = await import(pathToFileURL(join(folder, 'node_modules/roslib/dist/RosLib.js')));
const WebSocket = createRequire(join(folder, 'package.json'))('ws');

async function freePort() {
  const server = createServer();
  await new Promise((done) => server.listen(0, '127.0.0.1', done));
  const { port } = server.address();
  await new Promise((done) => server.close(done));
  return port;
}

const pose = (x, y, frame = 'map') => ({ header: { frame_id: frame }, pose: { position: { x, y }, orientation: { w: 1 } } });
const within = (promise, what) => Promise.race([promise, new Promise((_, failed) => { setTimeout(() => failed(new Error(`not in time: ${what}`)), patience_ms).unref(); })]);

class Console {
  async start(...options) {
    this.port = await freePort();
    this.folder = mkdtempSync(join(tmpdir(), 'lodestar-rosbridge-'));
    this.child = spawn(binary, ['replay', join(source, 'sites/lab'), '--serve', '--realtime', '--port', String(this.port), '--quiet', '-o', join(this.folder, 'run'), ...options], { stdio: 'ignore' });
    this.ended = new Promise((done) => this.child.on('exit', done));
    process.once('exit', () => this.child.kill('SIGKILL'));
    await until('the console', () => fetch(`http://127.0.0.1:${this.port}/`).then(() => true, () => false));
    return this;
  }
  async end() { this.child.kill('SIGINT'); await this.ended; rmSync(this.folder, { recursive: true, force: true }); }
}

async function connected(port) {
  const ros = new Ros({});
  await within(ros.connect(`ws://127.0.0.1:${port}`), 'a connection');
  return ros;
}

const heard = (topic) => within(new Promise((done) => { topic.subscribe((message) => { topic.unsubscribe(); done(message); }); }), topic.name);

/** A goal of the action: how it ended, and what came meanwhile. */
function sent(ros, args) {
  const action = new Action({ ros, name: '/navigate_to_pose', actionType: 'nav2_msgs/action/NavigateToPose' });
  const goal = { feedback: [] };
  goal.ended = within(new Promise((done) => {
    goal.id = action.sendGoal({ pose: args }, (values) => done({ values }), (values) => goal.feedback.push(values), (error) => done({ error }));
  }), 'the end of a goal');
  goal.cancel = () => action.cancelGoal(goal.id);
  return goal;
}

describe('rosbridge', () => {
  let console_;
  let ros;
  before(async () => {
    console_ = await new Console().start();
    ros = await connected(console_.port);
    const where = new Topic({ ros, name: '/amcl_pose', messageType: 'geometry_msgs/msg/PoseWithCovarianceStamped' });
    await heard(where);
  });
  after(async () => { ros.close(); await console_.end(); });

  test('names its topics', async () => {
    const { topics, types } = await within(new Promise((done, failed) => { ros.getTopics(done, failed); }), 'topics');
    assert.ok(topics.includes('/amcl_pose') && topics.includes('/goal_pose'));
    assert.equal(types.length, topics.length);
  });

  test('sends the map', async () => {
    const map = await heard(new Topic({ ros, name: '/map', messageType: 'nav_msgs/msg/OccupancyGrid' }));
    assert.equal(map.data.length, map.info.width * map.info.height);
    assert.ok(map.data.includes(0) && map.data.includes(100) && map.header.frame_id === 'map');
  });

  test('drives to a goal, with feedback and a result', async () => {
    const goal = sent(ros, pose(2.4, 5.5));
    const { values, error } = await goal.ended;
    assert.equal(error, undefined);
    assert.equal(values.error_code, 0);
    assert.ok(goal.feedback.length > 3);
    const last = goal.feedback.at(-1);
    assert.ok(Math.hypot(last.current_pose.pose.position.x - 2.4, last.current_pose.pose.position.y - 5.5) < 0.1);
    assert.ok(goal.feedback[0].distance_remaining > last.distance_remaining);
    assert.ok(goal.feedback.at(-1).navigation_time.sec >= 1);
  });

  test('cancels a goal', async () => {
    const goal = sent(ros, pose(8.0, 5.6));
    await until('it drives', () => goal.feedback.length > 0);
    goal.cancel();
    const { error } = await goal.ended;
    assert.match(error, /cancel/i);
  });

  test('says why a goal cannot be reached', async () => {
    const { error } = await sent(ros, pose(3.0, 5.6)).ended;
    assert.match(error, /goal occupied/);
  });

  test('refuses what is no goal of the map, and drives nowhere', async () => {
    assert.match((await sent(ros, pose(2, 5, 'odom')).ended).error, /frame 'odom', wanted map/);
    assert.match((await sent(ros, { header: {} }).ended).error, /wanted/);
    assert.match((await sent(ros, pose(1e9, 5)).ended).error, /10 km/);
  });

  test('a second client waits for the first one\'s goal', async () => {
    const other = await connected(console_.port);
    const first = sent(ros, pose(8.0, 5.6));
    await until('it drives', () => first.feedback.length > 0);
    assert.match((await sent(other, pose(2.4, 5.5)).ended).error, /another client has control/);
    first.cancel();
    await first.ended;
    const { values } = await sent(other, pose(2.2, 5.6)).ended;
    assert.equal(values.error_code, 0);
    other.close();
  });

  test('a goal whose client leaves does not go on', async () => {
    const other = await connected(console_.port);
    const goal = sent(other, pose(8.0, 5.6));
    goal.ended.catch(() => {});
    await until('it drives', () => goal.feedback.length > 0);
    other.close();
    const here = new Topic({ ros, name: '/amcl_pose', messageType: 'geometry_msgs/msg/PoseWithCovarianceStamped' });
    let places = [];
    here.subscribe(({ pose: { pose: { position } } }) => places.push(position));
    await until('rest', () => {
      const last = places.slice(-20);
      return last.length === 20 && last.every(({ x, y }) => Math.hypot(x - last[0].x, y - last[0].y) < 0.005);
    });
    here.unsubscribe();
    assert.ok(places.at(-1).x < 7);
  });

  test('what is no message of rosbridge ends or is told, and costs nobody else anything', async () => {
    for (const text of ['no json', '[]', '{}', '{"op": 5}', '{"op":"subscribe","topic":7}', '{"op":"send_action_goal"}', '{"op":"publish","topic":"/goal_pose"}',
      '{"op":"publish","topic":"/cmd_vel","msg":{}}', '{"op":"advertise_service"}', '{"op":"call_service","service":"/shutdown"}']) {
      const socket = new WebSocket(`ws://127.0.0.1:${console_.port}`);
      await within(new Promise((done) => socket.on('open', done)), 'open');
      socket.send(text);
      await within(new Promise((done) => { socket.on('message', done); socket.on('close', done); socket.on('error', done); }), `an answer to ${text}`);
      socket.terminate();
    }
    await heard(new Topic({ ros, name: '/amcl_pose', messageType: 'geometry_msgs/msg/PoseWithCovarianceStamped' }));
  });
});

describe('rosbridge behind tokens', () => {
  test('nobody comes in without one, and who may only view does not drive', async () => {
    const guarded = await new Console().start('--token', 'a-secret-to-drive-with', '--view-token', 'a-secret-to-view-with');
    const answer = (token) => within(new Promise((done) => {
      const socket = new WebSocket(`ws://127.0.0.1:${guarded.port}`, { headers: token ? { Authorization: `Bearer ${token}` } : {} });
      socket.on('unexpected-response', (_, { statusCode }) => { done(statusCode); socket.terminate(); });
      socket.on('error', () => {});
      socket.on('open', () => socket.send(JSON.stringify({ op: 'send_action_goal', id: '1', action: '/navigate_to_pose', action_type: 'nav2_msgs/action/NavigateToPose', args: { pose: pose(2.4, 5.5) }, feedback: true })));
      socket.on('message', (bytes) => { done(JSON.parse(bytes)); socket.terminate(); });
    }), 'an answer');
    assert.equal(await answer(), 401);
    assert.equal(await answer('wrong'), 401);
    assert.match((await answer('a-secret-to-view-with')).values, /token to drive/);
    assert.equal((await answer('a-secret-to-drive-with')).op, 'action_feedback');
    await guarded.end();
  });
});
