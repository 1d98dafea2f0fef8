// Where the program, the sources and npm's packages are; and a served copy of the lab.
import { spawn } from 'node:child_process';
import { cpSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';

export const packages = createRequire(join(resolve(process.env.LODESTAR_WEB_PACKAGES ?? '.'), 'package.json'));
export const source = resolve(process.env.LODESTAR_SOURCE_DIR ?? '../..');
export const binary = process.env.LODESTAR_BINARY ?? join(source, 'build/release/lodestar');

/** A copy of the lab in a folder of its own. */
export function labCopy() {
  const folder = mkdtempSync(join(tmpdir(), 'lodestar-web-'));
  const site = join(folder, 'site');
  cpSync(join(source, 'sites/lab'), site, { recursive: true });
  return { folder, site };
}

/** Gives the robot of a copy an outline of 0.7 m by 0.3 m. */
export function withOutline(place) {
  const file = join(place.site, 'robot.yaml');
  writeFileSync(file, readFileSync(file, 'utf8').replace(/^radius_m:.*$/m, '$&\nfootprint_m: [[-0.3, -0.15], [0.4, -0.15], [0.4, 0.15], [-0.3, 0.15]]'));
  return place;
}

/** A console over a copy of the lab, on a port of its own. */
export const serve = (...options) => serveSite(labCopy(), ...options);
export const serveSite = (place, ...options) => start(place, ['serve', place.site, '--runs', join(place.folder, 'runs'), ...options]);

/** The same with a simulated robot that has nothing to do at first but to drive half a metre ahead. */
export const serveRobot = (...options) => serveRobotAt(labCopy(), ...options);
export const serveRobotAt = (place, ...options) => start(place,
  ['replay', place.site, '--serve', '--goal', '1.7,5.6', '-o', join(place.folder, 'runs', 'run'),
    '--lease', '3', ...options], 'ignore');  // a page may take its time where the machine is busy

async function start({ folder, site }, command, words = 'inherit') {
  const server = spawn(binary, command.includes('--port') ? command : [...command, '--port', '0'], { stdio: ['ignore', 'pipe', words] });
  const ended = new Promise((done) => server.on('exit', done));
  const url = await new Promise((found, failed) => {
    server.stdout.on('data', (bytes) => found(String(bytes).trim()));
    server.on('exit', (code) => failed(new Error(`lodestar ended with ${code}`)));
  });
  // A test that fails does not stop its server: that must not keep this process waiting, nor outlive it.
  server.unref();
  server.stdout.unref();
  process.once('exit', () => server.kill('SIGTERM'));
  const end = () => { server.ref(); server.kill('SIGTERM'); return ended; };
  const stop = async () => {
    await end();  // until then it may write its run
    rmSync(folder, { recursive: true, force: true });
  };
  return { url, site, runs: join(folder, 'runs'), end, stop, markersFile: () => readFileSync(join(site, 'markers.yaml'), 'utf8') };
}
