// Bundles the page with esbuild and writes its files as one C++ source: embed.mjs PACKAGES OUTPUT.cpp
import { createRequire } from 'node:module';
import { readFileSync, writeFileSync } from 'node:fs';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';

const [packages, output] = process.argv.slice(2);
const source = dirname(fileURLToPath(import.meta.url));
const { buildSync } = createRequire(join(resolve(packages), 'package.json'))('esbuild');

const bundleOf = (entry) => buildSync({
  entryPoints: [join(source, entry)], bundle: true, minify: true, format: 'esm', target: 'es2022',
  legalComments: 'none', write: false, nodePaths: [join(resolve(packages), 'node_modules')],
}).outputFiles[0].text;

const plotStyle = readFileSync(join(resolve(packages), 'node_modules/uplot/dist/uPlot.min.css'), 'utf8');
const files = [
  ['/', 'text/html; charset=utf-8', readFileSync(join(source, 'index.html'), 'utf8')],
  ['/app.js', 'text/javascript; charset=utf-8', bundleOf('main.ts')],
  ['/coverage_worker.js', 'text/javascript; charset=utf-8', bundleOf('coverage_worker.ts')],
  ['/style.css', 'text/css; charset=utf-8', plotStyle + readFileSync(join(source, 'style.css'), 'utf8')],
];

/** A string literal in pieces: compilers limit a piece to 64 KiB. */
function literal(text) {
  const pieces = [];
  const bytes = Buffer.from(text, 'utf8');
  for (let at = 0; at < bytes.length; at += 8000) pieces.push(bytes.subarray(at, at + 8000));
  return pieces.map((piece) => '"' + [...piece].map(escaped).join('') + '"').join('\n    ');
}

/** Octal escapes of three digits, so that a following digit is not read as part of one. */
function escaped(byte) {
  const plain = byte >= 0x20 && byte < 0x7f && byte !== 0x22 && byte !== 0x5c && byte !== 0x3f;
  return plain ? String.fromCharCode(byte) : '\\' + byte.toString(8).padStart(3, '0');
}

const entries = files.map(([target, type, text]) =>
  `      {"${target}", "${type}", std::string_view(\n    ${literal(text)}, ${Buffer.byteLength(text)})}`);
writeFileSync(output, `#include "app/web/page.hpp"

namespace lodestar {

const std::vector<PageFile>& page_files() {
  static const std::vector<PageFile> files{
${entries.join(',\n')}};
  return files;
}

}  // namespace lodestar
`);
