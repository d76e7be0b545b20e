// How the assembly lies over time: steps say it, between them it is turned, and it is put down on the ground.
import {transform} from './screw.js';

/** out = the rotation at share u of the shorter way from quaternion a to b, real part first. */
export function slerp(out, a, b, u) {
  let cosine = 0;
  for (let k = 0; k < 4; ++k) cosine += a[k] * b[k];
  const sign = cosine < 0 ? -1 : 1, angle = Math.acos(Math.min(1, Math.abs(cosine)));
  const s = Math.sin(angle), f = s < 1e-6 ? 1 - u : Math.sin((1 - u) * angle) / s, g = sign * (s < 1e-6 ? u : Math.sin(u * angle) / s);
  let norm = 0;
  for (let k = 0; k < 4; ++k) norm += (out[k] = f * a[k] + g * b[k]) ** 2;
  for (let k = 0; k < 4; ++k) out[k] /= Math.sqrt(norm);
  return out;
}

const smooth = u => u * u * (3 - 2 * u), AS_DRAWN = [1, 0, 0, 0];

/** Share of the way from the layout that a part of a step is on: 0 before it, 1 where its own path begins. */
function shareOfTransfer({step, begin, times}, time) {
  if (!step.transfer) return 1;
  return Math.min(1, Math.max(0, (time - begin) / (times[step.transfer] - begin)));
}

export class Lies {
  /**
   * @param line of readAnimation()
   * @param said by step of the plan: `lies`, a quaternion, or nothing
   * @param corners of the assembled parts about the scene's origin, which is where the assembly is turned
   */
  constructor(line, said, corners) {
    this.line = line;
    this.ofStep = line.steps.map(s => said[s.index].lies ?? AS_DRAWN);
    this.any = this.ofStep.some(q => q[0] < 1);
    this.corners = corners;
    this.first = new Map();  // the step that brings a part from the layout
    for (const entry of line.steps) for (const i of entry.parts) if (!this.first.has(i)) this.first.set(i, entry);
    this.turned = new Float64Array(4);
    this.point = new Float64Array(3);
  }

  /** The quaternion at `time`; `step`: the one that runs or ran last, -1 before the first. */
  #turnAt(time, step) {
    const {steps} = this.line, at = Math.max(step, 0), next = steps[at + 1];
    if (!next || time <= steps[at].end) return slerp(this.turned, this.ofStep[at], this.ofStep[at], 0);
    return slerp(this.turned, this.ofStep[at], this.ofStep[at + 1], smooth((time - steps[at].end) / (next.begin - steps[at].end)));
  }

  #low(pose, up) {
    let low = Infinity;
    for (const corner of this.corners) {
      transform(this.point, pose, 0, corner);
      low = Math.min(low, this.point[0] * up[0] + this.point[1] * up[1] + this.point[2] * up[2]);
    }
    return low;
  }

  /** out: the pose, about the scene's origin, with the rotation `turn`, of an assembly that stands where it stands as drawn. */
  #putDown(out, turn, up) {
    out.fill(0, 0, 3);
    for (let k = 0; k < 4; ++k) out[3 + k] = AS_DRAWN[k];
    const before = this.#low(out, up);
    for (let k = 0; k < 4; ++k) out[3 + k] = turn[k];
    const lift = before - this.#low(out, up);
    for (let k = 0; k < 3; ++k) out[k] = lift * up[k];
    return out;
  }

  /** Pose of the assembly at `time`, scene coordinates; `up`: unit. */
  at(out, time, step, up) {
    return this.#putDown(out, this.#turnAt(time, step), up);
  }

  /** Pose that the assembly has during a step. */
  during(out, step, up) {
    return this.#putDown(out, this.ofStep[step], up);
  }

  /** How much of the pose of the assembly part `i` takes part in: parts wait in the layout as drawn. */
  share(i, time) {
    const first = this.first.get(i);
    return first ? shareOfTransfer(first, time) : 1;
  }
}

const waiting = new Float64Array([1, 0, 0, 0]), turn = new Float64Array(4);
/** out = `pose` for a share of 1, and as drawn for 0. */
export function partly(out, pose, share) {
  for (let k = 0; k < 4; ++k) turn[k] = pose[3 + k];
  slerp(turn, waiting, turn, share);
  for (let k = 0; k < 3; ++k) out[k] = share * pose[k];
  for (let k = 0; k < 4; ++k) out[3 + k] = turn[k];
  return out;
}
