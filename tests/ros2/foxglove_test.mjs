// A third implementation of the wire protocol, which Foxglove connects to ROS 2 with (npm's @foxglove/ros2, in JavaScript
// alone): finds the robot's topics, and reads those that are kept without a patch; it asks of every writer to keep its messages.
// It knows multicast only, so that it gets a network of its own.
import assert from 'node:assert/strict';
import { spawn, spawnSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { createRequire } from 'node:module';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { binary, definitionOf, source, until } from './peer.mjs';

const domain = 7;  // in a network of its own nobody else has it
const wanted = {
  '/tf': 'tf2_msgs/msg/TFMessage', '/tf_static': 'tf2_msgs/msg/TFMessage', '/amcl_pose': 'geometry_msgs/msg/PoseWithCovarianceStamped',
  '/map': 'nav_msgs/msg/OccupancyGrid', '/odom': 'nav_msgs/msg/Odometry', '/diagnostics': 'diagnostic_msgs/msg/DiagnosticArray',
  '/battery_state': 'sensor_msgs/msg/BatteryState', '/clock': 'rosgraph_msgs/msg/Clock',
};

/** A pair of interfaces and a way for multicast: all that a machine alone needs. */
const network = 'ip link set lo up && ip link add lode0 type veth peer name lode1 && ip addr add 10.87.0.1/24 dev lode0 && '
  + 'ip link set lode0 up && ip link set lode1 up && ip route add default via 10.87.0.1';

async function listen() {
  const packages = createRequire(join(resolve(process.env.LODESTAR_ROS2_PACKAGES), 'package.json'));
  const { RosNode } = packages('@foxglove/ros2');
  const { getNetworkInterfaces, UdpSocketNode } = packages('@foxglove/ros2/nodejs');
  const folder = mkdtempSync(join(tmpdir(), 'lodestar-ros2-'));
  const robot = spawn(binary, ['replay', join(source, 'sites/lab'), '--quiet', '--ros2', '--ros-interface', 'lode0', '--ros-domain', String(domain),
    '--goal', '2.2,5.6', '--goal', '1.2,5.6', '--goal', '2.2,5.6', '-o', join(folder, 'run')], { stdio: 'ignore' });
  const node = new RosNode({ name: 'listener', domainId: domain, udpSocketCreate: UdpSocketNode.Create, getNetworkInterfaces });
  await node.start();
  const offered = () => new Map(node.getPublishedTopics());
  await until('all topics are found', () => Object.keys(wanted).every((topic) => offered().has(topic)));
  for (const [topic, type] of Object.entries(wanted)) assert.equal(String(offered().get(topic)), type, topic);
  const heard = {};
  for (const topic of ['/map', '/tf_static', '/amcl_pose']) {
    heard[topic] = [];
    const subscription = node.subscribe({ topic, dataType: wanted[topic], msgDefinition: definitionOf(wanted[topic]) });
    subscription.on('message', (stamp, message) => heard[topic].push(message));
    subscription.on('error', (error) => { throw error; });
  }
  await until('what was kept is heard, and what comes', () => heard['/map'].length > 0 && heard['/tf_static'].length > 0 && heard['/amcl_pose'].length > 2);
  const map = heard['/map'][0];
  assert.equal(map.header.frame_id, 'map');
  assert.equal(map.data.length, map.info.width * map.info.height);
  const [, columns, rows] = readFileSync(join(source, 'sites/lab/map.pgm')).toString('latin1').match(/^P5\s+(?:#.*\s+)*(\d+)\s+(\d+)/).map(Number);
  assert.deepEqual([map.info.width, map.info.height], [columns, rows]);
  for (const pose of heard['/amcl_pose']) {
    const { x, y } = pose.pose.pose.position;
    assert.ok(x > 1.1 && x < 2.3 && Math.abs(y - 5.6) < 0.05, `${x}, ${y}`);
  }
  assert.deepEqual(heard['/tf_static'][0].transforms.map((one) => `${one.header.frame_id} ${one.child_frame_id}`), ['base_link camera_optical']);
  await node.shutdown();
  robot.kill('SIGKILL');
  rmSync(folder, { recursive: true, force: true });
  process.exit(0);
}

if (process.env.LODESTAR_OWN_NETWORK) {
  await listen();
} else {
  test('Foxglove\'s own node finds the topics and reads them', () => {
    const asRoot = process.getuid() === 0 ? ['-n'] : ['-r', '-n'];
    const ran = spawnSync('unshare', [...asRoot, 'sh', '-c', `${network} && exec node "$0"`, fileURLToPath(import.meta.url)],
      { env: { ...process.env, LODESTAR_OWN_NETWORK: '1', CYCLONEDDS_URI: undefined, PATH: `${process.env.PATH}:/usr/sbin:/sbin` }, encoding: 'utf8', timeout: 180_000 });
    assert.equal(ran.status, 0, `${ran.error ?? ''}${ran.stdout}${ran.stderr}`);
  });
}
