// Groups of parts after each step, and the step after which a part is out and alone.

/**
 * @returns {rank, leftIn, splits, leavers}: per part index its place in the order of removal (-1: it stays) and the index of
 * the step after which it is out and alone (-1: never); per step index {movers, out, rest}: the moving parts, those that leave
 * their group and those that remain in it; the number of parts that leave.
 */
export function followGroups(steps, names) {
  const index = new Map(names.map((name, i) => [name, i]));
  const group = new Array(names.length).fill(0);
  const rank = new Array(names.length).fill(-1), leftIn = new Array(names.length).fill(-1);
  const splits = [];
  let groups = 1, leavers = 0;
  steps.forEach((step, s) => {
    const movers = step.moves.map(m => index.get(m.part));
    const before = group.slice();
    for (const names_ of step.separates ?? []) {
      const members = names_.map(n => index.get(n)).filter(i => i !== undefined);
      for (const i of members) {
        group[i] = groups;
        if (rank[i] < 0) rank[i] = leavers++;
      }
      ++groups;
    }
    const out = names.map((_, i) => i).filter(i => group[i] !== before[i]);
    const from = new Set(out.map(i => before[i]));
    splits.push({movers, out, rest: names.map((_, i) => i).filter(i => from.has(before[i]) && group[i] === before[i])});
    // Every part that has become alone has left, except for the last part of the main group.
    const count = new Map();
    for (const g of group) count.set(g, (count.get(g) ?? 0) + 1);
    for (let i = 0; i < names.length; ++i)
      if (leftIn[i] < 0 && group[i] !== 0 && count.get(group[i]) === 1) leftIn[i] = s;
  });
  return {rank, leftIn, splits, leavers};
}
