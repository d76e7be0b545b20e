// What the step checks of the objective say, as rows of name and text.
import {number} from './words.js';

/** The verdicts on a step. A step of the assembly is the operation of the disassembly step that it reverses. */
export function verdictsOf(plan, step, mode) {
  const own = mode === 'assembly' ? plan.disassembly[plan.disassembly.length - step.step] : step;
  return own?.checks ?? [];
}

/** Costs, refusals and notes. */
export function verdictRows(verdicts) {
  const rows = [];
  for (const v of verdicts) {
    const why = v.reason ? `: ${v.reason}` : '';
    if (v.failed) rows.push(['not judged', `${v.type}: ${v.failed}`]);
    if (!v.allowed) rows.push(['not allowed', `${v.type}${why}`]);
    else if (v.cost > 0) rows.push(['cost', `${number(v.cost)}, ${v.type}${why}`]);
    for (const note of v.notes ?? []) rows.push(['note', note.text]);
  }
  return rows;
}

/** The sums of the plan; null: it was not judged. */
export function objectiveText({objective}) {
  if (!objective) return null;
  const each = objective.checks.map(c => `${c.type} ${number(c.cost)}${c.weight === 1 ? '' : ` × ${number(c.weight)}`}`);
  return `${number(objective.cost)}: ${each.join(', ')}`;
}
