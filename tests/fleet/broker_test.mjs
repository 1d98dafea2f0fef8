// A broker that is not there yet, that goes, and that comes back.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { Witness, freePort, message, orderOver, startBroker, startRobot, until } from './robot.mjs';

test('without its broker the robot drives to the last released node, and is online when it is back', async () => {
  const [serial, version] = ['lonely', '2.1.0'];
  const port = await freePort();
  const url = `mqtt://127.0.0.1:${port}`;
  const robot = startRobot(url, serial, version);
  const witness = new Witness(url, serial, version);
  await until('it has looked for a broker in vain', () => robot.words().includes('no connection'));
  let broker = await startBroker(port);
  const wait = (what, holds) => until(what, holds, () => `${robot.words()}\n${JSON.stringify(witness.state())}`);
  await wait('online', () => witness.connection() === 'ONLINE' && witness.state()?.agvPosition);

  witness.send('order', message(serial, version, orderOver('away', 0, [[1.2, 5.6], [2.2, 5.2], [3.2, 5.2], [4.2, 5.2]], { released: 3 })));
  await wait('it drives', () => witness.state().orderId === 'away' && witness.state().driving);
  await broker.kill();
  const { x } = witness.state().agvPosition;
  assert.ok(x < 2.9, `${x}: the broker must go while the robot is on its way`);
  await until('it arrives without a broker', () => robot.words().includes('at node n2'), robot.words);
  const states = witness.all('state').length;
  broker = await startBroker(port);
  await wait('a state after that', () => witness.all('state').length > states && witness.connection() === 'ONLINE');
  await wait('it stands', () => !witness.state().driving);
  assert.equal(witness.state().lastNodeId, 'n2');
  assert.ok(Math.hypot(witness.state().agvPosition.x - 3.2, witness.state().agvPosition.y - 5.2) < 0.03);
  assert.deepEqual(witness.state().nodeStates.map((node) => node.nodeId), ['n3']);

  witness.send('order', message(serial, version, orderOver('away', 1, [[3.2, 5.2], [4.2, 5.2]], { from: 2 })));
  await wait('and takes its orders', () => witness.state().lastNodeId === 'n3' && !witness.state().nodeStates.length);
  witness.end();
  assert.equal(await robot.end(), 0);
  await broker.kill();
});
