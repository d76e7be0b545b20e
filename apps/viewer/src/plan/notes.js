// Notes of the user on steps. A note belongs to the parts that a step moves, so that it survives another order.

export const keyOf = step => JSON.stringify(step.moves.map(m => m.part).sort());

/** A YAML list of the notes, in the order of the steps; `dismantle book --notes` reads it. Strings are JSON's, which are YAML, too. */
export function notesYaml(plan, notes) {
  const rows = [], seen = new Set();
  const steps = plan.assembly_steps?.length > 0 ? plan.assembly_steps : [...plan.disassembly].reverse();
  for (const step of steps) {
    const key = keyOf(step), text = notes[key];
    if (!text || seen.has(key)) continue;
    seen.add(key);
    rows.push(`  - {parts: ${key}, text: ${JSON.stringify(text)}}\n`);
  }
  return rows.length > 0 ? `notes:\n${rows.join('')}` : 'notes: []\n';
}

/** Reads the value at the beginning of `text`: a list, or a text that is quoted, or plain up to one of `,]}`. Returns the value and what follows. */
function readValue(text) {
  const rest = text.trimStart();
  if (rest[0] === '[') {
    const list = [];
    for (let after = rest.slice(1); ;) {
      if (after.trimStart()[0] === ']') return [list, after.trimStart().slice(1)];
      const [value, more] = readValue(after), next = more.trimStart();
      if (typeof value !== 'string' || (next[0] !== ',' && next[0] !== ']')) throw new Error('a list of names is expected');
      list.push(value);
      after = next[0] === ',' ? next.slice(1) : next;
    }
  }
  const quoted = /^"(?:[^"\\]|\\.)*"/.exec(rest) ?? /^'(?:[^']|'')*'/.exec(rest);
  if (quoted) return [rest[0] === '"' ? JSON.parse(quoted[0]) : quoted[0].slice(1, -1).replaceAll("''", "'"), rest.slice(quoted[0].length)];
  const plain = /^[^,\]}"'[{#]+/.exec(rest);
  if (!plain) throw new Error('a name or a text is expected');
  return [plain[0].trim(), rest.slice(plain[0].length)];
}

/** "{parts: [...], text: ...}" */
function readNote(line) {
  const note = {};
  let rest = line;
  for (let sign = '{'; rest[0] === sign; sign = ',') {
    const key = /^.\s*(parts|text)\s*:/.exec(rest);
    if (!key || key[1] in note) throw new Error('`parts` and `text` are expected');
    const [value, after] = readValue(rest.slice(key[0].length));
    note[key[1]] = value;
    rest = after.trimStart();
  }
  if (rest !== '}' || !Array.isArray(note.parts) || typeof note.text !== 'string') throw new Error('`parts` and `text` are expected');
  return note;
}

/**
 * Reads what notesYaml() writes, also if a person has changed it: one note in each line.
 * @returns {texts, unknown}: texts by the key of their step, and the notes on steps that the plan does not have
 */
export function readNotes(plan, yaml) {
  const known = new Set([...plan.disassembly, ...plan.assembly_steps ?? []].map(keyOf)), texts = {}, unknown = [];
  for (const [at, line] of yaml.split(/\r?\n/).entries()) {
    const words = line.trim();
    if (words === '' || words.startsWith('#') || words === '---' || /^notes:(\s*\[\s*\])?$/.test(words)) continue;
    try {
      if (!/^-\s/.test(words)) throw new Error('`- {parts: [NAME], text: TEXT}` is expected');
      const note = readNote(words.slice(1).trimStart()), key = JSON.stringify([...note.parts].sort());
      if (known.has(key)) texts[key] = note.text;
      else unknown.push(note);
    } catch (error) {
      throw new Error(`line ${at + 1}: ${error.message}`);
    }
  }
  return {texts, unknown};
}
