import {timeOfPose} from './plan/animation.js';

// window.dismantle: the interface for tests and scripts. Names are part names, times are seconds, points are input coordinates.
export function expose(app, display) {
  const {model} = app;
  const index = name => {
    if (!model.index.has(name)) throw new Error(`there is no part ${name}`);
    return model.index.get(name);
  };
  const now = () => { if (app.stale) app.place(); };
  window.dismantle = {
    plan: model.plan,
    shapes: model.shapes.length,
    webgl: app.stage !== null,
    drawn: false,
    loadedAfter: null,  // ms from the start of navigation to the first picture
    partNames: () => model.parts.map(p => p.name),
    duration: (mode = app.mode) => model.lines[mode].duration,
    /** Time at which pose `k` (of plan.json) of step `step` (index in the plan) is reached. */
    timeOf: (mode, step, k) => timeOfPose(model.lines[mode].steps.find(s => s.step === stepsOf(mode)[step]), k),
    /** Pose [x, y, z, qw, qx, qy, qz] as defined in docs/plan-format.md. */
    poseOf: (name, time, mode = app.mode) => Array.from(model.poseOf(index(name), mode, time, new Float64Array(7))),
    /** Position at which a point of a part is drawn now. */
    shownPoint: (name, point) => { now(); return app.parts.shownPoint(index(name), point); },
    opacity: name => app.opacity(index(name)),
    colour: name => model.colour(index(name), app.colours),
    /** The pose of the assembly in the scene, about its middle: how it lies. */
    lies: () => { now(); return Array.from(app.lies); },
    state: () => ({mode: app.mode, time: app.time, step: app.step, playing: app.playing, explode: app.explode, theme: display.dark ? 'dark' : 'light',
      up: app.stage?.up.toArray(), selected: app.selected < 0 ? null : model.parts[app.selected].name, best: app.best ? model.parts[app.best.index].name : null,
      trails: app.trailing, fading: app.fading, following: app.following,
      moving: [...app.moving].map(i => model.parts[i].name), held: [...app.held].map(i => model.parts[i].name)}),
    camera: () => ({position: app.stage.camera.position.toArray(), target: app.stage.controls.target.toArray()}),
    flying: () => app.stage.flight !== null,
    measured: () => app.measure.result(),
    section: () => ({axis: app.section.axis, share: app.section.share, flipped: app.section.flipped}),
    cut: axis => app.cut(axis),
    notesYaml: () => app.notes.yaml(),
    loadNotes: yaml => app.notes.load(yaml),
    /** Where a point of a part is on the screen, CSS pixels of the scene. */
    onScreen: (name, point) => { now(); return app.stage.onScreen(app.parts.shownPoint(index(name), point).map((x, k) => x - model.origin[k])); },
    /** What falls, and the arrows of forces; null: nothing is shown of it. */
    fall: () => app.fall && {parts: [...app.fall.motions.keys()].map(i => model.parts[i].name), arrows: app.forces.shown(), seconds: app.fall.seconds},
    /** Stops the falling motion at a time, for pictures. */
    fallAt: seconds => { app.fall.seconds = seconds; app.place(); },
    places: () => app.places.shown(),
    tools: () => { now(); return app.tools.shown(); },
    seek: time => app.seek(time),
    play: on => app.play(on),
    setMode: mode => app.setMode(mode),
    explode: share => app.setExplode(share),
    setFading: on => app.setFading(on),
    select: name => app.select(name === null ? -1 : index(name)),
    box: name => { const {lo, hi} = model.parts[index(name)]; return [lo.slice(), hi.slice()]; },
    offset: name => Array.from(model.offsets[index(name)]),
    fit: () => app.fit(false),
    view: from => app.stage.fit(app.parts.boxes(i => app.opacity(i) > 0), {from, fly: false}),
    info: () => app.stage.renderer.info,
  };
  const stepsOf = mode => mode === 'disassembly' ? model.plan.disassembly : model.plan.assembly_steps;
  const done = () => {
    window.dismantle.drawn = true;
    window.dismantle.loadedAfter = performance.now();
  };
  // The first picture is drawn in the next frame and is visible when the following frame begins.
  requestAnimationFrame(() => requestAnimationFrame(done));
}
