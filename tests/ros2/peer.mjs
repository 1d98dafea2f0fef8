// A robot that speaks ROS 2, a DDS participant of another vendor, and a reader of CDR that nobody here wrote. All over
// the loopback interface.
import { execFileSync, spawn } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { createRequire } from 'node:module';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';

const packages = createRequire(join(resolve(process.env.LODESTAR_ROS2_PACKAGES ?? '.'), 'package.json'));
const { ros2jazzy, ros2humble } = packages('@foxglove/rosmsg-msgs-common');
const { MessageReader, MessageWriter } = packages('@foxglove/rosmsg2-serialization');
const { parse } = packages('@foxglove/rosmsg');
const { McapIndexedReader } = packages('@mcap/core');
const fzstd = packages('fzstd');
export const source = resolve(process.env.LODESTAR_SOURCE_DIR ?? '../..');
export const binary = process.env.LODESTAR_BINARY ?? join(source, 'build/release/lodestar');
const peerBinary = process.env.LODESTAR_FAST_PEER ?? join(source, 'build/release/fast_peer');
export const patience_ms = 120_000;  // shared machines: what must happen, happens in its own time

/** Of tests at the same time on one machine, each has a domain of its own. */
export const freeDomain = () => 20 + (process.pid % 200);

export async function until(what, condition) {
  const end = Date.now() + patience_ms;
  for (;;) {
    const found = await condition();
    if (found) return found;
    if (Date.now() > end) throw new Error(`not within ${patience_ms / 1000} s: ${what}`);
    await new Promise((done) => setTimeout(done, 20));
  }
}

/** A definition with those that it refers to, by the name of the type on the wire. */
function definition(type, distro) {
  const [, library, name] = /^(\w+)::msg::dds_::(\w+)_$/.exec(type);
  const known = distro === 'humble' ? ros2humble : ros2jazzy;
  const all = [];
  const add = (full) => {
    if (all.some((one) => one.name === full)) return;
    const found = known[full];
    if (!found) throw new Error(`no definition of ${full}`);
    all.push(found);
    for (const field of found.definitions) if (field.isComplex) add(field.type);
  };
  add(`${library}/${name}`);
  return all;
}

const readers = new Map();
export function decode(type, hex) {
  if (!readers.has(type)) readers.set(type, new MessageReader(definition(type)));
  return readers.get(type).readMessage(Buffer.from(hex, 'hex'));
}

/** With its own definition, as a file has it. */
export function decodeBy(schema, data) {
  if (!readers.has(schema)) readers.set(schema, new MessageReader(parseDefinition(schema)));
  return readers.get(schema).readMessage(data);
}
export const parseDefinition = (schema) => parse(new TextDecoder().decode(schema.data), { ros2: true });
/** The same as ROS 2 has it, of "nav_msgs/msg/Path". */
export const definitionOf = (name) => definition(`${name.replaceAll('/', '::').replace('::msg::', '::msg::dds_::')}_`);

export function encode(type, message) {
  return Buffer.from(new MessageWriter(definition(type)).writeMessage(message)).toString('hex');
}

const running = new Set();
process.once('exit', () => { for (const child of running) child.kill('SIGKILL'); });

function start(program, options) {
  const child = spawn(program, options, { stdio: ['pipe', 'pipe', 'pipe'], env: { ...process.env, CYCLONEDDS_URI: undefined } });
  running.add(child);
  const ended = new Promise((done) => child.on('exit', (code) => { running.delete(child); done(code); }));
  return { child, ended };
}

