// What a robot publishes as a ROS 2 node, as software of others receives it.
import assert from 'node:assert/strict';
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, describe, test } from 'node:test';
import { Peer, Robot, dissected, freeDomain, recorded, stampOf, startCapture, yawOf } from './peer.mjs';

const type = (library, name) => `${library}::msg::dds_::${name}_`;
const tfType = type('tf2_msgs', 'TFMessage');
const poseType = type('geometry_msgs', 'PoseWithCovarianceStamped');

// REP 2003 and what Nav2, tf2 and their tools use; the hashes of ros2.md's list, LaserScan and Clock computed as these.
const published = {
  'rt/tf': { type: tfType, kept: false, hash: 'e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087' },
  'rt/tf_static': { type: tfType, kept: true, hash: 'e369d0f05a23ae52508854b66f6aa0437f3449d652e8cbf22d5abe85d020f087' },
  'rt/odom': { type: type('nav_msgs', 'Odometry'), kept: false, hash: '3cc97dc7fb7502f8714462c526d369e35b603cfc34d946e3f2eda2766dfec6e0' },
  'rt/amcl_pose': { type: poseType, kept: true, hash: '26432f9803e43727d3c8f668d1fdb3c630f548af631e2f4e31382371bfea3b6e' },
  'rt/map': { type: type('nav_msgs', 'OccupancyGrid'), kept: true, hash: '8d348150c12913a31ee0ec170fbf25089e4745d17035792a1ba94d6f0bc0cfc7' },
  'rt/plan': { type: type('nav_msgs', 'Path'), kept: true, hash: '1957a5bb3cee5da65c4e52e52b65a93df227efce4c20f8458b36e73066ca334b' },
  'rt/scan': { type: type('sensor_msgs', 'LaserScan'), kept: false, hash: '64c191398013af96509d518dac71d5164f9382553fce5c1f8cca5be7924bd828' },
  'rt/diagnostics': { type: type('diagnostic_msgs', 'DiagnosticArray'), kept: false, hash: '5a8a36efb05fb25070fa0fb3810290c0e6cd4862b54a8fb975a1ee8dc55a333e' },
  'rt/battery_state': { type: type('sensor_msgs', 'BatteryState'), kept: false, hash: '4bee5dfce981c98faa6828b868307a0a73f992ed0789f374ee96c8f840e69741' },
  'rt/clock': { type: type('rosgraph_msgs', 'Clock'), kept: false, hash: '692f7a66e93a3c83e71765d033b60349ba68023a8c689a79e48078bcb5c58564' },
  ros_discovery_info: { type: type('rmw_dds_common', 'ParticipantEntitiesInfo'), kept: true, hash: '91a0593bacdcc50ea9bdcf849a938b128412cc1ea821245c663bcd26f83c295e' },
};

/** The transforms of a chain at the same stamp, one after the other. */
function composed(a, b) {
  const yaw = yawOf(a.rotation);
  return {
    x: a.translation.x + Math.cos(yaw) * b.translation.x - Math.sin(yaw) * b.translation.y,
    y: a.translation.y + Math.sin(yaw) * b.translation.x + Math.cos(yaw) * b.translation.y,
    yaw: yaw + yawOf(b.rotation),
  };
}
const near = (a, b, within, what) => assert.ok(Math.abs(a - b) <= within, `${what}: found ${a}, wanted ${b}`);
const turned = (yaw) => Math.atan2(Math.sin(yaw), Math.cos(yaw));

