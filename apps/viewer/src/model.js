// The plan as the page shows it. What is out when, the exploded view and the reasons come with the page; nothing of it is computed here.
import {byOrder, given, STAYS, TROUBLE} from './plan/colours.js';
import {readAnimation, stepAt} from './plan/animation.js';
import {verdictsOf} from './plan/checks.js';
import {Lies} from './plan/lies.js';
import {pictureOf} from './plan/statics.js';
import {isBad, sizeOf} from './plan/words.js';

const FADE = 0.3;  // s

export class Model {
  constructor({plan, result, parts, shapes, view}) {
    Object.assign(this, {plan, result, parts, shapes, view});
    this.index = new Map(parts.map(p => [p.name, p.index]));
    this.size = sizeOf(plan);
    this.lines = {
      disassembly: readAnimation(plan.disassembly, view.animations.disassembly, this.index),
      assembly: readAnimation(plan.assembly_steps ?? [], view.animations.assembly, this.index),
    };
    const box = plan.assembly.bbox ?? [[0, 0, 0], [1, 1, 1]];
    this.origin = box[0].map((x, k) => (x + box[1][k]) / 2);
    const corners = parts.flatMap(({lo, hi}) => Array.from({length: 8}, (_, c) => lo.map((x, k) => (c >> k & 1 ? hi[k] : x) - this.origin[k])));
    const lies = mode => new Lies(this.lines[mode], view.steps[mode], corners);
    this.lies = {disassembly: lies('disassembly'), assembly: lies('assembly')};
    this.offsets = parts.map((_, i) => view.offsets.subarray(3 * i, 3 * i + 3));
    this.unsolved = new Map(plan.unsolved.map(u => [this.index.get(u.part), u]));
    this.reach = new Map(view.reasons.flatMap(reason => reason.parts.map(p => [p.part, p])));
    const forced = plan.disassembly.filter(isBad).flatMap(s => s.moves.map(m => this.index.get(m.part)));
    this.forced = new Set(forced);
    this.remaining = new Set(plan.remaining.map(name => this.index.get(name)));
    this.hasTools = ['disassembly', 'assembly'].some(mode => view.steps[mode].some(s => s.tools));
    this.hasColours = plan.assembly.parts.some(p => given(p) !== null);
  }

  /** 1: visible, 0: faded out; `fading`: as chosen by the user. */
  presence(i, mode, time, fading) {
    if (!fading) return 1;
    if (mode === 'disassembly') return 1 - Math.min(1, Math.max(0, (time - this.view.gone[i]) / FADE));
    return Math.min(1, Math.max(0, (time - this.view.comes[i] + FADE) / FADE));
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

  /** Runs of equal steps that follow each other: `first`, index of a step that is shown, `count`, `words`. */
  runs(mode) {
    return this.view.runs[mode].map(run => ({...run, first: this.lines[mode].steps.findIndex(s => s.index === run.first)}));
  }

  /** What the page says of a step that is shown: how the assembly lies. */
  about(mode, index) {
    return this.view.steps[mode][this.lines[mode].steps[index].index];
  }

  /** Parts that must be held in a step that is shown. */
  held(mode, index) {
    return index < 0 ? [] : this.about(mode, index).hold ?? [];
  }

  /** Forces and falls of a step that is shown, of the pile as a whole before the first step; null: its notes say nothing of them. */
  statics(mode, index) {
    const verdicts = index < 0 ? (this.plan.objective?.checks ?? []).map(c => c.plan) : verdictsOf(this.plan, this.lines[mode].steps[index].step, mode);
    return pictureOf(verdicts, this.index);
  }

  colour(i, scheme) {
    if (this.unsolved.has(i) || this.forced.has(i)) return TROUBLE;
    if (scheme === 'given') {
      const own = given(this.parts[i].source);
      if (own !== null) return own;
    }
    const rank = this.view.rank[i];
    return rank === null ? STAYS : byOrder(rank, this.view.leavers);
  }

  /** The step of the plan after which this part is out, null if it stays. */
  outIn(i) {
    const step = this.view.out[i];
    return step === null ? null : this.plan.disassembly[step];
  }

  /** Its index among the steps that are shown, -1 if none takes it out. */
  stepOf(i) {
    return this.lines.disassembly.steps.findIndex(s => s.step === this.outIn(i));
  }
}
