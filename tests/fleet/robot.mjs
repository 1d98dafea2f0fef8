// A broker, a simulated robot, a master that nobody here wrote, and the schemas of the standard.
import { spawn } from 'node:child_process';
import { cpSync, existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { createServer } from 'node:net';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';

const packages = createRequire(join(resolve(process.env.LODESTAR_FLEET_PACKAGES ?? '.'), 'package.json'));
export const { MasterController, Topic, ConnectionState } = packages('vda-5050-lib');
export const mqtt = packages('mqtt');
const { default: Ajv } = packages('ajv/dist/2020');
const { default: addFormats } = packages('ajv-formats');
const source = resolve(process.env.LODESTAR_SOURCE_DIR ?? '../..');
export const binary = process.env.LODESTAR_BINARY ?? join(source, 'build/release/lodestar');
const schemas = process.env.LODESTAR_VDA_SCHEMAS ?? join(source, '../shared/data/vda5050');

export const hasSchemas = existsSync(schemas);
const patience_ms = 120_000;  // shared machines: what must happen, happens in its own time

export async function freePort() {
  const server = createServer();
  await new Promise((done) => server.listen(0, '127.0.0.1', done));
  const { port } = server.address();
  await new Promise((done) => server.close(done));
  return port;
}

/** mosquitto on loopback. `security`: lines of its configuration. */
export async function startBroker(port, security = 'allow_anonymous true') {
  const folder = mkdtempSync(join(tmpdir(), 'lodestar-broker-'));
  writeFileSync(join(folder, 'conf'), `listener ${port} 127.0.0.1\n${security}\npersistence false\n`);
  const child = spawn('mosquitto', ['-c', join(folder, 'conf')], {
    stdio: ['ignore', 'ignore', 'pipe'], env: { ...process.env, PATH: `${process.env.PATH}:/usr/sbin` },
  });
  const ended = new Promise((done) => child.on('exit', done));
  await new Promise((ready, failed) => {
    let said = '';
    child.stderr.on('data', (bytes) => { said += bytes; if (said.includes('running')) ready(); });
    child.on('exit', () => failed(new Error(`mosquitto: ${said}`)));
  });
  process.once('exit', () => child.kill('SIGKILL'));
  return { kill: async () => { child.kill('SIGKILL'); await ended; rmSync(folder, { recursive: true, force: true }); } };
}

/** A copy of the lab whose robot is in a fleet. */
function fleetSite(serial, version, identity) {
  const folder = mkdtempSync(join(tmpdir(), 'lodestar-fleet-'));
  const site = join(folder, 'lab');
  cpSync(join(source, 'sites/lab'), site, { recursive: true });
  const file = join(site, 'site.yaml');
  writeFileSync(join(site, 'places.yaml'), `format: lodestar-places\nversion: 1\nplaces:
  - {name: dock, x_m: 1.0, y_m: 5.6, yaw_deg: 180}\n`);
  writeFileSync(file, `${readFileSync(file, 'utf8')}charging: {place: dock, approach_m: 0.3, full_v: 29}\nfleet: {broker: "mqtts://nowhere.invalid", interface: uagv, manufacturer: ACME, serial: ${serial}, version: ${version}, ${identity}
  actions: [{type: pick, run: [/bin/sh, -c, "read action; echo box 7"], timeout_s: 60}]}\n`);
  return { folder, site };
}

/** A simulated robot in real time. `identity`: further keys of `fleet`, each with a comma behind it. */
export function startRobot(url, serial, version, identity = '') {
  const { folder, site } = fleetSite(serial, version, identity);
  const child = spawn(binary, ['replay', site, '--fleet', url], { stdio: ['ignore', 'pipe', 'pipe'] });
  let words = '';
  child.stdout.on('data', (bytes) => { words += bytes; });
  child.stderr.on('data', (bytes) => { words += bytes; });
  const ended = new Promise((done) => child.on('exit', (code) => { rmSync(folder, { recursive: true, force: true }); done(code); }));
  process.once('exit', () => child.kill('SIGKILL'));
  return {
    end: () => { child.kill('SIGTERM'); return ended; },
    kill: () => { child.kill('SIGKILL'); return ended; },
    words: () => words,
  };
}

/** All that the robot says, validated against the standard's schemas where they are there. */
export class Witness {
  constructor(url, serial, version, { manufacturer = 'ACME', ...identity } = {}) {
    this.messages = [];
    this.faults = [];
    this.base = `uagv/v2/${manufacturer}/${serial}`;
    this.checks = {};
    if (hasSchemas) {
      const ajv = new Ajv({ strict: false, allErrors: true });
      addFormats(ajv);
      for (const topic of ['state', 'connection', 'factsheet'])
        this.checks[topic] = ajv.compile(JSON.parse(readFileSync(join(schemas, version, `${topic}.schema`), 'utf8')));
    }
    this.client = mqtt.connect(url, { reconnectPeriod: 200, ...identity });
    this.client.on('connect', () => this.client.subscribe(`${this.base}/#`));
    this.client.on('message', (topic, payload, packet) => this.take(topic.slice(this.base.length + 1), payload, packet));
  }
  take(topic, payload, packet) {
    if (!['state', 'connection', 'factsheet'].includes(topic)) return;
    const message = JSON.parse(payload.toString());
    this.messages.push({ topic, message, retained: packet.retain, at: Date.now() });
    const check = this.checks[topic];
    if (check && !check(message)) this.faults.push({ topic, errors: check.errors, message });
  }
  all(topic) { return this.messages.filter((one) => one.topic === topic).map((one) => one.message); }
  state() { return this.all('state').at(-1); }
  connection() { return this.all('connection').at(-1)?.connectionState; }
  send(topic, payload) { this.client.publish(`${this.base}/${topic}`, typeof payload === 'string' || Buffer.isBuffer(payload) ? payload : JSON.stringify(payload)); }
  end() { this.client.end(true); }
}

/** Waits until it holds. */
export async function until(what, holds, words = () => '') {
  const end = Date.now() + patience_ms;
  for (;;) {
    const found = holds();
    if (found) return found;
    if (Date.now() > end) throw new Error(`never: ${what}\n${words()}`);
    await new Promise((done) => setTimeout(done, 20));
  }
}

/** An order over points [x, y], of which the first `released` are its base; `from`: the index of the first. */
export function orderOver(orderId, orderUpdateId, points, { released = points.length, from = 0, actions = {}, edge = {} } = {}) {
  const nodes = points.map(([x, y], i) => ({
    nodeId: `n${from + i}`, sequenceId: 2 * (from + i), released: i < released,
    nodePosition: { x, y, mapId: 'lab' }, actions: actions[`n${from + i}`] ?? [],
  }));
  const edges = points.slice(1).map((_, i) => ({
    edgeId: `e${from + i}`, sequenceId: 2 * (from + i) + 1, released: i + 1 < released,
    startNodeId: `n${from + i}`, endNodeId: `n${from + i + 1}`, actions: [], ...edge,
  }));
  return { orderId, orderUpdateId, nodes, edges };
}

let header = 0;
/** The same as a whole message. */
export const message = (serial, version, content) => ({ headerId: ++header, timestamp: new Date().toISOString(), version, manufacturer: 'ACME', serialNumber: serial, ...content });
