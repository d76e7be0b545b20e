// Notes: what is written is read again, whatever the names and texts; a person may change the file.
import assert from 'node:assert/strict';
import test from 'node:test';
import {keyOf, notesYaml, readNotes} from '../src/plan/notes.js';

const step = (...names) => ({moves: names.map(part => ({part}))});
const names = ['pin', 'it\'s', 'a "b" {c: [d]}, e', 'x: y # z', 'Zähler\n2', '- {parts', '\\'];
const plan = {disassembly: [...names.map(n => step(n)), step('b', 'a')], assembly_steps: []};

test('what is written is read again', () => {
  for (let round = 1; round < 1 << plan.disassembly.length; ++round) {
    const texts = {};
    plan.disassembly.forEach((s, k) => { if (round >> k & 1) texts[keyOf(s)] = `${names[(k + round) % names.length]} ${round}`; });
    assert.deepEqual(readNotes(plan, notesYaml(plan, texts)), {texts, unknown: []});
  }
  assert.deepEqual(readNotes(plan, notesYaml(plan, {})), {texts: {}, unknown: []});
});

test('what a person writes is read, too', () => {
  const {texts, unknown} = readNotes(plan, "# mine\r\nnotes:\r\n- {text: 'it''s dry', parts: [a, b]}\n\n  -  { parts: [gone], text: Grease it }\n");
  assert.deepEqual(texts, {[keyOf(step('a', 'b'))]: "it's dry"});
  assert.deepEqual(unknown, [{parts: ['gone'], text: 'Grease it'}]);
});

test('a line that is no note is named, and nothing is read', () => {
  for (const wrong of ['- text', '- {parts: pin, text: a}', '- {parts: [pin]}', '- {parts: [pin], text: a} b', '- {parts: [pin], text: "a}', 'steps: []', '- {parts: [pin], text: a, text: b}', '- {parts: [[pin]], text: a}'])
    assert.throws(() => readNotes(plan, `notes:\n  - {parts: [pin], text: a}\n  ${wrong}\n`), /^Error: line 3: /, wrong);
});
