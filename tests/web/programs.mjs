// Where the program, the sources and npm's packages are; and a served copy of the lab.
import { spawn } from 'node:child_process';
import { cpSync, mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { createRequire } from 'node:module';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';

export const packages = createRequire(join(resolve(process.env.LODESTAR_WEB_PACKAGES ?? '.'), 'package.json'));
export const source = resolve(process.env.LODESTAR_SOURCE_DIR ?? '../..');
export const binary = process.env.LODESTAR_BINARY ?? join(source, 'build/release/lodestar');

/** A server over a copy of the lab, on a port of its own. */
export async function serve(...options) {
  const folder = mkdtempSync(join(tmpdir(), 'lodestar-web-'));
  const site = join(folder, 'site');
  cpSync(join(source, 'sites/lab'), site, { recursive: true });
  const server = spawn(binary, ['serve', site, '--port', '0', '--runs', join(folder, 'runs'), ...options], { stdio: ['ignore', 'pipe', 'inherit'] });
  const url = await new Promise((found, failed) => {
    server.stdout.on('data', (bytes) => found(String(bytes).trim()));
    server.on('exit', (code) => failed(new Error(`lodestar serve ended with ${code}`)));
  });
  const stop = () => {
    server.kill('SIGTERM');
    rmSync(folder, { recursive: true, force: true });
  };
  return { url, site, runs: join(folder, 'runs'), stop, markersFile: () => readFileSync(join(site, 'markers.yaml'), 'utf8') };
}
