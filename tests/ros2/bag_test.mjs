// The recorded bag, by a reader of MCAP and of ROS 2's messages that nobody here wrote, with the definitions in the file.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, describe, test } from 'node:test';
import { binary, decodeBy, definitionOf, openMcap, parseDefinition, recorded, source, stampOf, yawOf } from './peer.mjs';

describe('--ros2-bag', () => {
  const folder = mkdtempSync(join(tmpdir(), 'lodestar-bag-'));
  const file = join(folder, 'drive.mcap');
  const record = (bag) => execFileSync(binary, ['replay', join(source, 'sites/lab'), '--goal', '2.4,5.5', '--people', '1', '--quiet', '--ros2-bag', bag, '-o', join(folder, 'run')], { stdio: 'ignore' });
  const messages = {};
  let reader;
  before(async () => {
    record(file);
    reader = await openMcap(file);
    for await (const { channelId, data, logTime } of reader.readMessages()) {
      const channel = reader.channelsById.get(channelId);
      const schema = reader.schemasById.get(channel.schemaId);
      (messages[channel.topic] ??= []).push({ logTime, message: decodeBy(schema, data) });
    }
  });
  after(() => rmSync(folder, { recursive: true, force: true }));

  test('has ROS 2\'s profile, encodings and topics', () => {
    assert.equal(reader.header.profile, 'ros2');
    for (const channel of reader.channelsById.values()) assert.equal(channel.messageEncoding, 'cdr');
    for (const schema of reader.schemasById.values()) assert.equal(schema.encoding, 'ros2msg');
    assert.deepEqual(Object.keys(messages).sort(), ['/amcl_pose', '/battery_state', '/clock', '/diagnostics', '/map', '/odom', '/plan', '/scan', '/tf', '/tf_static']);
  });

  test('defines its types as ROS 2 does', () => {
    const plain = (definitions) => Object.fromEntries(definitions.map(({ name, definitions: fields }) =>
      [name ?? '', fields.filter((field) => !field.isConstant).map(({ name: field, type, isArray, arrayLength }) => [field, type, !!isArray, arrayLength ?? 0])]));
    for (const schema of reader.schemasById.values()) {
      const ours = plain(parseDefinition(schema));
      for (const known of definitionOf(schema.name)) {
        const name = known.name === schema.name.replace('/msg/', '/') ? '' : known.name;
        assert.deepEqual(ours[name], plain([known])[known.name], `${schema.name}: ${known.name}`);
      }
    }
  });

  test('says where the robot was as run.mcap does', async () => {
    const poses = new Map((await recorded(join(folder, 'run'), '/pose')).map((said) => [said.timestamp.sec * 1e9 + said.timestamp.nsec, said.pose]));
    let compared = 0;
    for (const { message: { header, pose: { pose } } } of messages['/amcl_pose']) {
      const said = poses.get(stampOf(header.stamp));
      if (!said) continue;
      ++compared;
      assert.ok(Math.hypot(pose.position.x - said.position.x, pose.position.y - said.position.y) < 2e-6);
      assert.ok(Math.abs(yawOf(pose.orientation) - yawOf(said.orientation)) < 1e-5);
    }
    assert.ok(compared > 20, `only ${compared} compared`);
    assert.equal(messages['/map'].length, 1);
    assert.ok(messages['/scan'].length > 20 && messages['/scan'].every(({ message }) => message.ranges.length > 100));
    assert.ok(messages['/diagnostics'].at(-1).message.status.length === 3);
  });

  test('is stamped in the messages\' own time', () => {
    for (const topic of ['/amcl_pose', '/odom', '/scan', '/map'])
      for (const { logTime, message } of messages[topic]) assert.equal(Number(logTime), stampOf(message.header.stamp), topic);
  });

  test('is the same byte for byte for the same seed', () => {
    const again = join(folder, 'again.mcap');
    record(again);
    assert.ok(readFileSync(file).equals(readFileSync(again)));
  });
});
