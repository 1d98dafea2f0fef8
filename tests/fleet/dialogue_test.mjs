// A whole dialogue between the MasterController of vda-5050-lib and a simulated robot, over mosquitto.
import assert from 'node:assert/strict';
import { after, before, describe, test } from 'node:test';
import { MasterController, Witness, freePort, hasSchemas, message, orderOver, startBroker, startRobot, until } from './robot.mjs';

const start = [1.2, 5.6];
const action = (actionId, actionType, parameters = {}, blockingType = 'HARD') => ({
  actionId, actionType, blockingType, actionParameters: Object.entries(parameters).map(([key, value]) => ({ key, value })),
});

for (const version of ['2.0.0', '2.1.0']) {
  describe(`VDA 5050 ${version}`, () => {
    const serial = `robot-${version}`;
    const agv = { manufacturer: 'ACME', serialNumber: serial };
    let broker, url, robot, witness, master;
    const wait = (what, holds) => until(what, holds, () => `${robot.words()}\n${JSON.stringify(witness.state())}`);
    const errorOf = (type) => witness.state()?.errors.find((error) => error.errorType === type);
    const statusOf = (id) => witness.state()?.actionStates.find((one) => one.actionId === id)?.actionStatus;
    const refers = (error, key, value) => error.errorReferences.some((one) => one.referenceKey === key && one.referenceValue === value);
    /** The npm master speaks 2.0.0; for 2.1.0 the same messages are sent by hand. */
    const assign = (order) => {
      if (version !== '2.0.0') { witness.send('order', message(serial, version, order)); return undefined; }
      const seen = { order, done: undefined, traversed: [] };
      master.assignOrder(agv, order, {
        onOrderProcessed: (error, cancelled, active) => { seen.done = { error, cancelled, active }; },
        onNodeTraversed: (node) => seen.traversed.push(node.nodeId),
      });
      return seen;
    };
    const instant = (one) => {
      if (version !== '2.0.0') { witness.send('instantActions', message(serial, version, { actions: [one] })); return undefined; }
      const seen = { states: [], error: undefined };
      master.initiateInstantActions(agv, { instantActions: [one] }, {
        onActionStateChanged: (state, error) => { seen.states.push(state.actionStatus); seen.error ??= error; },
        onActionError: (error) => { seen.error = error; },
      });
      return seen;
    };

    before(async () => {
      const port = await freePort();
      url = `mqtt://127.0.0.1:${port}`;
      broker = await startBroker(port);
      witness = new Witness(url, serial, version);
      master = new MasterController({ interfaceName: 'uagv', vdaVersion: '2.0.0', transport: { brokerUrl: url } }, { targetAgvs: agv });
      await master.start();
      robot = startRobot(url, serial, version);
      await until('the robot is online and knows where it is', () => witness.connection() === 'ONLINE' && witness.state()?.agvPosition, () => robot.words());
    });
    after(async () => { await master?.stop(); witness?.end(); await robot?.kill(); await broker?.kill(); });

    test('an order is driven to its end', async () => {
      const seen = assign(orderOver('first', 0, [start, [1.7, 5.28], [2.2, 5.28]], {
        actions: { n1: [action('p1', 'pick', { side: 'left' })], n2: [action('w1', 'wait', { seconds: 0.5 })] },
      }));
      await wait('the order is done', () => witness.state().orderId === 'first' && !witness.state().nodeStates.length && statusOf('w1') === 'FINISHED');
      const picked = witness.state().actionStates.find((one) => one.actionId === 'p1');
      assert.deepEqual([picked.actionStatus, picked.resultDescription], ['FINISHED', 'box 7']);
      assert.equal(witness.state().lastNodeId, 'n2');
      assert.equal(witness.state().lastNodeSequenceId, 4);
      assert.ok(Math.hypot(witness.state().agvPosition.x - 2.2, witness.state().agvPosition.y - 5.28) < 0.03);
      if (seen) await wait('the master knows', () => seen.done && !seen.done.error && !seen.done.active);
    });

    test('a horizon waits for its release, and an update is stitched on', async () => {
      const points = [[2.2, 5.28], [2.7, 5.28], [3.2, 5.28]];
      const first = assign(orderOver('long', 0, points, { released: 2 }));
      await wait('the end of the base', () => witness.state().orderId === 'long' && witness.state().lastNodeSequenceId === 2);
      await wait('it stands and asks for more', () => !witness.state().driving && witness.state().newBaseRequest);
      assert.deepEqual(witness.state().nodeStates.map((node) => [node.nodeId, node.released]), [['n2', false]]);
      if (first) await wait('the master sees the base done', () => first.done?.active === true);
      const wrong = orderOver('long', 1, points.slice(0), { from: 0 });
      witness.send('order', message(serial, version, wrong));
      const error = await wait('an update from the wrong node is rejected', () => errorOf('orderUpdateError'));
      assert.ok(refers(error, 'orderUpdateId', '1') && refers(error, 'orderId', 'long'));
      const second = assign(orderOver('long', 2, points.slice(1), { from: 1 }));
      await wait('the update is driven', () => witness.state().orderUpdateId === 2 && !witness.state().nodeStates.length);
      assert.equal(errorOf('orderUpdateError'), undefined);
      if (second) await wait('the master knows', () => second.done && !second.done.error);
    });

    test('nodes on the way are passed without a stop, those of an update too, and maxSpeed holds on its edge', async () => {
      const points = [[3.2, 5.28], [2.6, 5.28], [2.0, 5.28], [1.2, 5.28]];
      const update = orderOver('flow', 1, points.slice(1), { from: 1 });
      update.edges[0].maxSpeed = 0.2;
      const from = witness.all('state').length;
      witness.send('order', message(serial, version, orderOver('flow', 0, points, { released: 2 })));
      witness.send('order', message(serial, version, update));
      await wait('the order is done', () => witness.state().orderUpdateId === 1 && !witness.state().nodeStates.length);
      const between = (first, last) => witness.all('state').slice(from)
        .filter((state) => state.orderId === 'flow' && state.lastNodeSequenceId >= first && state.lastNodeSequenceId < last);
      const passing = between(2, 6);
      assert.ok(passing.some((state) => state.lastNodeSequenceId === 2) && passing.some((state) => state.lastNodeSequenceId === 4));
      for (const { velocity, driving } of between(2, 4)) assert.ok(driving && velocity.vx > 0.1 && velocity.vx < 0.22, JSON.stringify(velocity));
      // It rests at the last node for a while before that counts as reached, and nowhere before.
      const [endX, endY] = points.at(-1);
      for (const { driving, agvPosition: { x, y } } of passing)
        assert.ok(driving || Math.hypot(x - endX, y - endY) < 0.05, `rests at ${x}, ${y}`);
    });

    test('pause, resume, cancel, and a second cancel', async () => {
      assign(orderOver('far', 0, [[1.2, 5.28], [6.0, 5.6]]));
      await wait('it drives', () => witness.state().orderId === 'far' && witness.state().driving);
      const pause = instant(action('pause', 'startPause'));
      await wait('it stands', () => statusOf('pause') === 'FINISHED' && witness.state().paused && !witness.state().driving);
      const { x, y } = witness.state().agvPosition;
      assert.ok(Math.hypot(x - 6.0, y - 5.6) > 0.5, `${x}, ${y}`);
      if (pause) await wait('the master saw it', () => pause.states.includes('FINISHED'));
      instant(action('resume', 'stopPause'));
      await wait('it drives again', () => !witness.state().paused && witness.state().driving);
      instant(action('cancel', 'cancelOrder'));
      await wait('it is cancelled', () => statusOf('cancel') === 'FINISHED');
      assert.equal(witness.state().nodeStates.length, 0);
      assert.equal(witness.state().orderId, 'far');
      assert.ok(!witness.state().driving);
      const second = instant(action('cancel-2', 'cancelOrder'));
      await wait('nothing is left to cancel', () => statusOf('cancel-2') === 'FAILED' && errorOf('noOrderToCancel'));
      if (second) await wait('the master knows', () => second.error?.errorType === 'noOrderToCancel');
    });

    test('bad orders are rejected with what they ask for', async () => {
      const here = () => { const { x, y } = witness.state().agvPosition; return [x, y]; };
      const away = assign(orderOver('away', 0, [[12, 2], [13, 2]]));
      await wait('the start is out of reach', () => refers(errorOf('noRouteError') ?? { errorReferences: [] }, 'orderId', 'away'));
      if (away) await wait('the master knows', () => away.done?.error?.errorType === 'noRouteError');
      witness.send('order', message(serial, version, orderOver('narrow', 0, [here(), [6, 5.6]], { edge: { corridor: { leftWidth: 1, rightWidth: 1 } } })));
      await wait('a corridor is named', () => refers(errorOf('orderError') ?? { errorReferences: [] }, 'parameter', 'corridor'));
      witness.send('order', message(serial, version, { ...orderOver('broken', 0, [here(), [6, 5.6]]), edges: [] }));
      await wait('edges are missing', () => refers(errorOf('validationError') ?? { errorReferences: [] }, 'orderId', 'broken'));
      assert.equal(witness.state().orderId, 'far');
    });

    test('an unknown action fails, and is not answered twice', async () => {
      const seen = instant(action('dance', 'dance'));
      await wait('it fails', () => statusOf('dance') === 'FAILED');
      if (seen) await wait('the master knows', () => seen.error?.errorType === 'instantActionError');
      await new Promise((done) => setTimeout(done, 1000));
      const before = witness.all('state').length;
      for (let i = 0; i < 200; ++i) witness.send('instantActions', message(serial, version, { actions: [action('dance', 'dance')] }));
      instant(action('mark', 'stateRequest'));
      await wait('the storm is over', () => statusOf('mark') === 'FINISHED');
      assert.ok(witness.all('state').length - before < 20, `${witness.all('state').length - before} states`);
    });

    test('initPosition, stateRequest and factsheetRequest are carried out', async () => {
      const { x, y, theta } = witness.state().agvPosition;
      instant(action('here', 'initPosition', { x, y, theta, mapId: 'lab', lastNodeId: 'dock' }));
      await wait('it is placed', () => statusOf('here') === 'FINISHED' && witness.state().lastNodeId === 'dock');
      const factsheets = witness.all('factsheet').length;
      instant(action('facts', 'factsheetRequest'));
      await wait('a factsheet', () => statusOf('facts') === 'FINISHED' && witness.all('factsheet').length > factsheets);
      assert.equal(witness.all('factsheet').at(-1).physicalParameters.speedMax, 0.6);
    });

    test('it drives onto its dock, and says truly whether it charges', async () => {
      const { x, y } = witness.state().agvPosition;
      assert.equal(witness.state().batteryState.charging, false);
      assign(orderOver('charge', 0, [[x, y], [1.7, 5.6]], { actions: { n1: [action('c1', 'startCharging')] } }));
      await wait('it is on its way', () => statusOf('c1') === 'RUNNING');
      const other = instant(action('c2', 'startCharging'));
      await wait('nothing else may bring it there meanwhile', () => statusOf('c2') === 'FAILED');
      if (other) await wait('the master knows', () => other.error?.errorType === 'instantActionError');
      await wait('it charges', () => statusOf('c1') === 'FINISHED' && witness.state().batteryState.charging);
      const { agvPosition, operatingMode } = witness.state();
      assert.ok(Math.hypot(agvPosition.x - 1.0, agvPosition.y - 5.6) < 0.03 && operatingMode === 'AUTOMATIC', JSON.stringify(agvPosition));
      instant(action('c3', 'stopCharging'));
      await wait('it has stopped', () => statusOf('c3') === 'FINISHED' && !witness.state().batteryState.charging);
      assign(orderOver('leave', 0, [[1.0, 5.6], [1.7, 5.6]], { actions: {} }));
      await wait('it drives off', () => witness.state().orderId === 'leave' && !witness.state().nodeStates.length);
    });

    test('a cancelled order does not go on to the dock', async () => {
      assign(orderOver('again', 0, [[1.7, 5.6]], { actions: { n0: [action('c4', 'startCharging')] } }));
      await wait('it drives to the dock', () => statusOf('c4') === 'RUNNING' && witness.state().driving);
      instant(action('cancel-3', 'cancelOrder'));
      await wait('it stands, and it is cancelled', () => statusOf('cancel-3') === 'FINISHED' && statusOf('c4') === 'FAILED' && !witness.state().driving);
      const { x } = witness.state().agvPosition;
      await new Promise((done) => setTimeout(done, 1500));
      assert.ok(Math.abs(witness.state().agvPosition.x - x) < 0.02);
    });

    test('states come no faster than ten a second, with headerIds in turn', () => {
      const states = witness.messages.filter((one) => one.topic === 'state');
      const ids = states.map((one) => one.message.headerId);
      assert.deepEqual(ids, ids.map((_, i) => ids[0] + i));
      const took_s = (states.at(-1).at - states[0].at) / 1000;
      assert.ok(states.length <= 10.5 * took_s + 10, `${states.length} states in ${took_s} s`);
    });

    test('the last will tells of a robot that is gone, and a goodbye of one that leaves', async () => {
      await robot.kill();
      await until('CONNECTIONBROKEN', () => witness.connection() === 'CONNECTIONBROKEN');
      robot = startRobot(url, serial, version);
      await wait('ONLINE again', () => witness.connection() === 'ONLINE');
      await robot.end();
      await until('OFFLINE', () => witness.connection() === 'OFFLINE');
    });

    test('every message is as the schemas of the standard want it', (t) => {
      if (!hasSchemas) return t.skip('the schemas are not there');
      assert.ok(witness.all('state').length > 30);
      assert.deepEqual(witness.faults.slice(0, 3), []);
    });
  });
}
