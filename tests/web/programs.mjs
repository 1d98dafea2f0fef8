// Where the program, the sources and npm's packages are; and a served copy of the lab.
import { spawn } from 'node:child_process';
import { cpSync, mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { createRequire } from 'node:module';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';

export const packages = createRequire(join(resolve(process.env.LODESTAR_WEB_PACKAGES ?? '.'), 'package.json'));
export const source = resolve(process.env.LODESTAR_SOURCE_DIR ?? '../..');
export const binary = process.env.LODESTAR_BINARY ?? join(source, 'build/release/lodestar');

/** A console over a copy of the lab, on a port of its own. */
export const serve = (...options) => start((site, folder) => ['serve', site, '--runs', join(folder, 'runs'), ...options]);

/** The same with a simulated robot that has nothing to do at first but to drive half a metre ahead. */
export const serveRobot = (...options) => start((site, folder) =>
  ['replay', site, '--serve', '--goal', '1.7,5.6', '-o', join(folder, 'runs', 'run'),
    '--lease', '3', ...options], 'ignore');  // a page may take its time where the machine is busy

async function start(command, words = 'inherit') {
  const folder = mkdtempSync(join(tmpdir(), 'lodestar-web-'));
  const site = join(folder, 'site');
  cpSync(join(source, 'sites/lab'), site, { recursive: true });
  const server = spawn(binary, [...command(site, folder), '--port', '0'], { stdio: ['ignore', 'pipe', words] });
  const url = await new Promise((found, failed) => {
    server.stdout.on('data', (bytes) => found(String(bytes).trim()));
    server.on('exit', (code) => failed(new Error(`lodestar ended with ${code}`)));
  });
  const stop = () => {
    server.kill('SIGTERM');
    rmSync(folder, { recursive: true, force: true, maxRetries: 50, retryDelay: 100 });  // it may still write its run
  };
  return { url, site, runs: join(folder, 'runs'), stop, markersFile: () => readFileSync(join(site, 'markers.yaml'), 'utf8') };
}
