// The state of the page, and its effect on the scene. Every change of the state notifies the listeners.
import {partly} from './plan/lies.js';
import {fallen} from './plan/statics.js';
import {screwInterpolate} from './plan/screw.js';
import {Parts} from './scene/parts.js';

const AMBER = '#f59e0b', HELD = '#12b5cb', BEST_TIME = 1.6;  // s, duration of the motion to an unsolved part's furthest pose
const SEEN_THROUGH = 0.5, BESIDE = 0.3;  // opacities
const FALL_TIME = 1.2, FALL_REST = 0.6, FALL_WAY = 0.12;  // s, s, and how far parts fall, relative to the assembly's size

export class App {
  constructor(model) {
    this.model = model;
    this.stage = this.parts = this.trails = this.places = this.section = this.measure = this.tools = this.forces = null;
    this.mode = 'disassembly';
    this.time = 0;
    this.playing = false;
    this.speed = 1;
    this.explode = 0;
    this.colours = model.hasColours ? 'given' : 'order';
    this.trailing = 'step';  // none, step, all
    this.fading = model.parts.length > 12;
    this.selected = this.hovered = -1;
    this.following = false;  // the camera goes with each step
    this.moving = new Set();
    this.held = new Set();
    this.hidden = new Set();
    this.clear = new Set();  // made transparent
    this.isolated = null;    // a Set, or null
    this.best = null;        // {index, u}: an unsolved part on the motion to its furthest pose
    this.fall = null;        // {seconds, motions, arrows}: parts fall that nobody holds, over and over
    this.pierced = new Set();    // what a forced step cuts into
    this.step = -1;
    this.listeners = [];
    this.stale = true;
    this.pose = new Float64Array(7);
    this.lies = new Float64Array([0, 0, 0, 1, 0, 0, 0]);  // of the assembly in the scene
    this.waits = new Float64Array(7);
  }

  on(listener) {
    this.listeners.push(listener);
  }

  tell(what) {
    for (const listener of this.listeners) listener(what);
  }

  show(stage, parts, trails, places, tools, forces) {
    Object.assign(this, {stage, parts, trails, places, tools, forces});
    stage.onFrame = seconds => this.frame(seconds);
    this.paint();
    this.place();
    this.settle();
    this.home(false);
  }

  get line() {
    return this.model.lines[this.mode];
  }

  // Time

  seek(time) {
    this.leaveBest();
    this.leaveFall();
    this.time = Math.min(this.line.duration, Math.max(0, time));
    this.#timeChanged();
  }

