// Colours differ from the red for problems, and numbers are readable.
import assert from 'node:assert/strict';
import test from 'node:test';
import {byOrder, given, hex} from '../src/plan/colours.js';
import {clock, listed, number, outcomeTitle, seconds, sentence, share, shareOfSize} from '../src/plan/words.js';
import {randomNumbers} from './cases.mjs';

const rgb = css => [1, 3, 5].map(i => parseInt(css.slice(i, i + 2), 16));

test('no colour of the order is near the red of what did not come out', () => {
  for (const count of [1, 2, 3, 10, 144, 200])
    for (let rank = 0; rank < count; ++rank) {
      const [r, g, b] = rgb(byOrder(rank, count));
      assert.ok(Math.hypot(r - 0xe5, g - 0x48, b - 0x4d) > 60, `${rank} of ${count}: ${byOrder(rank, count)}`);
    }
});

test('neighbours in the order differ', () => {
  for (const count of [2, 20, 200])
    for (let rank = 1; rank < count; ++rank) {
      const a = rgb(byOrder(rank - 1, count)), b = rgb(byOrder(rank, count));
      assert.ok(Math.hypot(...a.map((x, k) => x - b[k])) > 20);
    }
});

test('a part may bring its own colour, and nothing but a colour', () => {
  assert.equal(given({color: '#12AbEf'}), '#12abef');
  assert.equal(given({color: [1, 0, 0.5]}), '#ff0080');
  assert.equal(given({colour: [0, 0, 0, 1]}), hex([0, 0, 0]));
  for (const bad of ['red', '#12', 'url(x)', [1, 2], [NaN, 0, 0], null, {}, undefined]) assert.equal(given({color: bad}), null);
});

test('numbers', () => {
  assert.equal(number(0), '0');
  assert.equal(number(0.00012345), '0.000123');
  assert.equal(number(1234.5), '1235');
  assert.equal(seconds(0.0021), '2.1 ms');
  assert.equal(seconds(2.24), '2.2 s');
  assert.equal(clock(125.9), '2:05');
  assert.equal(listed(['a']), 'a');
  assert.equal(listed(['a', 'b']), 'a and b');
  assert.equal(listed(['a', 'b', 'c', 'd']), 'a, b and 2 more');
});

test('a share of the size is the same for a length in input units and in assembly units', () => {
  const r = randomNumbers(11);
  for (let n = 0; n < 100; ++n) {
    const size = 10 ** r.between(-4, 4), plan = {assembly: {scale: 10 / size, bbox: [[0, 0, 0], [size, size / 5, size / 3]]}};
    assert.equal(shareOfSize(0.026 * size, plan), '2.6 %');
    assert.equal(share(0.026 * 10, plan), '2.6 %');
  }
});

test('every outcome of a plan file has a title', () => {
  for (const outcome of ['timeout', 'depth_limit', 'exhausted', 'infeasible', 'invalid_start', 'cancelled', 'unsupported', 'crashed'])
    assert.notEqual(outcomeTitle(outcome), outcome);
  assert.equal(sentence('it stays'), 'It stays.');
});
