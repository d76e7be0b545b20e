// What notes say of equilibrium: forces, and how parts fall that nobody holds (docs/stability.md).
import {multiply, transform} from './screw.js';

const numbers = list => Array.isArray(list) && list.length === 3 && list.every(Number.isFinite);
const LARGEST_TURN = 0.6;  // rad

/** The first picture of these verdicts: {when, falls, arrows}, parts by index; null when there is none. Notes are those of any check: what has another form is left out. */
export function pictureOf(verdicts, index) {
  for (const verdict of verdicts)
    for (const note of verdict?.notes ?? []) {
      const picture = note.data?.picture;
      if (!picture) continue;
      const falls = (picture.falls ?? []).filter(f => Array.isArray(f.parts) && numbers(f.center) && numbers(f.v) && numbers(f.w))
        .map(f => ({parts: f.parts.map(name => index.get(name)).filter(i => i !== undefined), center: f.center, v: f.v, w: f.w}));
      const arrows = (picture.arrows ?? []).filter(a => numbers(a.at) && numbers(a.force) && ['weight', 'contact', 'hold'].includes(a.kind));
      if (falls.length + arrows.length > 0) return {when: picture.when ?? 'after', text: note.text, falls, arrows};
    }
  return null;
}

const turn = new Float64Array(7), arm = new Float64Array(3);

/** Moves `pose` on by `share` of the motion {center, v, w}: it turns about the centre, which moves straight. Returns `pose`. */
export function fallen(pose, {center, v, w}, share) {
  const speed = Math.hypot(...w), angle = Math.min(LARGEST_TURN, speed * share), k = speed > 0 ? Math.sin(angle / 2) / speed : 0;
  turn.set([0, 0, 0, Math.cos(angle / 2), k * w[0], k * w[1], k * w[2]]);
  multiply(pose, 3, turn, 3, pose.slice(3, 7), 0);
  for (let i = 0; i < 3; ++i) arm[i] = pose[i] - center[i];
  transform(arm, turn, 0, arm);
  for (let i = 0; i < 3; ++i) pose[i] = center[i] + arm[i] + share * v[i];
  return pose;
}
