// The poses of each part over time: the steps of a plan laid out in time, as in plan.glb.
import {screwInterpolate, screwTravel} from './screw.js';

const LEAD = 0.5, PAUSE = 0.35, END_PAUSE = 1;  // s
const SHORTEST = 1, LONGEST = 3;                // s per step
const SECONDS_PER_SIZE = 1.5;                   // for a path as long as the assembly

const IDENTITY = [0, 0, 0, 1, 0, 0, 0];

/** Poses of one part over time; constant before the first and after the last key. */
export class Track {
  constructor() {
    this.times = [];
    this.poses = [];  // 7 numbers per time
    this.last = 0;    // index that the last search found; the next search begins there because time mostly increases
  }

  append(time, pose) {
    this.times.push(time);
    for (let k = 0; k < 7; ++k) this.poses.push(pose[k]);
  }

  freeze() {
    this.times = Float64Array.from(this.times);
    this.poses = Float64Array.from(this.poses);
    return this;
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

/** Share of the step's time at each of its poses, such that the part that moves furthest has constant speed. Also the path's length. */
function sharesOf(step, bodies) {
  const n = step.moves[0].poses.length, path = new Float64Array(n);
  for (let k = 1; k < n; ++k) {
    let furthest = 0;
    step.moves.forEach((move, m) => {
      const {center, radius} = bodies[m];
      furthest = Math.max(furthest, screwTravel(move.poses[k - 1], 0, move.poses[k], 0, center, radius));
    });
    path[k] = path[k - 1] + furthest;
  }
  const length = path[n - 1];
  for (let k = 0; k < n; ++k) path[k] = length > 0 ? path[k] / length : k / (n - 1);
  return {shares: path, length};
}

/**
 * @param steps `disassembly` or `assembly_steps` of a plan
 * @param bodies by part name: {index, center, radius}, assembled, input units
 * @param size largest edge of the assembly, input units
 * @returns {tracks, steps, duration}: a Track or null per part index; per step its times and parts
 */
export function layOut(steps, bodies, size) {
  const tracks = new Array(bodies.size).fill(null), out = [];
  let now = LEAD;
  for (const step of steps) {
    if (step.moves.length === 0) continue;
    const movers = step.moves.map(move => bodies.get(move.part));
    const {shares, length} = sharesOf(step, movers);
    const duration = Math.min(LONGEST, Math.max(SHORTEST, SECONDS_PER_SIZE * length / size));
    const times = shares.map(s => now + duration * s);
    movers.forEach((body, m) => {
      const track = tracks[body.index] ??= new Track();
      step.moves[m].poses.forEach((pose, k) => {
        // A pose at the same time replaces the previous one: a track's times strictly increase.
        if (track.times.length > 0 && times[k] <= track.times[track.times.length - 1]) {
          for (let n = 0; n < 7; ++n) track.poses[track.poses.length - 7 + n] = pose[n];
        } else {
          track.append(times[k], pose);
        }
      });
    });
    out.push({step, begin: now, end: now + duration, times, parts: movers.map(b => b.index)});
    now += duration + PAUSE;
  }
  for (const track of tracks) track?.freeze();
  return {tracks, steps: out, duration: out.length > 0 ? now - PAUSE + END_PAUSE : 0, pause: PAUSE};
}

/** Index of the step that runs at `time`, or of the last one before; -1 before the first step. */
export function stepAt(line, time) {
  let found = -1;
  for (let i = 0; i < line.steps.length && line.steps[i].begin <= time; ++i) found = i;
  return found;
}
