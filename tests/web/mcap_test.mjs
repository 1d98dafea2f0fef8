// run.mcap as other people's viewers read it: the reader and the schemas of those who defined them.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, describe, test } from 'node:test';
import { binary, packages, source } from './programs.mjs';
import { complaints, officialSchema } from './schemas.mjs';

const { McapIndexedReader, McapStreamReader } = packages('@mcap/core');
const fzstd = packages('fzstd');
const decompressHandlers = { zstd: (bytes, size) => fzstd.decompress(bytes, new Uint8Array(Number(size))) };

const folder = mkdtempSync(join(tmpdir(), 'lodestar-mcap-'));
const drive = (name) => {
  execFileSync(binary, ['replay', join(source, 'sites/lab'), '--goal', '2.2,4.5', '--pictures', '1', '--quiet', '-o', join(folder, name)],
    { stdio: ['ignore', 'ignore', 'inherit'] });
  return readFileSync(join(folder, name, 'run.mcap'));
};

/** What the indexed reader wants of a file. */
const readable = (bytes) => ({
  size: () => Promise.resolve(BigInt(bytes.length)),
  read: (offset, size) => Promise.resolve(bytes.subarray(Number(offset), Number(offset + size))),
});

async function messagesOf(bytes, options) {
  const reader = await McapIndexedReader.Initialize({ readable: readable(bytes), decompressHandlers });
  const messages = [];
  for await (const message of reader.readMessages(options)) {
    messages.push({ ...message, topic: reader.channelsById.get(message.channelId).topic, json: JSON.parse(new TextDecoder().decode(message.data)) });
  }
  return { reader, messages };
}

/** Records as they come, up to where the file ends. */
function streamed(bytes) {
  const reader = new McapStreamReader({ validateCrcs: true, decompressHandlers });
  reader.append(bytes);
  let count = 0;
  for (let record = reader.nextRecord(); record; record = reader.nextRecord()) if (record.type === 'Message') ++count;
  return { count, done: reader.done() };
}

describe('run.mcap', () => {
  let bytes;
  let all;
  before(async () => {
    bytes = drive('a');
    all = await messagesOf(bytes);
  });
  after(() => rmSync(folder, { recursive: true, force: true }));

  test('holds what its statistics say, in chunks with right checksums', () => {
    assert.equal(Number(all.reader.statistics.messageCount), all.messages.length);
    assert.ok(all.reader.chunkIndexes.length > 1);
    assert.deepEqual(streamed(bytes), { count: all.messages.length, done: true });
  });

  test('has every channel, and each message is as its schema wants it', () => {
    const topics = new Set(all.messages.map((m) => m.topic));
    for (const topic of ['/tf', '/tf_static', '/map', '/markers', '/path', '/robot', '/pose', '/drive', '/fix', '/log', '/camera', '/camera/calibration', '/truth', '/error']) {
      assert.ok(topics.has(topic), topic);
    }
    for (const message of all.messages) {
      const schema = all.reader.schemasById.get(all.reader.channelsById.get(message.channelId).schemaId);
      const own = JSON.parse(new TextDecoder().decode(schema.data));
      assert.deepEqual(complaints(own, message.json), [], `${message.topic} by our schema`);
      const official = officialSchema(schema.name);
      if (official) assert.deepEqual(complaints(official, message.json), [], `${message.topic} by Foxglove's schema`);
    }
  });

  test('tells the same drive as the other files of the folder', () => {
    const rows = readFileSync(join(folder, 'a', 'estimate.tum'), 'utf8').trim().split('\n').map((line) => line.split(' ').map(Number));
    const poses = all.messages.filter((m) => m.topic === '/pose');
    assert.ok(poses.length > 50);
    for (const { json } of poses) {
      const row = rows.find((r) => Math.abs(r[0] - json.timestamp.sec - json.timestamp.nsec * 1e-9) < 1e-8);
      assert.deepEqual([json.pose.position.x, json.pose.position.y], row.slice(1, 3));
    }
    const words = all.messages.filter((m) => m.topic === '/log').map((m) => m.json.message);
    assert.ok(words.includes('goal 1: arrived'), words.join('; '));
    const map = all.messages.find((m) => m.topic === '/map').json;
    assert.deepEqual([map.column_count, Buffer.from(map.data, 'base64').length], [306, 306 * 150]);
    const picture = Buffer.from(all.messages.find((m) => m.topic === '/camera').json.data, 'base64');
    assert.deepEqual([...picture.subarray(0, 3)], [0xff, 0xd8, 0xff]);
  });

  test('a part of the time is found by the index', async () => {
    const [from, to] = [2_000_000_000n, 3_000_000_000n];
    const { messages } = await messagesOf(bytes, { startTime: from, endTime: to, topics: ['/drive'] });
    const wanted = all.messages.filter((m) => m.topic === '/drive' && m.logTime >= from && m.logTime <= to);
    assert.ok(wanted.length >= 12);
    assert.deepEqual(messages.map((m) => m.logTime), wanted.map((m) => m.logTime));
  });

  test('cut anywhere, it reads as far as its last whole chunk', () => {
    let before = 0;
    for (const share of [0.3, 0.6, 0.9]) {
      const { count, done } = streamed(bytes.subarray(0, Math.floor(share * bytes.length)));
      assert.equal(done, false);
      assert.ok(count >= before);
      before = count;
    }
    assert.ok(before > all.messages.length / 4);
  });

  test('the same seed gives the same bytes', () => assert.ok(bytes.equals(drive('b'))));
});
