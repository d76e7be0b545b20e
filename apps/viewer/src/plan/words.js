// Texts about a plan for the user. Strings are inserted into pages as text, never as markup.

const OUTCOMES = {
  timeout: 'Time ran out',
  depth_limit: 'Search was cut short',
  exhausted: 'Nothing left to try',
  infeasible: 'Proved: it cannot leave',
  invalid_start: 'Start is not valid',
  cancelled: 'Run was stopped',
  unsupported: 'Not supported',
  crashed: 'Planner failed',
};

export const outcomeTitle = o => OUTCOMES[o] ?? String(o);

/** "it stays" as a sentence: "It stays." */
export const sentence = text => `${text.charAt(0).toUpperCase()}${text.slice(1)}.`;

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

/** A length in input units. */
export const lengthWords = (length, plan) => `${number(length)} ${plan.assembly.unit ?? 'input units'}`;

/** Is the step forced, without the user's acceptance of what it cuts? */
export const isBad = step => Boolean(step.forced) && !step.forced.accepted;

/** Description of a forced step. */
export const forcedWords = ({pair, depth, assembled, at, lower_bound: bound, accepted}, plan) =>
  `${pair[0]} cuts ${bound ? 'at least ' : ''}${lengthWords(depth, plan)} into ${pair[1]} (${number(assembled)} when assembled), at (${at.map(number).join(', ')})${accepted ? `, accepted as ${accepted}` : ''}`;

export function seconds(s) {
  if (s < 0.0995) return `${number(Number((1000 * s).toPrecision(2)))} ms`;
  if (s < 99.5) return `${number(Number(s.toPrecision(2)))} s`;
  return `${Math.round(s / 60)} min`;
}

export const clock = s => `${Math.floor(s / 60)}:${String(Math.floor(s % 60)).padStart(2, '0')}`;

/** A length in input units as a share of the assembly's largest edge. */
export const shareOfSize = (length, plan) => `${number(Number((100 * length / sizeOf(plan)).toPrecision(2)))} %`;

/** A depth in assembly units as a share of the assembly's largest edge. */
export const share = (depth, plan) => shareOfSize(depth / plan.assembly.scale, plan);

export function sizeOf(plan) {
  const box = plan.assembly.bbox;
  return box ? Math.max(...box[1].map((x, k) => x - box[0][k]), 1e-300) : 1;
}

export function titleOf(plan) {
  const pieces = plan.assembly.source.split(/[\\/]/).filter(p => p !== '' && p !== '.');
  return pieces.length > 0 ? pieces[pieces.length - 1] : 'assembly';
}
