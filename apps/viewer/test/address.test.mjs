// The step in the address of a page.
import assert from 'node:assert/strict';
import test from 'node:test';
import {addressOfStep, stepOfAddress} from '../src/ui/address.js';

test('an address names the step that it was made of', () => {
  for (const mode of ['disassembly', 'assembly'])
    for (const step of [1, 2, 17, 1000]) assert.deepEqual(stepOfAddress(addressOfStep(mode, step)), {mode, step});
});

test('an address without a step names none', () => {
  for (const hash of ['', '#', '#step', '#step=', '#step=0', '#step=-3', '#step=1.5', '#step=x', '#other=5', '#step=<b>']) assert.equal(stepOfAddress(hash), null);
});
