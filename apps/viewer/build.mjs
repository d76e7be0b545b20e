// node build.mjs MODULES PAGE: bundles src/ into PAGE, a self-contained file. MODULES: the folder with node_modules.
import {mkdirSync, readFileSync, renameSync, writeFileSync} from 'node:fs';
import {createRequire} from 'node:module';
import {dirname, join, resolve} from 'node:path';
import {fileURLToPath} from 'node:url';

const [modules, page] = process.argv.slice(2).map(p => resolve(p));
const src = join(dirname(fileURLToPath(import.meta.url)), 'src');
const esbuild = createRequire(join(modules, 'package.json'))('esbuild');

const {outputFiles} = await esbuild.build({
  entryPoints: {page: join(src, 'main.js'), style: join(src, 'style.css')},
  outdir: dirname(page),
  bundle: true,
  write: false,
  minify: true,
  format: 'iife',
  target: 'es2021',
  charset: 'utf8',
  legalComments: 'inline',
  nodePaths: [join(modules, 'node_modules')],
  logLevel: 'warning',
});
const text = ending => outputFiles.find(f => f.path.endsWith(ending)).text.trim();

/** Replaces `mark`, which must occur exactly once, by `value`. `$` patterns have no effect. */
function fill(html, mark, value) {
  const pieces = html.split(mark);
  if (pieces.length !== 2) throw new Error(`${mark} is there ${pieces.length - 1} times, not once`);
  return pieces.join(value);
}

let html = readFileSync(join(src, 'page.html'), 'utf8');
html = fill(html, '/*STYLE*/', text('.css'));
html = fill(html, '/*SCRIPT*/', text('.js'));
if (html.split('@DISMANTLE_DATA@').length !== 2) throw new Error('there must be exactly one place for the data');
mkdirSync(dirname(page), {recursive: true});
writeFileSync(page + '.new', html);
renameSync(page + '.new', page);