describe('a driving robot as a ROS 2 node', () => {
  const domain = freeDomain();
  let robot;
  let peer;
  let capture;
  const folder = mkdtempSync(join(tmpdir(), 'lodestar-ros2-capture-'));
  const packets = join(folder, 'packets.pcapng');
  before(async () => {
    capture = await startCapture(packets);
    robot = new Robot(domain, '--goal', '2.4,5.5', '--people', '1');
    await new Promise((done) => setTimeout(done, 3000));  // late: map and mounts were sent before
    peer = new Peer(domain);
    for (const [topic, { type: name, kept }] of Object.entries(published)) if (topic.startsWith('rt/')) peer.read(topic, name, { kept });
    await robot.ended;
    await peer.heard('rt/amcl_pose', 10);
    await peer.end();
    await capture?.end();
  });
  after(() => { for (const used of [robot.folder, folder]) rmSync(used, { recursive: true, force: true }); });

  test('offers each topic with its type, QoS and type hash', () => {
    for (const [topic, wanted] of Object.entries(published)) {
      const found = peer.writers[topic];
      assert.ok(found, `nobody writes ${topic}`);
      assert.deepEqual({ type: found.type, reliable: found.reliable, kept: found.kept, user: found.user_data },
        { type: wanted.type, reliable: true, kept: wanted.kept, user: `typehash=RIHS01_${wanted.hash};` }, topic);
    }
  });

  test('gives who joins late the map, cell by cell as recorded', async () => {
    const [grid] = await recorded(robot.run, '/map');
    const cells = Buffer.from(grid.data, 'base64');
    const [map] = peer.messages['rt/map'];
    assert.equal(peer.messages['rt/map'].length, 1);
    assert.equal(map.header.frame_id, 'map');
    assert.equal(map.info.width, grid.column_count);
    assert.equal(map.info.width * map.info.height, map.data.length);
    near(map.info.resolution, grid.cell_size.x, 1e-6, 'resolution');
    near(map.info.origin.position.x, grid.pose.position.x, 1e-9, 'origin x');
    near(map.info.origin.position.y, grid.pose.position.y, 1e-9, 'origin y');
    assert.deepEqual(Buffer.from(Uint8Array.from(map.data)), cells);
    assert.ok(cells.includes(100) && cells.includes(0));
  });

  test('says where it is as recorded', async () => {
    const poses = new Map((await recorded(robot.run, '/pose')).map((said) => [said.timestamp.sec * 1e9 + said.timestamp.nsec, said.pose]));
    let compared = 0;
    for (const { header, pose: { pose, covariance } } of peer.messages['rt/amcl_pose']) {
      const said = poses.get(stampOf(header.stamp));
      if (!said) continue;
      ++compared;
      near(pose.position.x, said.position.x, 1e-6, 'x');  // the record has six decimals
      near(pose.position.y, said.position.y, 1e-6, 'y');
      near(turned(yawOf(pose.orientation) - yawOf(said.orientation)), 0, 1e-5, 'yaw');
      assert.ok(covariance[0] > 0 && covariance[0] < 0.01 && covariance[35] > 0 && covariance[14] === 0);
    }
    assert.ok(compared >= 10, `only ${compared} compared`);
  });

  test('has one chain of transforms, map to odom to base_link, that ends where it is', () => {
    const poses = new Map(peer.messages['rt/amcl_pose'].map(({ header, pose }) => [stampOf(header.stamp), pose.pose]));
    let compared = 0;
    for (const { transforms } of peer.messages['rt/tf']) {
      const names = transforms.map(({ header, child_frame_id: child }) => `${header.frame_id} ${child}`);
      if (transforms.length === 1) { assert.deepEqual(names, ['odom base_link']); continue; }
      assert.deepEqual(names, ['map odom', 'odom base_link']);
      const pose = poses.get(stampOf(transforms[1].header.stamp));
      if (!pose) continue;
      ++compared;
      const at = composed(transforms[0].transform, transforms[1].transform);
      near(at.x, pose.position.x, 1e-6, 'x');
      near(at.y, pose.position.y, 1e-6, 'y');
      near(turned(at.yaw - yawOf(pose.orientation)), 0, 1e-6, 'yaw');
    }
    assert.ok(compared >= 10, `only ${compared} compared`);
  });

  test('never lets its odometry jump, and turns and drives as it says', () => {
    const said = peer.messages['rt/odom'];
    assert.ok(said.length > 50);
    let fastest = 0;
    for (let i = 1; i < said.length; ++i) {
      const [a, b] = [said[i - 1], said[i]];
      assert.deepEqual([b.header.frame_id, b.child_frame_id], ['odom', 'base_link']);
      const dt = (stampOf(b.header.stamp) - stampOf(a.header.stamp)) / 1e9;
      if (dt <= 0) continue;
      const moved = Math.hypot(b.pose.pose.position.x - a.pose.pose.position.x, b.pose.pose.position.y - a.pose.pose.position.y);
      assert.ok(moved <= 1.0 * dt + 1e-3, `a jump of ${moved} m in ${dt} s`);
      fastest = Math.max(fastest, b.twist.twist.linear.x);
    }
    assert.ok(fastest > 0.1 && fastest < 1.0, `${fastest} m/s`);
  });

  test('says where its camera and its scanner are', () => {
    const [{ transforms }] = peer.messages['rt/tf_static'];
    assert.deepEqual(transforms.map(({ header, child_frame_id: child }) => `${header.frame_id} ${child}`),
      ['base_link camera_optical', 'base_link scanner']);
  });

  test('publishes even scans', () => {
    const scans = peer.messages['rt/scan'];
    assert.ok(scans.length > 10);
    for (const scan of scans) {
      assert.equal(scan.header.frame_id, 'scanner');
      assert.equal(scan.ranges.length, scan.intensities.length);
      near(scan.angle_min + (scan.ranges.length - 1) * scan.angle_increment, scan.angle_max, 1e-3, 'last angle');
      const hits = [...scan.ranges].filter(Number.isFinite);
      assert.ok(hits.length > scan.ranges.length / 2);
      assert.ok(hits.every((range) => range >= scan.range_min && range <= scan.range_max));
    }
  });

  test('plans, and says how it is', () => {
    const plans = peer.messages['rt/plan'];
    assert.ok(plans.length > 0);
    const plan = plans.find(({ poses }) => poses.length > 1);
    assert.ok(plan, 'no plan');
    const last = plan.poses.at(-1).pose.position;
    near(last.x, 2.4, 0.05, 'x of the goal');
    near(last.y, 5.5, 0.05, 'y of the goal');
    const newest = peer.messages['rt/diagnostics'].at(-1);
    assert.deepEqual(newest.status.map(({ name, level }) => `${name} ${level}`).slice(0, 2),
      ['lodestar: localization 0', 'lodestar: base 0']);
    assert.ok(peer.messages['rt/battery_state'].every(({ voltage, present }) => voltage > 10 && present));
  });

  test('is dissected by Wireshark: every topic is named, nothing is malformed', (t) => {
    if (!capture) return t.skip('tshark may not capture here');
    const names = dissected(packets, 'rtps.param.topicName', 'rtps.param.topicName').flatMap((line) => line.split(','));
    for (const topic of Object.keys(published)) assert.ok(names.includes(topic), `Wireshark saw no ${topic}`);
    assert.ok(dissected(packets, 'rtps.sm.id == 0x15', 'frame.number').length > 100);
    assert.deepEqual(dissected(packets, 'rtps && _ws.malformed', 'frame.number'), []);
  });

  test('tells simulated time, forward', () => {
    const times = peer.messages['rt/clock'].map(({ clock }) => stampOf(clock));
    assert.ok(times.length > 50);
    assert.ok(times.every((time, i) => i === 0 || time > times[i - 1]));
    assert.ok(times.at(-1) < 300e9);
  });
});
