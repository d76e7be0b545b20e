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
