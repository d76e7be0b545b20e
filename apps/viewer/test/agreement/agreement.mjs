// What the page shows is what plan.glb shows and what C++ computes, for random plans of the samples ($CASES, by write_cases.cpp).
import assert from 'node:assert/strict';
import {readdirSync, readFileSync} from 'node:fs';
import {join} from 'node:path';
import test from 'node:test';
import {readData} from '../../src/data.js';
import {Model} from '../../src/model.js';
import {multiply, screwInterpolate, transform} from '../../src/plan/screw.js';
import {distance, placed} from '../cases.mjs';
import {readGlb} from './glb.mjs';

const folder = process.env.CASES, read = (...path) => readFileSync(join(folder, ...path), 'utf8');
const cases = readdirSync(folder, {withFileTypes: true}).filter(e => e.isDirectory()).map(e => e.name);

/** Where a part stands in the page's scene when it is at `pose`, moved by `offset`: translation and rotation of its surface. */
function standing({parts, origin}, i, pose, offset = [0, 0, 0]) {
  const {place} = parts[i], out = new Float64Array(7);
  multiply(out, 3, pose, 3, place, 3);
  transform(out, pose, 0, place);
  return {at: Array.from(out.subarray(0, 3), (x, k) => x + offset[k] - origin[k]), turn: Array.from(out.subarray(3))};
}

/** Single precision, relative to where things are; the origin may be far away. */
const near = (a, b, size, why) => assert.ok(distance(a, b) < 2e-6 * size + 1e-7 * Math.hypot(...b), `${why}: ${a} and ${b}`);
const sameTurn = (q, p, why) => assert.ok(1 - Math.abs(q.reduce((sum, x, k) => sum + x * p[k], 0)) < 1e-6, why);

function forCases(title, law) {
  test(title, () => {
    assert.ok(cases.length > 50);
    for (const name of cases) law(new Model(readData(read(name, 'page.json'))), name);
  });
}

test('the screw motion is that of C++', () => {
  for (const {a, b, u, pose} of JSON.parse(read('screws.json'))) {
    const seen = screwInterpolate(new Float64Array(7), a, 0, b, 0, u);
    for (const p of [[0, 0, 0], [10, 0, 0], [0, 10, 0], [0, 0, 10]]) assert.ok(distance(placed(seen, p), placed(pose, p)) < 1e-8);
  }
});

forCases('between its poses a part is where C++ says', (model, name) => {
  for (const {mode, part, time, pose} of JSON.parse(read(name, 'poses.json'))) {
    const i = model.index.get(part), seen = model.poseOf(i, mode, time, new Float64Array(7)), {lo, hi} = model.parts[i];
    for (const p of [lo, hi]) assert.ok(distance(placed(seen, p), placed(pose, p)) < 1e-9 * (model.size + Math.hypot(...p)), `${name}, ${part} at ${time}`);
  }
});

forCases('at every key of plan.glb the page shows the part where the file has it, at the same time', (model, name) => {
  const glb = readGlb(readFileSync(join(folder, name, 'plan.glb'))), {size} = model;
  for (const mode of ['disassembly', 'assembly']) {
    const line = model.lines[mode], animation = glb.animations.get(mode);
    if (line.steps.length === 0) {
      assert.equal(animation, undefined);
      continue;
    }
    const told = line.steps.map(s => ({step: s.step.step, begin: s.begin, end: s.end, parts: s.parts.map(i => model.parts[i].name)}));
    assert.deepEqual(animation.steps.map(s => ({...s, begin: Math.fround(s.begin), end: Math.fround(s.end)})), told);
    model.parts.forEach(({name: part}, i) => {
      const track = line.tracks[i], keys = animation.keys.get(part);
      assert.equal(track === null, keys === undefined, `${name}: ${part} moves in both or in none`);
      if (!keys) return;
      assert.deepEqual(keys.map(k => k.time), [...track.times, line.duration]);
      for (const {time, at, turn} of keys) {
        const seen = standing(model, i, model.poseOf(i, mode, time, new Float64Array(7)));
        near(at, seen.at, size, `${name}, ${mode}, ${part} at ${time}`);
        sameTurn(turn, seen.turn, `${name}, ${mode}, ${part} at ${time}`);
      }
    });
  }
});

forCases('the exploded view is that of exploded.glb', (model, name) => {
  const {nodes} = readGlb(readFileSync(join(folder, name, 'exploded.glb')));
  model.parts.forEach(({name: part}, i) =>
    near(nodes.get(part).at, standing(model, i, [0, 0, 0, 1, 0, 0, 0], model.offsets[i]).at, model.size, `${name}, ${part}`));
});

forCases('a part vanishes when the step that takes it out is over, and only then', (model, name) => {
  const {plan, lines: {disassembly, assembly}} = model;
  model.parts.forEach(({name: part}, i) => {
    const step = model.outIn(i), seen = (mode, time) => model.presence(i, mode, time, true);
    const shown = step && disassembly.steps.filter(s => s.step.step <= step.step).pop();
    if (!step) assert.equal(seen('disassembly', 1e6), 1);
    else assert.deepEqual([seen('disassembly', shown.end), seen('disassembly', shown.end + 0.3) < 1e-5], [1, true], `${name}, ${part}`);
    if (plan.remaining.includes(part)) assert.equal(step, null);
    const first = assembly.steps.find(s => s.parts.includes(i));
    if (first && !first.step.transfer) assert.deepEqual([seen('assembly', first.begin), seen('assembly', first.begin - 0.301)], [1, 0]);
    else assert.equal(seen('assembly', -1e6), 1);
  });
});

forCases('every part that did not come out stands in one reason, with advice', (model, name) => {
  const {plan, view} = model, told = view.reasons.flatMap(r => r.parts.map(p => plan.assembly.parts[p.part].name));
  assert.deepEqual(told.slice().sort(), plan.unsolved.map(u => u.part).sort(), name);
  for (const {meaning, advice} of view.reasons) assert.ok(meaning.length > 10 && advice.every(text => text.split('`').length % 2 === 1));
});
