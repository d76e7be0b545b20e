// The poses of a plan at the times of the page: each is reached, parts keep their last one, and time may jump.
import assert from 'node:assert/strict';
import test from 'node:test';
import {readAnimation, stepAt, timeOfPose} from '../src/plan/animation.js';
import {afterScrew, randomNumbers} from './cases.mjs';

/** Random steps in which each move begins where its part is, and times for their poses. */
function randomSteps(r) {
  const names = Array.from({length: r.integer(1, 6)}, (_, i) => `part ${i}`), times = [], numbers = [];
  const index = new Map(names.map((name, i) => [name, i])), now = new Map(names.map(n => [n, [0, 0, 0, 1, 0, 0, 0]]));
  let time = 0;
  const steps = Array.from({length: r.integer(1, 8)}, (_, s) => {
    const movers = r.next() < 0.1 ? [] : names.filter(() => r.next() < 0.5), count = r.integer(2, 9);
    time += 1;
    for (let k = 0, number = 0; k < count && movers.length > 0; ++k, number += r.integer(1, 4)) {
      times.push(time += r.between(0.1, 1));
      numbers.push(number);
    }
    return {step: s + 1, moves: movers.map(part => {
      const poses = [now.get(part)];
      while (poses.length < count) poses.push(afterScrew(poses[poses.length - 1], r.unit(), r.vector(3), r.between(-1, 1), r.between(0, 2)));
      now.set(part, poses[count - 1]);
      return {part, poses};
    })};
  });
  return {steps, index, animation: {duration: time + 1, times: Float32Array.from(times), poses: Uint32Array.from(numbers)}};
}

test('at the time of a pose the part is at that pose, and keeps it until it moves again', () => {
  for (let seed = 1; seed <= 100; ++seed) {
    const {steps, index, animation} = randomSteps(randomNumbers(seed)), line = readAnimation(steps, animation, index);
    const poseAt = (part, time) => Array.from(line.tracks[index.get(part)].poseAt(time, new Float64Array(7)));
    assert.deepEqual(line.steps.map(s => s.step), steps.filter(s => s.moves.length > 0));
    line.steps.forEach(({step, begin, end, times}, i) => {
      assert.equal(stepAt(line, (begin + end) / 2), i);
      for (const {part, poses} of step.moves) poses.forEach((pose, k) => assert.deepEqual(poseAt(part, times[k]), pose));
      for (const [part, p] of index)
        if (line.tracks[p] && !step.moves.some(m => m.part === part))
          poseAt(part, begin).forEach((x, n) => assert.ok(Math.abs(x - poseAt(part, end)[n]) < 1e-12));
    });
    assert.equal(stepAt(line, 0), -1);
  }
});

test('time may jump: a track gives the same pose in whatever order it is asked', () => {
  const r = randomNumbers(77), {steps, index, animation} = randomSteps(r), line = readAnimation(steps, animation, index);
  const track = line.tracks.find(t => t), pose = t => Array.from(track.poseAt(t, new Float64Array(7)));
  const times = Array.from({length: 200}, () => r.between(-1, line.duration + 1));
  const forward = new Map(times.slice().sort((a, b) => a - b).map(t => [t, pose(t)]));
  for (const t of times) assert.deepEqual(pose(t), forward.get(t));
});

test('poses that the page leaves out are equally far apart in time between those that it has', () => {
  for (let seed = 1; seed <= 50; ++seed) {
    const {steps, index, animation} = randomSteps(randomNumbers(seed)), line = readAnimation(steps, animation, index);
    for (const step of line.steps) {
      step.numbers.forEach((number, i) => assert.equal(timeOfPose(step, number), step.times[i]));
      for (let i = 0; i + 1 < step.numbers.length; ++i) {
        const from = step.numbers[i], to = step.numbers[i + 1], apart = (step.times[i + 1] - step.times[i]) / (to - from);
        for (let k = from; k < to; ++k) assert.ok(Math.abs(timeOfPose(step, k) - step.times[i] - apart * (k - from)) < 1e-9);
      }
    }
  }
});

test('no steps, no time; times of another plan are refused', () => {
  const line = readAnimation([], {duration: 0, times: new Float32Array(0), poses: new Uint32Array(0)}, new Map());
  assert.deepEqual([line.steps, line.tracks], [[], []]);
  assert.throws(() => readAnimation([], {duration: 1, times: new Float32Array(3), poses: new Uint32Array(3)}, new Map()), /not those of its plan/);
});