  #timeChanged() {
    this.stale = true;
    this.tell('time');
    const step = this.model.stepAt(this.mode, this.time);
    if (step !== this.step) {
      this.step = step;
      this.#light();
      this.#showTrails();
      if (this.following && step >= 0) this.follow();
      this.tell('step');
    }
  }

  play(on = !this.playing) {
    this.leaveBest();
    this.leaveFall();
    if (on && this.time >= this.line.duration) this.seek(0);
    this.playing = on && this.line.duration > 0;
    this.tell('play');
  }

  goToStep(index, play = false) {
    const {steps, duration} = this.line;
    if (steps.length === 0) return;
    if (index >= steps.length) this.seek(duration);
    else this.seek(index < 0 ? 0 : steps[index].begin);
    if (play) this.play(true);
  }

  /** Seeks forwards to the end of this step, or backwards to the beginning of this or the previous step. */
  stepBy(direction) {
    this.play(false);
    const {steps, duration} = this.line, now = this.time;
    if (direction > 0) {
      const next = steps.find(s => s.end > now + 1e-6);
      this.seek(next ? next.end : duration);
    } else {
      const before = steps.filter(s => s.begin < now - 1e-6).pop();
      this.seek(before ? before.begin : 0);
    }
  }

  setSpeed(speed) {
    this.speed = speed;
    this.tell('play');
  }

  setMode(mode) {
    if (mode === this.mode || this.model.lines[mode].duration === 0) return;
    this.leaveBest();
    this.leaveFall();
    this.mode = mode;
    this.time = 0;
    this.step = -2;
    this.tell('mode');
    this.#timeChanged();
    this.place();
    this.settle();
    this.home(true);
  }

  /** Lights what moves in this step, and marks what must be held. */
  #light() {
    this.moving = new Set(this.line.steps[this.step]?.parts);
    this.held = new Set(this.model.held(this.mode, this.step));
    const forced = this.line.steps[this.step]?.step.forced;
    this.pierced = new Set(forced ? [this.model.index.get(forced.pair[1])] : []);
    this.paint();
  }

  /** Moves the camera to where this step happens: its parts where they begin and end, and those that they touch or that are held. */
  follow() {
    if (!this.stage || this.step < 0) return;
    const {step, begin, end, times, parts} = this.line.steps[this.step], {time} = this, touched = new Set(this.held);
    for (const name of step.contacts ?? []) touched.add(this.model.index.get(name));
    const boxes = [begin, this.mode === 'assembly' && step.transfer ? times[step.transfer] : end, end].flatMap(at => {
      this.time = at;
      this.place();
      return this.parts.boxes(i => parts.includes(i) || touched.has(i));
    });
    this.time = time;
    this.place();
    this.stage.fit(boxes, {margin: 1.5, minimum: 0.25 * this.model.size});
  }

  setFollowing(on) {
    this.following = on;
    if (on) this.follow();
    else this.fit();
    this.tell('display');
  }

  // Visibility

  setExplode(share) {
    this.explode = Math.min(1, Math.max(0, share));
    this.stale = true;
    this.#showTrails();
    this.tell('explode');
    if (this.stage) {
      this.place();
      this.stage.ground.material.opacity = this.stage.shade * (1 - 0.6 * this.explode);
      this.fit(false, 1.12);
    }
  }

  setColours(scheme) {
    this.colours = scheme;
    this.paint();
    this.#showTrails();
    this.tell('colours');
  }

  setTrails(which) {
    this.trailing = which;
    this.#showTrails();
    this.tell('display');
  }

  setTools(on) {
    this.tools.on = on;
    this.stale = true;
    this.tell('display');
  }

  setFading(on) {
    this.fading = on;
    this.stale = true;
    this.tell('display');
  }

  /** Adds a part index to the set `which` ('hidden' or 'clear'), or removes it. */
  toggle(which, index) {
    if (!this[which].delete(index)) this[which].add(index);
    this.#seenChanged();
  }

  isolate(indices) {
    this.isolated = indices;
    if (indices) for (const i of indices) this.hidden.delete(i);
    this.#seenChanged();
  }

  showAll() {
    this.hidden.clear();
    this.clear.clear();
    this.isolated = null;
    this.leaveBest();
    this.#seenChanged();
  }

  #seenChanged() {
    this.stale = true;
    this.tell('seen');
  }

  select(index) {
    if (index === this.selected) return;
    this.selected = index;
    this.stale = true;
    this.paint();
    this.tell('selection');
  }

  hover(index) {
    if (index === this.hovered) return;
    this.hovered = index;
    this.paint();
    this.stage?.invalidate();
  }

  /** Shows the furthest pose of an unsolved part with the parts that blocked it; all other parts are transparent. */
  showBest(index) {
    this.play(false);
    this.seek(this.line.duration);
    if (this.mode !== 'disassembly') this.setMode('disassembly');
    this.time = this.line.duration;
    this.#timeChanged();
    const unsolved = this.model.unsolved.get(index);
    const blockers = new Set(unsolved.blocked_by.map(name => this.model.index.get(name)));
    // The part may be inside a blocking part or around it, so the larger of the two is transparent.
    const size = i => this.model.parts[i].radius, through = new Set([...blockers].filter(i => size(i) > size(index)));
    if (through.size < blockers.size) through.add(index);
    // Begin at the part's last pose in the plan: it may have left together with other parts.
    const from = this.model.poseOf(index, this.mode, this.time, new Float64Array(7));
    this.best = {index, unsolved, blockers, through, from, u: 1};
    this.stale = true;
    this.selected = index;
    this.#showTrails();
    this.paint();
    this.tell('best');
    this.tell('selection');
    if (this.stage) {
      const concerned = i => i === index || blockers.has(i);
      this.place();
      const after = this.parts.boxes(concerned);
      this.best.u = 0;
      this.place();
      this.stage.fit([...after, ...this.parts.boxes(concerned)], {margin: 1.3, minimum: 0.1 * this.model.size});
      this.places.show((unsolved.places ?? []).map(p => p.at));
    }
  }

  leaveBest() {
    if (!this.best) return;
    this.best = null;
    this.places?.show([]);
    this.stale = true;
    this.paint();
    this.#showTrails();
    this.tell('best');
  }

  /** The time at which the parts of a forced step have come as far as they do without cutting in; null: the plan does not say. */
  reachedAt(index) {
    const {plan, lines} = this.model, {step, times} = lines[this.mode].steps[index];
    const own = this.mode === 'assembly' ? plan.disassembly[plan.disassembly.length - step.step] : step;
    if (!own?.forced || !own.valid_to) return null;
    return times[this.mode === 'assembly' ? times.length - 1 - own.valid_to : own.valid_to];
  }

  /** Shows a forced step where it begins to cut in. */
  showReached(index) {
    this.play(false);
    this.seek(this.reachedAt(index));
    this.follow();
    this.places?.show([this.line.steps[index].step.forced.at]);
  }

  /** Shows what falls in the current step if nobody holds it, and the forces if somebody does; -1: in the pile as a whole. */
  showFall() {
    const picture = this.model.statics(this.mode, this.step);
    if (!picture) return;
    const {steps} = this.line, {begin, end} = steps[this.step] ?? {begin: 0, end: 0};
    this.play(false);
    // All parts of the step are in their places when it begins taken apart, and ends put together.
    const at = this.mode === 'assembly' ? end : begin, step = this.step;
    this.time = at;
    this.#timeChanged();
    if (this.step !== step) {  // the next step begins at once
      this.time = at - 1e-6;
      this.#timeChanged();
    }
    const motions = new Map(picture.falls.flatMap(fall => fall.parts.map(i => [i, fall])));
    const hand = picture.when === 'during' ? new Set(steps[this.step]?.parts) : new Set();  // these are not put in yet
    this.fall = {...picture, seconds: 0, motions, hand};
    this.forces?.show(picture.arrows);
    this.stale = true;
    this.paint();
    this.#showTrails();
    this.tell('fall');
  }

  leaveFall() {
    this.places?.show([]);
    if (!this.fall) return;
    this.fall = null;
    this.forces?.show([]);
    this.stale = true;
    this.paint();
    this.#showTrails();
    this.tell('fall');
  }

  // The scene

  opacity(i) {
    if (this.hidden.has(i) || (this.isolated && !this.isolated.has(i))) return 0;
    const presence = this.model.presence(i, this.mode, this.time, this.fading);
    if (this.best?.through.has(i)) return SEEN_THROUGH;
    if (this.fall?.hand.has(i)) return Parts.ghostly(presence);
    if (this.fall?.motions.size > 0 && !this.fall.motions.has(i)) return BESIDE * presence;
    const through = this.clear.has(i) || (this.best && i !== this.best.index && !this.best.blockers.has(i));
    return through ? Parts.ghostly(presence) : presence;
  }

  /** Moves each part to its current pose. Called for each changed frame; allocates nothing. */
  place() {
    const {parts, model, best} = this;
    if (!parts) return;
    const lies = model.lies[this.mode];
    if (lies.any) lies.at(this.lies, this.time, model.stepAt(this.mode, this.time), this.stage.up.toArray());
    else this.lies.set([0, 0, 0, 1, 0, 0, 0]);
    for (let i = 0; i < model.parts.length; ++i) {
      if (best && best.index === i) {
        const u = best.u;
        screwInterpolate(this.pose, best.from, 0, best.unsolved.best_pose, 0, u * u * (3 - 2 * u));
      } else {
        model.poseOf(i, this.mode, this.time, this.pose);
        const motion = this.fall?.motions.get(i);
        if (motion) fallen(this.pose, motion, this.#fallen());
      }
      const share = lies.any ? lies.share(i, this.time) : 0;
      parts.move(i, this.pose, this.explode, !lies.any || share === 0 ? null : share === 1 ? this.lies : partly(this.waits, this.lies, share));
      parts.bodies[i].setOpacity(this.opacity(i), i === this.selected);
    }
    this.trails.lie(this.lies);
    this.places.lie(this.lies);
    this.forces.lie(this.lies);
    this.section?.lie(this.lies);
    this.tools.lie(this.lies);
    this.tools.place(this.time, !best && this.explode === 0);
    this.stale = false;
    this.stage.invalidate(true);
  }

  /** How far along their motion falling parts are now: faster and faster, for as long as the motion is small, and a rest. */
  #fallen() {
    const u = Math.min(1, this.fall.seconds / FALL_TIME);
    return u * u * FALL_WAY * this.model.size;
  }

  paint() {
    if (!this.parts) return;
    for (const {part: {index}} of this.parts.bodies) {
      const body = this.parts.bodies[index];
      body.setColour(this.model.colour(index, this.colours));
      if (this.best?.blockers.has(index)) body.setGlow(AMBER, 0.45);
      else if (this.pierced.has(index)) body.setGlow(AMBER, 0.3);
      else if (this.held.has(index)) body.setGlow(HELD, 0.55);
      else if (index === this.selected) body.setGlow('#ffffff', 0.1);
      else if (index === this.hovered) body.setGlow('#ffffff', 0.16);
      else if (this.moving.has(index)) body.setGlow('#ffffff', 0.2);
      else body.setGlow('#000000', 0);
    }
    this.stage.invalidate();
  }

  #showTrails() {
    if (!this.trails) return;
    let indices = [];
    if (!this.best && !this.fall && this.explode === 0) {
      if (this.trailing === 'step' && this.step >= 0) indices = [this.step];
      if (this.trailing === 'all') indices = this.line.steps.map((_, i) => i);
    }
    this.trails.show(this.mode, indices, this.colours, this.stage.up.toArray());
    this.tools.show(this.mode, this.step);
    this.stale = true;
    this.stage.invalidate();
  }

  frame(seconds) {
    if (this.playing) {
      this.time = Math.min(this.line.duration, this.time + seconds * this.speed);
      if (this.time >= this.line.duration) {
        this.playing = false;
        this.tell('play');
      }
      this.#timeChanged();
    }
    if (this.best && this.best.u < 1) {
      this.best.u = Math.min(1, this.best.u + seconds / BEST_TIME);
      this.stale = true;
    }
    if (this.fall && this.fall.motions.size > 0) {
      this.fall.seconds = (this.fall.seconds + seconds) % (FALL_TIME + FALL_REST);
      this.stale = true;
    }
    if (this.stale) this.place();
  }

  /** Fits ground and light to the assembly and, in assembly mode, to the parts around it. */
  settle() {
    if (!this.stage) return;
    this.stage.settle(this.parts.boxes(() => true));
  }

  fit(fly = true, margin = 1.12, from = null) {
    this.stage?.fit(this.parts.boxes(i => this.opacity(i) > 0), {fly, margin, from});
  }

  /** The initial view: the assembly, with space for parts that leave it, or for the parts around it and their transfers. */
  home(fly) {
    if (!this.stage) return;
    const {time} = this, shares = this.mode === 'assembly' ? [0, 0.1, 0.2, 0.3, 0.45, 0.6, 0.75, 1] : this.fading ? [0] : [0, 1];
    const boxes = shares.flatMap(share => {
      this.time = share * this.line.duration;
      this.place();
      return this.parts.boxes(() => true);
    });
    this.time = time;
    this.place();
    this.stage.fit(boxes, {fly, from: fly ? null : 'corner', margin: this.mode === 'disassembly' && this.fading ? 1.3 : 1.08});
  }
}
