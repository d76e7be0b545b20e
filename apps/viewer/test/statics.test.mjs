// Falling motions: those of rigid bodies, beginning along v + w x (p - center); notes of any form are read without an error.
import assert from 'node:assert/strict';
import test from 'node:test';
import {fallen, pictureOf} from '../src/plan/statics.js';
import {cross, distance, placed, randomNumbers} from './cases.mjs';

test('a small share moves points along the motion; any share keeps their distances', () => {
  const {vector, pose} = randomNumbers(5), sum = (a, b, f = 1) => a.map((x, k) => x + f * b[k]);
  for (let round = 0; round < 50; ++round) {
    const motion = {center: vector(1), v: vector(1), w: vector(0.5)}, from = pose(1);
    const at = (share, p) => placed(fallen(Float64Array.from(from), motion, share), p);
    const p = vector(1), q = vector(1), before = at(0, p), h = 1e-5;
    const speed = sum(motion.v, cross(motion.w, sum(before, motion.center, -1)));
    assert.ok(distance(sum(before, speed, h), at(h, p)) < 1e-8);
    assert.ok(Math.abs(distance(at(0.7, p), at(0.7, q)) - distance(p, q)) < 1e-12);
  }
});

test('pictures of notes: what has another form is left out', () => {
  const index = new Map([['a', 0], ['b', 1]]), of = data => pictureOf([{notes: [{text: 'Hold it.', data}]}], index);
  assert.equal(pictureOf([undefined, {}, {notes: [{text: 'x'}]}], index), null);
  for (const data of [null, 'text', {}, {picture: {}}, {picture: {falls: [{parts: 'a'}], arrows: [{kind: 'weight', at: [0, 0], force: [0, 0, 1]}, {kind: 'other', at: [0, 0, 0], force: [0, 0, 1]}]}}])
    assert.equal(of(data), null);
  const fall = {parts: ['b', 'gone'], center: [0, 0, 0], v: [0, 0, -1], w: [0, 0, 0]}, arrow = {kind: 'hold', part: 'b', at: [0, 0, 0], force: [0, 0, 2]};
  assert.deepEqual(of({picture: {when: 'during', falls: [fall], arrows: [arrow]}}), {when: 'during', text: 'Hold it.', falls: [{...fall, parts: [1]}], arrows: [arrow]});
});
