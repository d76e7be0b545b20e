// The page's model of the plan, computed once: poses over time, colours, and the parts that did not come out.
import {byOrder, given, STAYS, TROUBLE} from './plan/colours.js';
import {explode} from './plan/explode.js';
import {followGroups} from './plan/groups.js';
import {transform} from './plan/screw.js';
import {layOut, stepAt} from './plan/timeline.js';
import {sizeOf} from './plan/words.js';

const FADE = 0.3;  // s, limited by the pause between steps

export class Model {
  constructor({plan, parts, shapes}) {
    Object.assign(this, {plan, parts, shapes});
    this.index = new Map(parts.map(p => [p.name, p.index]));
    this.size = sizeOf(plan);
    const bodies = new Map(parts.map(p => [p.name, p]));
    this.lines = {
      disassembly: layOut(plan.disassembly, bodies, this.size),
      assembly: layOut(plan.assembly_steps ?? [], bodies, this.size),
    };
    const groups = followGroups(plan.disassembly, parts.map(p => p.name));
    this.rank = groups.rank;
    this.leavers = groups.leavers;
    this.leftIn = groups.leftIn;
    const box = plan.assembly.bbox ?? [[0, 0, 0], [1, 1, 1]];
    this.origin = box[0].map((x, k) => (x + box[1][k]) / 2);
    this.offsets = explode(plan.disassembly, groups.splits, parts, this.size, this.origin);
    this.unsolved = new Map(plan.unsolved.map(u => [this.index.get(u.part), u]));
    const forced = plan.disassembly.filter(s => s.forced).flatMap(s => s.moves.map(m => this.index.get(m.part)));
    this.forced = new Set(forced);
    this.remaining = new Set(plan.remaining.map(name => this.index.get(name)));
    this.hasColours = plan.assembly.parts.some(p => given(p) !== null);
    this.#findTimes();
  }

  /** Times at which removed parts fade (disassembly) and parts without a transfer appear (assembly). */
  #findTimes() {
    const {disassembly, assembly} = this.lines;
    const endOf = new Map(disassembly.steps.map(s => [s.step, s.end]));
    this.goneAt = this.parts.map((_, i) => {
      const s = this.leftIn[i];
      return s >= 0 ? endOf.get(this.plan.disassembly[s]) ?? Infinity : Infinity;
    });
    this.comesAt = new Array(this.parts.length).fill(-Infinity);
    const seen = new Set();
    for (const step of assembly.steps)
      for (const i of step.parts) {
        if (!seen.has(i) && !step.step.transfer) this.comesAt[i] = step.begin;
        seen.add(i);
      }
  }

  /** 1: visible, 0: faded out; `fading`: as chosen by the user. */
  presence(i, mode, time, fading) {
    if (!fading) return 1;
    if (mode === 'disassembly') return 1 - Math.min(1, Math.max(0, (time - this.goneAt[i]) / FADE));
    return Math.min(1, Math.max(0, (time - this.comesAt[i] + FADE) / FADE));
  }

  poseOf(i, mode, time, out) {
    const track = this.lines[mode].tracks[i];
    if (track) return track.poseAt(time, out);
    out.fill(0, 0, 7);
    out[3] = 1;
    return out;
  }

  stepAt(mode, time) {
    return stepAt(this.lines[mode], time);
  }

  colour(i, scheme) {
    if (this.unsolved.has(i) || this.forced.has(i)) return TROUBLE;
    if (scheme === 'given') {
      const own = given(this.parts[i].source);
      if (own !== null) return own;
    }
    return this.rank[i] < 0 ? STAYS : byOrder(this.rank[i], this.leavers);
  }

  /**
   * Displacement of an unsolved part's best pose from its last pose in the plan: `length` by which its centre has moved (input
   * units), `angle` (degrees), and whether it moved at all.
   */
  furthest(i) {
    const {best_pose: best} = this.unsolved.get(i), {center} = this.parts[i];
    const left = this.poseOf(i, 'disassembly', this.lines.disassembly.duration, new Float64Array(7));
    const a = transform([0, 0, 0], left, 0, center), b = transform([0, 0, 0], best, 0, center);
    const length = Math.hypot(...a.map((x, k) => b[k] - x));
    const cosine = Math.abs(left[3] * best[3] + left[4] * best[4] + left[5] * best[5] + left[6] * best[6]);
    const angle = 2 * Math.acos(Math.min(1, cosine)) * 180 / Math.PI;
    return {length, angle, moved: length > 1e-9 * this.size || angle > 1e-3};
  }

  /** Index of the step that finally removes this part, -1 if none does. */
  stepOf(i) {
    return this.leftIn[i] < 0 ? -1 : this.lines.disassembly.steps.findIndex(s => s.step === this.plan.disassembly[this.leftIn[i]]);
  }
}
