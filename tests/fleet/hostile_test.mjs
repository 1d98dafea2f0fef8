// What is no message: the robot says so, and drives on.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { Witness, freePort, message, orderOver, startBroker, startRobot, until } from './robot.mjs';

test('garbage is a validationError, and the drive goes on', async () => {
  const [serial, version] = ['patient', '2.0.0'];
  const port = await freePort();
  const url = `mqtt://127.0.0.1:${port}`;
  const broker = await startBroker(port);
  const witness = new Witness(url, serial, version);
  const robot = startRobot(url, serial, version);
  const wait = (what, holds) => until(what, holds, () => `${robot.words()}\n${JSON.stringify(witness.state())}`);
  await wait('online', () => witness.connection() === 'ONLINE' && witness.state()?.agvPosition);
  witness.send('order', message(serial, version, orderOver('far', 0, [[1.2, 5.6], [4.2, 5.2]])));
  await wait('it drives', () => witness.state().driving);

  const said = (words) => witness.state().errors.some((error) => error.errorType === 'validationError' && error.errorDescription.includes(words));
  witness.send('order', Buffer.alloc(1 << 20, '['));
  await wait('a megabyte is too much', () => said('bytes'));
  witness.send('order', '['.repeat(100_000));
  await wait('so deep a nest is not read', () => said('nested'));
  witness.send('instantActions', Buffer.from([0x7b, 0x22, 0xff, 0xfe, 0x22, 0x3a, 0x31, 0x7d]));
  await wait('broken UTF-8 is no JSON', () => witness.state().errors.some((error) => error.errorType === 'validationError'
    && error.errorReferences.some((one) => one.referenceValue === 'instantActions')));
  const many = Array.from({ length: 10_000 }, (_, i) => ({ nodeId: `${i}`, sequenceId: 2 * i, released: true, actions: [] }));
  witness.send('order', message(serial, version, { orderId: 'many', orderUpdateId: 0, nodes: many, edges: [] }));
  await wait('10,000 nodes are too many', () => said('10000'));
  for (let i = 0; i < 500; ++i) witness.send('order', `nonsense ${i}`);

  await wait('it arrives all the same', () => witness.state().lastNodeId === 'n1' && !witness.state().nodeStates.length);
  assert.deepEqual(witness.faults.slice(0, 3), []);
  witness.end();
  assert.equal(await robot.end(), 0);
  await broker.kill();
});
