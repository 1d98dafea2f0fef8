// What a robot does that others in the network ask for, and what it does not.
import assert from 'node:assert/strict';
import { after, before, describe, test } from 'node:test';
import { Peer, Robot, freeDomain, stampOf, until } from './peer.mjs';

const poseStamped = 'geometry_msgs::msg::dds_::PoseStamped_';
const poseWithCovariance = 'geometry_msgs::msg::dds_::PoseWithCovarianceStamped_';
const at = (x, y, yaw = 0) => ({ position: { x, y, z: 0 }, orientation: { x: 0, y: 0, z: Math.sin(yaw / 2), w: Math.cos(yaw / 2) } });
const header = (frame) => ({ stamp: { sec: 0, nanosec: 0 }, frame_id: frame });
const goal = (pose, frame = 'map') => ({ header: header(frame), pose });
const initial = (pose, frame = 'map') => ({ header: header(frame), pose: { pose, covariance: new Float64Array(36) } });

describe('commands by topic', () => {
  const domain = freeDomain();
  let robot;
  let peer;
  const here = () => peer.messages['rt/amcl_pose'].at(-1).pose.pose.position;
  const isAt = (x, y) => Math.hypot(here().x - x, here().y - y) < 0.05;

  before(async () => {
    robot = new Robot(domain, '--ros2-commands');
    peer = new Peer(domain);
    peer.read('rt/amcl_pose', poseWithCovariance, { kept: true });
    peer.read('rt/plan', 'nav_msgs::msg::dds_::Path_', { kept: true });
    await peer.heard('rt/amcl_pose');
  });
  after(async () => {
    await peer.end();
    await robot.end();
  });

  test('a goal is driven to, and its plan ends when it is reached', async () => {
    peer.write('rt/goal_pose', poseStamped, goal(at(2.2, 5.6, Math.PI / 2)));
    await robot.says('goal_pose (2.20, 5.60, 90 deg)');
    await until('a plan', () => peer.messages['rt/plan'].some(({ poses }) => poses.length > 1));
    await robot.says('goal 1: arrived');
    assert.ok(isAt(2.2, 5.6));
    await until('its end', () => peer.messages['rt/plan'].at(-1).poses.length === 0);
  });

  test('a new goal takes the place of one that came the same way, and a pose while it drives is refused', async () => {
    peer.write('rt/goal_pose', poseStamped, goal(at(8.0, 5.6)));
    await until('it drives', () => here().y < 5.2);
    peer.write('rt/initialpose', poseWithCovariance, initial(at(9, 3)));
    await robot.says('initialpose (9.00, 3.00, 0 deg): not now');
    peer.write('rt/goal_pose', poseStamped, goal(at(2.4, 5.5)));
    await until('the robot there', () => isAt(2.4, 5.5));
    assert.ok(peer.messages['rt/amcl_pose'].every(({ pose: { pose } }) => pose.position.x < 6));
    await until('the end of its plan', () => peer.messages['rt/plan'].at(-1).poses.length === 0);
  });

  test('a goal in a wall is told of', async () => {
    peer.write('rt/goal_pose', poseStamped, goal(at(3.0, 5.6)));
    await robot.says('goal occupied');
  });

  test('what is no pose of the map moves nothing, and is named', async () => {
    const plans = () => peer.messages['rt/plan'].filter(({ poses }) => poses.length > 0).length;  // an end may still be on its way
    const before = plans();
    const bad = { 'frame \'odom\'': goal(at(5, 5), 'odom'), 'not finite': goal(at(NaN, 5)), 'beyond 10 km': goal(at(2e4, 5)),
      'length 0': goal({ position: { x: 5, y: 5, z: 0 }, orientation: { x: 0, y: 0, z: 0, w: 0 } }),
      upright: goal({ position: { x: 5, y: 5, z: 0 }, orientation: { x: 1, y: 0, z: 0, w: 0 } }) };
    for (const [words, message] of Object.entries(bad)) {
      peer.write('rt/goal_pose', poseStamped, message);
      await robot.says(words);
    }
    await peer.heard('rt/amcl_pose', peer.messages['rt/amcl_pose'].length + 5);
    assert.equal(plans(), before);
  });

  test('bytes that are no message are passed over', async () => {
    for (const bytes of ['', '00', '00010000', '00010000ffffffffffffffffffffffff', '0001000000000000000000000000ffff6d617000'])
      peer.child.stdin.write(`write rt/goal_pose ${poseStamped} ${bytes}\n`);
    const count = peer.messages['rt/amcl_pose'].length;
    await peer.heard('rt/amcl_pose', count + 10);
    peer.write('rt/goal_pose', poseStamped, goal(at(2.2, 5.6)));
    await until('the robot there', () => isAt(2.2, 5.6));
  });
});

describe('readers that misbehave', () => {
  test('one that stands still and one that joins a hundred times cost another nothing', async () => {
    const domain = freeDomain() + 1;
    const robot = new Robot(domain, '--ros2-commands');
    const healthy = new Peer(domain);
    healthy.read('rt/tf', 'tf2_msgs::msg::dds_::TFMessage_');
    await healthy.heard('rt/tf', 10);
    const stopped = new Peer(domain);
    for (const topic of ['rt/tf', 'rt/odom', 'rt/clock']) stopped.read(topic, { 'rt/tf': 'tf2_msgs::msg::dds_::TFMessage_', 'rt/odom': 'nav_msgs::msg::dds_::Odometry_', 'rt/clock': 'rosgraph_msgs::msg::dds_::Clock_' }[topic]);
    await stopped.heard('rt/clock', 10);
    stopped.child.kill('SIGSTOP');
    const first = healthy.messages['rt/tf'].length;
    for (let i = 0; i < 100; ++i) {
      const guest = new Peer(domain);
      guest.read('rt/map', 'nav_msgs::msg::dds_::OccupancyGrid_', { kept: true });
      if (i % 20 === 0) await guest.heard('rt/map');
      await guest.kill();
    }
    await healthy.heard('rt/tf', healthy.messages['rt/tf'].length + 50);
    const stamps = healthy.messages['rt/tf'].slice(first).map(({ transforms }) => stampOf(transforms[0].header.stamp));
    // Each step of 20 ms has one: the loop's reports were all sent, none left out for a reader that does not read.
    const gaps = stamps.slice(1).map((stamp, i) => (stamp - stamps[i]) / 1e6);
    assert.ok(gaps.every((gap) => gap <= 21), `gaps of ${Math.max(...gaps)} ms`);
    stopped.kill();
    await healthy.end();
    assert.equal(await robot.end(), 0);
  });
});
