// The poses of each part over time: those of the plan, at the times that the page has for them.
import {screwInterpolate} from './screw.js';

const IDENTITY = [0, 0, 0, 1, 0, 0, 0];

/** Poses of one part over time; constant before the first and after the last key. */
export class Track {
  /** `times`: strictly increasing; `poses`: 7 numbers per time. */
  constructor(times, poses) {
    this.times = Float64Array.from(times);
    this.poses = Float64Array.from(poses);
    this.last = 0;  // index that the last search found; the next search begins there because time mostly increases
  }

  poseAt(time, out) {
    const {times, poses} = this, n = times.length;
    if (n === 0 || time <= times[0] || time >= times[n - 1]) {
      const from = n === 0 ? IDENTITY : poses, at = n === 0 || time <= times[0] ? 0 : 7 * (n - 1);
      for (let k = 0; k < 7; ++k) out[k] = from[at + k];
      return out;
    }
    let lo = this.last;
    if (!(times[lo] <= time && time < times[lo + 1])) {
      lo = 0;
      let hi = n - 1;
      while (hi - lo > 1) {
        const middle = lo + hi >> 1;
        if (times[middle] <= time) lo = middle; else hi = middle;
      }
      this.last = lo;
    }
    const u = (time - times[lo]) / (times[lo + 1] - times[lo]);
    return screwInterpolate(out, poses, 7 * lo, poses, 7 * lo + 7, u);
  }
}

/**
 * @param steps `disassembly` or `assembly_steps` of a plan
 * @param animation {duration, times, poses}: a time for each pose of the steps that move something, in their order, and its number in plan.json
 * @param index part index by name
 * @returns {tracks, steps, duration}: a Track or null per part index; the steps that move something, with their index in the plan, times and numbers of poses, and parts
 */
export function readAnimation(steps, {duration, times: all, poses: every}, index) {
  const keys = Array.from({length: index.size}, () => ({times: [], poses: []})), out = [];
  let used = 0;
  for (const [at, step] of steps.entries()) {
    if (step.moves.length === 0) continue;
    const from = used, times = all.subarray(from, used += step.moves[0].poses.length), numbers = every.subarray(from, used);
    const parts = step.moves.map(move => index.get(move.part));
    step.moves.forEach(({poses}, m) => {
      const key = keys[parts[m]];
      key.times.push(...times);
      for (const pose of poses) key.poses.push(...pose);
    });
    out.push({step, index: at, begin: times[0], end: times[times.length - 1], times, numbers, parts});
  }
  if (used !== all.length || used !== every.length) throw new Error('the times in this page are not those of its plan');
  return {tracks: keys.map(({times, poses}) => times.length > 0 ? new Track(times, poses) : null), steps: out, duration};
}

/** Time at which a step of readAnimation() reaches pose `k` of plan.json: those that the page leaves out are equally far apart. */
export function timeOfPose({times, numbers}, k) {
  let i = 0;
  while (i + 2 < numbers.length && numbers[i + 1] <= k) ++i;
  if (numbers[i] === k || numbers.length === 1) return times[i];
  return times[i] + (times[i + 1] - times[i]) * (k - numbers[i]) / (numbers[i + 1] - numbers[i]);
}

/** Index of the step that runs at `time`, or of the last one before; -1 before the first step. */
export function stepAt(line, time) {
  let found = -1;
  for (let i = 0; i < line.steps.length && line.steps[i].begin <= time; ++i) found = i;
  return found;
}
