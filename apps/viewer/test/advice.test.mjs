// Advice matches the outcome, and its commands work for unusual file names.
import assert from 'node:assert/strict';
import {spawnSync} from 'node:child_process';
import test from 'node:test';
import {adviceOn, quoted} from '../src/plan/advice.js';
import {outcomeMeaning, outcomeTitle} from '../src/plan/words.js';

const OUTCOMES = ['timeout', 'depth_limit', 'exhausted', 'infeasible', 'invalid_start', 'cancelled', 'unsupported', 'crashed'];
const planOf = (source, overlaps = []) => ({assembly: {source, overlaps}, verified_max_penetration: 0.01});
const unsolved = (outcome, message = '') => ({part: 'a b', outcome, message, blocked_by: ['c']});

test('every outcome of a plan file has a title, a meaning and something to do', () => {
  for (const outcome of OUTCOMES) {
    assert.notEqual(outcomeTitle(outcome), outcome);
    assert.ok(outcomeMeaning(outcome).length > 10);
    const advice = adviceOn([unsolved(outcome)], planOf('x'));
    assert.ok(advice.length > 0, outcome);
    for (const text of advice) assert.equal(text.split('`').length % 2, 1, `backquotes come in pairs: ${text}`);
  }
});

test('more time is no advice for what is proved', () => {
  assert.doesNotMatch(adviceOn([unsolved('infeasible')], planOf('x')).join(' '), /--path-timeout|--timeout/);
  assert.match(adviceOn([unsolved('timeout')], planOf('x')).join(' '), /--path-timeout/);
  assert.match(adviceOn([unsolved('timeout', 'the time of the whole run was used up')], planOf('x'))[0], /--timeout/);
});

test('overlaps are spoken of when they are with what blocks', () => {
  const text = overlaps => adviceOn([unsolved('exhausted')], planOf('x', overlaps)).join(' ');
  assert.doesNotMatch(text([]), /dismantle check/);
  assert.doesNotMatch(text([{a: 'a b', b: 'far', depth: 1}]), /dismantle check/);
  assert.match(text([{a: 'c', b: 'a b', depth: 1}]), /dismantle check x/);
});

test('a shell reads quoted names as they are', () => {
  for (const name of ['plain', 'with space', "it's", '$(rm -rf x)', '`x`', 'a"b', 'é;|&', '-x'])
    assert.equal(spawnSync('sh', ['-c', `printf %s ${quoted(name)}`], {encoding: 'utf8'}).stdout, name);
});
