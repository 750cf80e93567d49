// Bundles src/ with the parts of three.js that it uses into one script, and copies the licence of three.js beside it.
import { build } from 'esbuild';
import { createHash } from 'node:crypto';
import { copyFile, readFile, readdir, stat } from 'node:fs/promises';

const { version } = JSON.parse(await readFile('node_modules/three/package.json', 'utf8'));
const digest = createHash('sha256');
for (const name of (await readdir('src')).sort()) digest.update(await readFile(`src/${name}`));
const out = '../assets/viewer.js';
await build({
  entryPoints: ['src/main.js'],
  bundle: true,
  minify: true,
  format: 'iife',
  target: 'es2020',
  charset: 'ascii',
  legalComments: 'none',
  banner: { js: `/* tiskel viewer; holds parts of three.js ${version}, MIT licence, see LICENSE.three.txt; sources ${digest.digest('hex').slice(0, 16)} */` },
  outfile: out,
});
await copyFile('node_modules/three/LICENSE', '../assets/LICENSE.three.txt');
console.log(`${out}: ${(await stat(out)).size} bytes, three.js ${version}`);
