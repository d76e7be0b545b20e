// Texts about a plan for the user. Strings are inserted into pages as text, never as markup.

const OUTCOMES = {
  timeout: ['Time ran out', 'The budget of time or steps was used up. More may help.'],
  depth_limit: ['Search was cut short', 'It was searched to the depth allowed. Deeper may help.'],
  exhausted: ['Nothing left to try', 'No state was left to search at this resolution.'],
  infeasible: ['Proved: it cannot leave', 'No motion of rigid parts separates it from what holds it. The proof is below.'],
  invalid_start: ['Start is not valid', 'Assembled, it already cuts into another part deeper than was measured.'],
  cancelled: ['Run was stopped', 'The run was stopped before this part was solved.'],
  unsupported: ['Not supported', 'The simulator lacks what the planner needs.'],
  crashed: ['Planner failed', 'A plugin failed on this part.'],
};

export const outcomeTitle = o => OUTCOMES[o]?.[0] ?? String(o);
export const outcomeMeaning = o => OUTCOMES[o]?.[1] ?? '';

export const counted = (n, what) => `${n} ${what}${n === 1 ? '' : 's'}`;

/** "a", "a and b", "a, b and 3 more" */
export function listed(names, most = 2) {
  if (names.length <= most) return names.join(' and ');
  return `${names.slice(0, most).join(', ')} and ${names.length - most} more`;
}

/** 3 significant digits, without exponents for numbers of usual size. */
export function number(x) {
  if (x === 0) return '0';
  const size = Math.abs(x);
  if (size >= 1e5 || size < 1e-5) return x.toExponential(1);
  return String(Number(x.toPrecision(size >= 100 ? Math.floor(Math.log10(size)) + 1 : 3)));
}

/** Description of a forced step, in input units. */
export const forcedWords = ({pair, depth, assembled, at, lower_bound: bound}) =>
  `${pair[0]} cuts ${bound ? 'at least ' : ''}${number(depth)} units into ${pair[1]} (${number(assembled)} when assembled), at (${at.map(number).join(', ')})`;

export function seconds(s) {
  if (s < 0.0995) return `${number(Number((1000 * s).toPrecision(2)))} ms`;
  if (s < 99.5) return `${number(Number(s.toPrecision(2)))} s`;
  return `${Math.round(s / 60)} min`;
}

export const clock = s => `${Math.floor(s / 60)}:${String(Math.floor(s % 60)).padStart(2, '0')}`;

/** A depth in assembly units as a share of the assembly's largest edge. */
export function share(depth, plan) {
  const size = sizeOf(plan) * plan.assembly.scale;
  return `${number(Number((100 * depth / size).toPrecision(2)))} %`;
}

export function sizeOf(plan) {
  const box = plan.assembly.bbox;
  return box ? Math.max(...box[1].map((x, k) => x - box[0][k]), 1e-300) : 1;
}

export function titleOf(plan) {
  const pieces = plan.assembly.source.split(/[\\/]/).filter(p => p !== '' && p !== '.');
  return pieces.length > 0 ? pieces[pieces.length - 1] : 'assembly';
}
