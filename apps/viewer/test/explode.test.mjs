// Groups and the exploded view, on random orders of removal.
import assert from 'node:assert/strict';
import test from 'node:test';
import {explode} from '../src/plan/explode.js';
import {followGroups} from '../src/plan/groups.js';
import {randomNumbers} from './cases.mjs';

const IDENTITY = [0, 0, 0, 1, 0, 0, 0];

/** Random boxes, taken apart group by group in random directions until each is alone. */
function randomAssembly(r) {
  const names = Array.from({length: r.integer(2, 12)}, (_, i) => `p${i}`);
  const boxes = names.map(() => {
    const center = r.vector(5), half = [r.between(0.1, 3), r.between(0.1, 3), r.between(0.1, 3)];
    return {center, lo: center.map((x, k) => x - half[k]), hi: center.map((x, k) => x + half[k])};
  });
  const groups = [names.slice()], steps = [];
  for (;;) {
    const group = groups.find(g => g.length > 1);
    if (!group) break;
    const out = [];
    const count = r.integer(1, group.length - 1);
    while (out.length < count) out.push(...group.splice(r.integer(0, group.length - 1), 1));
    groups.push(out);
    const d = r.unit().map(x => 9 * x);
    steps.push({step: steps.length + 1, separates: [out], moves: out.map(part => ({part, poses: [IDENTITY, [...d, 1, 0, 0, 0]]}))});
  }
  return {names, boxes, steps};
}

test('every part but one leaves, in the order in which the steps separate them', () => {
  for (let seed = 1; seed <= 200; ++seed) {
    const {names, steps} = randomAssembly(randomNumbers(seed)), {rank, leftIn, leavers} = followGroups(steps, names);
    assert.equal(rank.filter(x => x < 0).length, 1);
    assert.equal(leavers, names.length - 1);
    assert.deepEqual(rank.filter(x => x >= 0).sort((a, b) => a - b), [...Array(leavers).keys()]);
    names.forEach((name, i) => {
      if (rank[i] < 0) return assert.equal(leftIn[i], -1);
      assert.ok(leftIn[i] >= steps.findIndex(s => s.separates[0].includes(name)));
      assert.equal(followGroups(steps.slice(0, leftIn[i] + 1), names).leftIn[i], leftIn[i]);
      assert.equal(followGroups(steps.slice(0, leftIn[i]), names).leftIn[i], -1);
    });
  }
});

test('exploded, no two boxes overlap', () => {
  for (let seed = 1; seed <= 200; ++seed) {
    const {names, boxes, steps} = randomAssembly(randomNumbers(seed)), {splits} = followGroups(steps, names);
    const by = explode(steps, splits, boxes, 10, [0, 0, 0]);
    for (let i = 0; i < names.length; ++i)
      for (let j = 0; j < i; ++j)
        assert.ok([0, 1, 2].some(k => boxes[i].lo[k] + by[i][k] >= boxes[j].hi[k] + by[j][k] - 1e-9 || boxes[j].lo[k] + by[j][k] >= boxes[i].hi[k] + by[i][k] - 1e-9),
          `seed ${seed}: ${names[i]} and ${names[j]}`);
  }
});

test('a part goes in the direction in which the plan takes it out; what stays together does not move', () => {
  const boxes = [0, 1, 2].map(i => ({center: [i, 0, 0], lo: [i - 0.5, -0.5, -0.5], hi: [i + 0.5, 0.5, 0.5]}));
  const steps = [{step: 1, separates: [['c']], moves: [{part: 'c', poses: [IDENTITY, [0, 5, 0, 1, 0, 0, 0]]}]}];
  const by = explode(steps, followGroups(steps, ['a', 'b', 'c']).splits, boxes, 3, [1, 0, 0]);
  assert.deepEqual(by.slice(0, 2), [[0, 0, 0], [0, 0, 0]]);
  assert.ok(by[2][1] > 0 && by[2][0] === 0 && by[2][2] === 0);
});
