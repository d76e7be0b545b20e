// All that the page knows of the plan, worked out once: who is where when, in which colour, and who did not come out.
import {byOrder, given, STAYS, TROUBLE} from './plan/colours.js';
import {explode} from './plan/explode.js';
import {followGroups} from './plan/groups.js';
import {layOut, stepAt} from './plan/timeline.js';
import {sizeOf} from './plan/words.js';

const FADE = 0.3;  // s, as long as the pause between steps allows

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
    this.remaining = new Set(plan.remaining.map(name => this.index.get(name)));
    this.hasColours = plan.assembly.parts.some(p => given(p) !== null);
    this.#findTimes();
  }

  /** When parts that are out fade (disassembly), and when those that come from nowhere appear (assembly). */
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

  /** 1: there, 0: gone; `fading` as chosen by the user. */
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
    if (this.unsolved.has(i)) return TROUBLE;
    if (scheme === 'given') {
      const own = given(this.parts[i].source);
      if (own !== null) return own;
    }
    return this.rank[i] < 0 ? STAYS : byOrder(this.rank[i], this.leavers);
  }

  /** Index of the step that takes this part out for good, -1 if none does. */
  stepOf(i) {
    return this.leftIn[i] < 0 ? -1 : this.lines.disassembly.steps.findIndex(s => s.step === this.plan.disassembly[this.leftIn[i]]);
  }
}
