// Compares the constant screw motion between two poses with the closed form, on random screws.
import assert from 'node:assert/strict';
import test from 'node:test';
import {screwInterpolate, transform} from '../src/plan/screw.js';
import {afterScrew, distance, placed, randomNumbers, screwed} from './cases.mjs';

const at = (a, b, u) => Array.from(screwInterpolate(new Float64Array(7), a, 0, b, 0, u));

test('transform() does what the rotation matrix does', () => {
  const r = randomNumbers(1);
  for (let n = 0; n < 500; ++n) {
    const pose = r.pose(10), p = r.vector(10);
    assert.ok(distance(transform([0, 0, 0], pose, 0, p), placed(pose, p)) < 1e-12);
  }
});

test('every point follows the screw, whatever its axis, angle and pitch', () => {
  const r = randomNumbers(2);
  for (let n = 0; n < 2000; ++n) {
    const start = r.pose(20), axis = r.unit(), through = r.vector(20), along = r.between(-10, 10);
    // Small angles too, where the closed forms cancel.
    const angle = n % 4 === 0 ? 10 ** r.between(-12, -1) : r.between(-3.1, 3.1);
    const end = afterScrew(start, axis, through, angle, along), u = r.next(), p = r.vector(20);
    const expected = screwed(placed(start, p), axis, through, u * angle, u * along);
    const seen = placed(at(start, end, u), p);
    assert.ok(distance(seen, expected) < 1e-8, `case ${n}: off by ${distance(seen, expected)}`);
  }
});

test('the ends are the poses themselves, and q and -q are the same turn', () => {
  const r = randomNumbers(3);
  for (let n = 0; n < 300; ++n) {
    const a = r.pose(5), b = r.pose(5), u = r.next(), other = [...b.slice(0, 3), ...b.slice(3).map(x => -x)];
    assert.deepEqual(at(a, b, 0), a);
    assert.deepEqual(at(a, b, 1), b);
    const p = r.vector(5);
    assert.ok(distance(placed(at(a, b, u), p), placed(at(a, other, u), p)) < 1e-10);
  }
});

test('a motion cut in two is the same motion', () => {
  const r = randomNumbers(4);
  for (let n = 0; n < 500; ++n) {
    const a = r.pose(5), b = afterScrew(a, r.unit(), r.vector(5), r.between(-3, 3), r.between(-5, 5)), cut = r.between(0.05, 0.95), u = r.next(), p = r.vector(5);
    assert.ok(distance(placed(at(a, at(a, b, cut), u), p), placed(at(a, b, cut * u), p)) < 1e-9);
  }
});

test('poses in one array are read where they stand', () => {
  const r = randomNumbers(5), poses = [r.pose(3), r.pose(3), r.pose(3)], flat = Float64Array.from(poses.flat());
  for (const u of [0, 0.3, 1]) assert.deepEqual(Array.from(screwInterpolate(new Float64Array(7), flat, 7, flat, 14, u)), at(poses[1], poses[2], u));
});