/** A participant by Fast DDS. `messages`: by topic, decoded. */
export class Peer {
  constructor(domain) {
    this.messages = {};
    this.writers = {};
    this.types = {};
    ({ child: this.child, ended: this.ended } = start(peerBinary, [String(domain)]));
    let rest = '';
    this.child.stdout.on('data', (bytes) => {
      const lines = (rest + bytes).split('\n');
      rest = lines.pop();
      for (const line of lines) this.take(JSON.parse(line));
    });
  }
  take(line) {
    if (line.writer) this.writers[line.writer] = line;
    if (line.topic) (this.messages[line.topic] ??= []).push(this.raw ? line.hex : decode(this.types[line.topic], line.hex));
  }
  read(topic, type, { kept = false, unread = false } = {}) {
    this.types[topic] = type;
    this.messages[topic] ??= [];
    this.child.stdin.write(`read ${topic} ${type} ${kept ? 'kept' : 'passing'}${unread ? ' unread' : ''}\n`);
  }
  write(topic, type, message) {
    this.child.stdin.write(`write ${topic} ${type} ${encode(type, message)}\n`);
  }
  heard(topic, count = 1) {
    return until(`${count} of ${topic}`, () => this.messages[topic].length >= count && this.messages[topic]);
  }
  end() { this.child.stdin.end(); return this.ended; }
  kill() { this.child.kill('SIGKILL'); return this.ended; }
}

/** The simulated robot of the lab as a node. */
export class Robot {
  constructor(domain, ...options) {
    this.folder = mkdtempSync(join(tmpdir(), 'lodestar-ros2-'));
    this.run = join(this.folder, 'run');
    ({ child: this.child, ended: this.ended } = start(binary, ['replay', join(source, 'sites/lab'), '--quiet', '--ros2', '--ros-interface', 'lo',
      '--ros-domain', String(domain), '-o', this.run, ...options]));
    this.words = '';
    this.child.stdout.on('data', (bytes) => { this.words += bytes; });
    this.child.stderr.on('data', (bytes) => { this.words += bytes; });
  }
  says(words) { return until(`"${words}" in ${this.words}`, () => this.words.includes(words)); }
  async end() {
    this.child.kill('SIGINT');
    const code = await this.ended;
    rmSync(this.folder, { recursive: true, force: true });
    return code;
  }
}

/** Wireshark's dissector listens on the loopback interface, where this user may capture; else nothing. */
export async function startCapture(file) {
  const { child, ended } = start('tshark', ['-i', 'lo', '-f', 'udp', '-w', file, '-q']);
  let said = '';
  const ready = await new Promise((done) => {
    child.stderr.on('data', (bytes) => { said += bytes; if (said.includes('Capture started')) done(true); });
    child.on('error', () => done(false));
    child.on('exit', () => done(false));
  });
  if (!ready) return undefined;
  return { end: async () => { child.kill('SIGINT'); await ended; } };
}

/** What it makes of the packets that match: a line for each, of these fields. */
export function dissected(file, filter, ...fields) {
  const columns = fields.flatMap((field) => ['-e', field]);
  return execFileSync('tshark', ['-r', file, '-Y', filter, '-T', 'fields', '-E', 'separator=/t', ...columns], { encoding: 'utf8', stdio: ['ignore', 'pipe', 'ignore'], maxBuffer: 1 << 28 })
    .split('\n').filter((line) => line);
}

export function openMcap(file) {
  const bytes = readFileSync(file);
  return McapIndexedReader.Initialize({
    readable: {
      size: () => Promise.resolve(BigInt(bytes.length)),
      read: (offset, size) => Promise.resolve(bytes.subarray(Number(offset), Number(offset + size))),
    },
    decompressHandlers: { zstd: (chunk, size) => fzstd.decompress(chunk, new Uint8Array(Number(size))) },
  });
}

/** The messages of a topic in a run's record. */
export async function recorded(run, topic) {
  const reader = await openMcap(join(run, 'run.mcap'));
  const messages = [];
  for await (const message of reader.readMessages({ topics: [topic] })) messages.push(JSON.parse(new TextDecoder().decode(message.data)));
  return messages;
}

export const yawOf = ({ z, w }) => 2 * Math.atan2(z, w);
export const stampOf = ({ sec, nanosec }) => sec * 1e9 + nanosec;
