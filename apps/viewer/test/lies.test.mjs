// How the assembly lies: steps say it, between them it turns, and it always stands on the same ground.
import assert from 'node:assert/strict';
import test from 'node:test';
import {Lies, partly, slerp} from '../src/plan/lies.js';
import {dot, placed, randomNumbers} from './cases.mjs';

const UP = [0, 0, 1];

/** Steps of a second each with pauses of a second, some with a transfer, and how the assembly lies in each. */
function randomCase(seed) {
  const r = randomNumbers(seed), n = r.integer(1, 6), said = [], corners = Array.from({length: 12}, () => r.vector(10));
  const steps = Array.from({length: n}, (_, k) => {
    said.push(r.next() < 0.3 ? {} : {lies: r.turn(r.unit(), r.between(0, Math.PI))});
    const begin = 1 + 2 * k, transfer = r.next() < 0.5 ? 2 : 0;
    return {step: {transfer}, index: k, begin, end: begin + 1, times: [0, 0.2, 0.5, 1].map(t => begin + t), parts: [k]};
  });
  return {r, steps, said, corners, lies: new Lies({steps}, said, corners)};
}

const same = (q, p) => Math.abs(q.reduce((sum, x, k) => sum + x * p[k], 0)) > 1 - 1e-9;
const stepAt = (steps, time) => steps.filter(s => s.begin <= time).length - 1;

test('during a step the assembly lies as the step says', () => {
  for (let seed = 1; seed <= 100; ++seed) {
    const {steps, said, lies} = randomCase(seed);
    for (const [k, {begin, end}] of steps.entries())
      for (const time of [begin, (begin + end) / 2, end]) {
        const pose = lies.at(new Float64Array(7), time, stepAt(steps, time), UP);
        assert.ok(same([...pose.subarray(3)], said[k].lies ?? [1, 0, 0, 0]));
        lies.during(new Float64Array(7), k, UP).forEach((x, n) => assert.ok(Math.abs(x - pose[n]) < 1e-12));
      }
    assert.equal(lies.any, said.some(s => s.lies));
  }
});

test('at every time its lowest corner is where it is as drawn', () => {
  for (let seed = 1; seed <= 100; ++seed) {
    const {r, steps, corners, lies} = randomCase(seed), low = points => Math.min(...points.map(p => dot(p, UP)));
    for (let k = 0; k < 20; ++k) {
      const time = r.between(0, 2 * steps.length + 2), pose = lies.at(new Float64Array(7), time, stepAt(steps, time), UP);
      assert.ok(Math.abs(low(corners.map(c => placed(pose, c))) - low(corners)) < 1e-9);
    }
  }
});

test('it turns smoothly', () => {
  for (let seed = 1; seed <= 100; ++seed) {
    const {steps, lies} = randomCase(seed);
    let before = null;
    for (let time = 0; time < 2 * steps.length + 2; time += 0.005) {
      const turn = [...lies.at(new Float64Array(7), time, stepAt(steps, time), UP).subarray(3)];
      // At most 1.5 half turns per second.
      if (before) assert.ok(Math.abs(turn.reduce((sum, x, k) => sum + x * before[k], 0)) > Math.cos(0.5 * 1.51 * Math.PI * 0.005));
      before = turn;
    }
  }
});

test('a part waits in the layout as drawn, and lies as the assembly when its own path begins', () => {
  for (let seed = 1; seed <= 50; ++seed) {
    const {steps, lies} = randomCase(seed);
    steps.forEach(({step, begin, times}, k) => {
      assert.equal(lies.share(k, begin - 0.5), step.transfer ? 0 : 1);
      assert.equal(lies.share(k, times[step.transfer]), 1);
      assert.equal(lies.share(k, begin + 5), 1);
    });
    assert.equal(lies.share(99, 0), 1, 'what never moves is the assembly');
  }
});

test('a share of a pose: nothing, or all of it', () => {
  const r = randomNumbers(3);
  for (let k = 0; k < 100; ++k) {
    const pose = r.pose(5), other = r.pose(1).slice(3);
    assert.deepEqual([...partly(new Float64Array(7), pose, 0)].map(x => x + 0), [0, 0, 0, 1, 0, 0, 0]);
    const all = [...partly(new Float64Array(7), pose, 1)];
    assert.ok(same(all.slice(3), pose.slice(3)));
    assert.deepEqual(all.slice(0, 3), pose.slice(0, 3));
    assert.ok(same([...slerp(new Float64Array(4), pose.slice(3), other, 1)], other));
  }
});
