// Plans for the tests, made by the program under test, $DISMANTLE.
import {spawnSync} from 'node:child_process';
import {mkdirSync, readFileSync, writeFileSync} from 'node:fs';
import {dirname, join} from 'node:path';

export function run(folder, statuses, ...args) {
  const done = spawnSync(process.env.DISMANTLE, args, {cwd: folder, encoding: 'utf8'});
  if (!statuses.includes(done.status)) throw new Error(`dismantle ${args.join(' ')}: status ${done.status}\n${done.stdout}${done.stderr}`);
  return done.stdout;
}

function result(folder, name) {
  return {file: join(folder, name, 'index.html'), plan: JSON.parse(readFileSync(join(folder, name, 'plan.json'), 'utf8'))};
}

/** The page and the plan of a sample. */
export function planSample(folder, sample, ...options) {
  run(folder, [0], 'sample', sample, '-o', `${sample}.parts`, ...options);
  run(folder, [0, 1], 'plan', `${sample}.parts`, '-o', sample, '--threads', '1', '-q', '--set', 'run.force=off');
  return result(folder, sample);
}

/** A box as OBJ. */
export function box(lo, hi) {
  let text = '';
  for (let i = 0; i < 8; ++i) text += `v ${[0, 1, 2].map(k => (i >> k & 1 ? hi : lo)[k]).join(' ')}\n`;
  for (const quad of [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]) text += `f ${quad.map(i => i + 1).join(' ')}\n`;
  return text;
}

/** A stack of boxes, one per name; `widths`: of each, all different if not said. */
export function planBoxes(folder, name, names, widths = names.map((_, i) => 20 - i)) {
  mkdirSync(join(folder, `${name}.parts`));
  names.forEach((part, i) => writeFileSync(join(folder, `${name}.parts`, `${part}.obj`), box([0, 0, 11 * i], [widths[i], 20, 11 * i + 10])));
  run(folder, [0, 1], 'plan', `${name}.parts`, '-o', name, '--threads', '1', '-q', '--set', 'run.force=off');
  return result(folder, name);
}

/** The page of the same plan with `change` made to it, for plans that the current planners do not write. */
export function changedPlan(folder, sample, name, change) {
  const {plan} = result(folder, sample);
  change(plan);
  mkdirSync(join(folder, name));
  writeFileSync(join(folder, name, 'plan.json'), JSON.stringify(plan));
  run(folder, [0], 'view', join(name, 'plan.json'), '--assembly', `${sample}.parts`, '-q');
  return result(folder, name).file;
}

/** What `dismantle explain` says of a sample's plan. */
export const explained = (folder, sample) =>
  JSON.parse(run(folder, [0], 'explain', join(sample, 'plan.json'), '--format', 'json').trim().split('\n').pop());

/** The same page with its data changed by `change`. */
export function changed(file, name, change) {
  const html = readFileSync(file, 'utf8'), open = 'id="dismantle-data">';
  const begin = html.indexOf(open) + open.length, end = html.indexOf('</script>', begin);
  const data = JSON.parse(html.slice(begin, end));
  change(data);
  const out = join(dirname(file), name);
  writeFileSync(out, html.slice(0, begin) + JSON.stringify(data).replaceAll('<', '\\u003c') + html.slice(end));
  return out;
}
