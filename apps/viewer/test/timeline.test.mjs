// Steps laid out in time: every pose of the plan is reached, in order, and parts keep their last pose.
import assert from 'node:assert/strict';
import test from 'node:test';
import {layOut, stepAt} from '../src/plan/timeline.js';
import {afterScrew, randomNumbers} from './cases.mjs';

/** Random steps in which each move begins where its part is. */
function randomPlan(r) {
  const count = r.integer(1, 6), names = Array.from({length: count}, (_, i) => `part ${i}`);
  const bodies = new Map(names.map((name, index) => [name, {index, name, center: r.vector(5), radius: r.between(0.1, 3)}]));
  const now = new Map(names.map(n => [n, [0, 0, 0, 1, 0, 0, 0]]));
  const steps = Array.from({length: r.integer(1, 8)}, (_, s) => {
    const movers = names.filter(() => r.next() < 0.4), poses = r.integer(2, 9);
    if (movers.length === 0) movers.push(names[r.integer(0, count - 1)]);
    return {step: s + 1, moves: movers.map(part => {
      const path = [now.get(part)];
      while (path.length < poses) path.push(r.next() < 0.15 ? path[path.length - 1] : afterScrew(path[path.length - 1], r.unit(), r.vector(3), r.between(-1, 1), r.between(0, 2)));
      now.set(part, path[poses - 1]);
      return {part, poses: path};
    })};
  });
  return {steps, bodies};
}

test('at the time of a pose the part is at that pose', () => {
  for (let seed = 1; seed <= 100; ++seed) {
    const {steps, bodies} = randomPlan(randomNumbers(seed)), line = layOut(steps, bodies, 10);
    assert.equal(line.steps.length, steps.length);
    for (const {step, times} of line.steps)
      for (const {part, poses} of step.moves)
        poses.forEach((pose, k) => {
          const seen = line.tracks[bodies.get(part).index].poseAt(times[k], new Float64Array(7));
          // Of several poses at the same time the last one counts.
          const last = poses.findLastIndex((_, j) => times[j] === times[k]);
          for (let n = 0; n < 7; ++n) assert.ok(Math.abs(seen[n] - poses[last][n]) < 1e-9, `seed ${seed}, step ${step.step}, pose ${k}`);
        });
  }
});

test('steps follow each other with pauses, times of a track strictly increase, and parts keep still in between', () => {
  for (let seed = 1; seed <= 100; ++seed) {
    const {steps, bodies} = randomPlan(randomNumbers(1000 + seed)), line = layOut(steps, bodies, 10);
    line.steps.forEach((s, i) => {
      assert.ok(s.end - s.begin >= 1 - 1e-9 && s.end - s.begin <= 3 + 1e-9);
      if (i > 0) assert.ok(s.begin > line.steps[i - 1].end);
      assert.equal(stepAt(line, (s.begin + s.end) / 2), i);
      for (const [name, {index}] of bodies) {
        if (!line.tracks[index]) continue;
        if (s.step.moves.some(m => m.part === name)) continue;
        const before = line.tracks[index].poseAt(s.begin, new Float64Array(7)), after = line.tracks[index].poseAt(s.end, new Float64Array(7));
        for (let n = 0; n < 7; ++n) assert.ok(Math.abs(before[n] - after[n]) < 1e-9);
      }
    });
    for (const track of line.tracks) for (let k = 1; track && k < track.times.length; ++k) assert.ok(track.times[k] > track.times[k - 1]);
    assert.ok(line.duration > line.steps[line.steps.length - 1].end);
    assert.equal(stepAt(line, 0), -1);
  }
});

test('time may jump: a track gives the same pose in whatever order it is asked', () => {
  const r = randomNumbers(77), {steps, bodies} = randomPlan(r), line = layOut(steps, bodies, 10), track = line.tracks.find(t => t);
  const times = Array.from({length: 200}, () => r.between(-1, line.duration + 1)), pose = t => Array.from(track.poseAt(t, new Float64Array(7)));
  const forward = new Map(times.slice().sort((a, b) => a - b).map(t => [t, pose(t)]));
  for (const t of times) assert.deepEqual(pose(t), forward.get(t));
});

test('no steps, no time', () => {
  assert.deepEqual(layOut([], new Map(), 10).steps, []);
  assert.equal(layOut([], new Map(), 10).duration, 0);
});
