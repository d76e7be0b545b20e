// The exploded view: each part moves along its direction of removal until no boxes overlap.
import {transform} from './screw.js';

const GAP = 0.04;  // between boxes, relative to the assembly's size

/** Direction of the displacement of the box's centre over the whole move, ignoring rotation. */
function direction(step, movers, out, boxes, middle) {
  const d = [0, 0, 0], to = new Float64Array(3);
  let count = 0;
  step.moves.forEach((move, m) => {
    if (!out.includes(movers[m])) return;
    const {center} = boxes[movers[m]];
    const from = transform(new Float64Array(3), move.poses[0], 0, center);
    transform(to, move.poses[move.poses.length - 1], 0, center);
    for (let k = 0; k < 3; ++k) d[k] += to[k] - from[k];
    ++count;
  });
  let length = Math.hypot(...d);
  if (count === 0 || !(length > 0)) {  // no part moved, or they only rotated: away from the assembly's centre
    d.fill(0);
    for (const i of out) for (let k = 0; k < 3; ++k) d[k] += boxes[i].center[k] - middle[k];
    length = Math.hypot(...d);
    if (!(length > 0)) return [0, 0, 1];
  }
  return d.map(x => x / length);
}

/** Distance that `a` must move along `u` to pass `b`; 0 if they do not meet. */
function passing(a, b, u, gap) {
  let enter = 0, leave = Infinity;
  for (let k = 0; k < 3; ++k) {
    const lo = b.lo[k] - a.hi[k] - gap, hi = b.hi[k] - a.lo[k] + gap;
    if (Math.abs(u[k]) < 1e-6) {
      if (lo >= 0 || hi <= 0) return 0;
      continue;
    }
    const s = lo / u[k], e = hi / u[k];
    enter = Math.max(enter, Math.min(s, e));
    leave = Math.min(leave, Math.max(s, e));
  }
  return leave > enter ? leave : 0;
}

const shifted = (box, by) => ({lo: box.lo.map((x, k) => x + by[k]), hi: box.hi.map((x, k) => x + by[k])});

/**
 * @param boxes per part {lo, hi, center}, assembled, input units
 * @param splits from followGroups()
 * @returns per part [x, y, z], its shift in the fully exploded view, input units
 */
export function explode(steps, splits, boxes, size, middle) {
  const offsets = boxes.map(() => [0, 0, 0]);
  // In assembly order: a group is exploded before its distance from the rest is computed.
  for (let s = steps.length - 1; s >= 0; --s) {
    const {out, rest, movers} = splits[s];
    if (out.length === 0 || rest.length === 0) continue;
    // If the step moved the rest instead of `out`, direction() points away from the assembly's centre.
    const u = direction(steps[s], movers, out, boxes, middle);
    let far = 0;
    for (const i of out) {
      const mine = shifted(boxes[i], offsets[i]);
      for (const j of rest) far = Math.max(far, passing(mine, shifted(boxes[j], offsets[j]), u, GAP * size));
    }
    far = Math.max(far, 2 * GAP * size);
    for (const i of out) for (let k = 0; k < 3; ++k) offsets[i][k] += far * u[k];
  }
  return offsets;
}
