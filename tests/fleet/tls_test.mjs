// A broker that lets nobody in without a certificate, and a robot that trusts no broker without one.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, describe, test } from 'node:test';
import { Witness, freePort, message, orderOver, startBroker, startRobot, until } from './robot.mjs';

const folder = mkdtempSync(join(tmpdir(), 'lodestar-tls-'));
const file = (name) => join(folder, name);
const openssl = (...options) => execFileSync('openssl', options, { cwd: folder, stdio: 'ignore' });

function authority(name) {
  openssl('req', '-x509', '-newkey', 'ec', '-pkeyopt', 'ec_paramgen_curve:prime256v1', '-nodes', '-days', '2',
    '-subj', `/CN=${name}`, '-keyout', `${name}.key`, '-out', `${name}.pem`);
}
function certificate(name, by, subject) {
  openssl('req', '-new', '-newkey', 'ec', '-pkeyopt', 'ec_paramgen_curve:prime256v1', '-nodes', '-subj', `/CN=${name}`,
    '-keyout', `${name}.key`, '-out', `${name}.csr`);
  writeFileSync(file(`${name}.ext`), `subjectAltName=${subject}\n`);
  openssl('x509', '-req', '-in', `${name}.csr`, '-CA', `${by}.pem`, '-CAkey', `${by}.key`, '-CAcreateserial', '-days', '2',
    '-extfile', `${name}.ext`, '-out', `${name}.pem`);
}
const identity = (ca, name) => `ca_file: ${file(`${ca}.pem`)}, ${name ? `certificate_file: ${file(`${name}.pem`)}, key_file: ${file(`${name}.key`)},` : ''}`;
// As root it would become another user, who cannot read the keys.
const broker = (port, name) => startBroker(port, `user root\nallow_anonymous true\ncafile ${file('site.pem')}\ncertfile ${file(`${name}.pem`)}\nkeyfile ${file(`${name}.key`)}\nrequire_certificate true`);

describe('TLS with certificates of both sides', () => {
  before(() => {
    for (const name of ['site', 'stranger']) authority(name);
    certificate('broker', 'site', 'IP:127.0.0.1,DNS:localhost');
    certificate('elsewhere', 'site', 'DNS:elsewhere.example');
    certificate('robot', 'site', 'DNS:robot');
    certificate('intruder', 'stranger', 'DNS:robot');
  });
  after(() => rmSync(folder, { recursive: true, force: true }));

  test('the robot comes in with its certificate, and drives an order', async () => {
    const port = await freePort();
    const server = await broker(port, 'broker');
    const url = `mqtts://localhost:${port}`;
    const robot = startRobot(url, 'trusted', '2.1.0', identity('site', 'robot'));
    const witness = new Witness(url, 'trusted', '2.1.0', { ca: readFileSync(file('site.pem')), cert: readFileSync(file('robot.pem')), key: readFileSync(file('robot.key')) });
    await until('online', () => witness.connection() === 'ONLINE' && witness.state()?.agvPosition, robot.words);
    witness.send('order', message('trusted', '2.1.0', orderOver('safe', 0, [[1.2, 5.6], [2.2, 5.6]])));
    await until('arrived', () => witness.state().lastNodeId === 'n1' && !witness.state().nodeStates.length, robot.words);
    assert.deepEqual(witness.faults, []);
    witness.end();
    assert.equal(await robot.end(), 0);
    await server.kill();
  });

  const refused = [
    ['without a certificate of its own', 'broker', identity('site'), /certificate required/],
    ['with one of another authority', 'broker', identity('site', 'intruder'), /unknown ca/],
    ['by a broker of another authority', 'broker', identity('stranger', 'robot'), /certificate verify failed/],
    ['by a broker with another host\'s certificate', 'elsewhere', identity('site', 'robot'), /certificate verify failed/],
  ];
  for (const [how, name, its, words] of refused) {
    test(`${how} nothing is said, and it goes on trying`, async () => {
      const port = await freePort();
      const server = await broker(port, name);
      const url = `mqtts://localhost:${port}`;
      const robot = startRobot(url, 'outside', '2.1.0', its);
      const witness = new Witness(url, 'outside', '2.1.0', { ca: readFileSync(file('site.pem')), cert: readFileSync(file('robot.pem')), key: readFileSync(file('robot.key')), checkServerIdentity: () => undefined });
      await until('it says that it is not let in', () => words.test(robot.words()), robot.words);
      await new Promise((done) => setTimeout(done, 3000));
      assert.equal(witness.messages.length, 0, robot.words());
      witness.end();
      assert.equal(await robot.end(), 0);
      assert.match(robot.words(), /0\.0 m driven/);
      await server.kill();
    });
  }
});
