// Where the program, the sources and npm's packages are.
import { createRequire } from 'node:module';
import { join, resolve } from 'node:path';

export const packages = createRequire(join(resolve(process.env.LODESTAR_WEB_PACKAGES ?? '.'), 'package.json'));
export const source = resolve(process.env.LODESTAR_SOURCE_DIR ?? '../..');
export const binary = process.env.LODESTAR_BINARY ?? join(source, 'build/release/lodestar');
