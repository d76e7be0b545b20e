// Verdicts of step checks: every cost, refusal and note has a row, and both directions show the same step's.
import assert from 'node:assert/strict';
import test from 'node:test';
import {objectiveText, verdictRows, verdictsOf} from '../src/plan/checks.js';

const hold = {type: 'acme.hold', weight: 2, cost: 0.5, allowed: false, reason: 'it falls over', notes: [{kind: 'hold', text: 'Hold <b>it</b>.', data: {force: 1}}]};
const turn = {type: 'directions', weight: 1, cost: 1, allowed: true, reason: 'the direction differs'};
const plan = {
  objective: {up: [0, 0, 1], cost: 2, checks: [{type: 'acme.hold', weight: 2, cost: 0.5}, {type: 'directions', weight: 1, cost: 1}]},
  disassembly: [{step: 1, checks: [hold]}, {step: 2, checks: [turn]}, {step: 3}],
  assembly_steps: [{step: 1}, {step: 2}, {step: 3}],
};

test('each cost, refusal and note has a row', () => {
  assert.deepEqual(verdictRows([hold, turn]), [['not allowed', 'acme.hold: it falls over'], ['note', 'Hold <b>it</b>.'],
    ['cost', '1, directions: the direction differs']]);
  assert.deepEqual(verdictRows([{type: 'a', cost: 0, allowed: true}]), []);
  assert.deepEqual(verdictRows([{type: 'a', cost: 0, allowed: true, failed: 'no reason'}]), [['not judged', 'a: no reason']]);
});

test('a step of the assembly has the verdicts of the step that it reverses', () => {
  assert.deepEqual(verdictsOf(plan, plan.disassembly[0], 'disassembly'), [hold]);
  assert.deepEqual(verdictsOf(plan, plan.assembly_steps[2], 'assembly'), [hold]);
  assert.deepEqual(verdictsOf(plan, plan.assembly_steps[1], 'assembly'), [turn]);
  assert.deepEqual(verdictsOf(plan, plan.assembly_steps[0], 'assembly'), []);
});

test('the sum, if there is an objective', () => {
  assert.equal(objectiveText(plan), '2: acme.hold 0.5 × 2, directions 1');
  assert.equal(objectiveText({disassembly: []}), null);
});
