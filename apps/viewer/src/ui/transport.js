// Play, pause and scrub: the bar below the scene, and a caption for the current step.
import {clock, counted, isBad, listed, shareOfSize} from '../plan/words.js';
import {element, icon, iconButton} from './dom.js';

const SPEEDS = [0.5, 1, 2, 4, 8];

/** Caption of a step. */
export function captionOf(app, index) {
  const {plan} = app.model, {steps} = app.line;
  if (index < 0) {
    const n = counted(plan.assembly.parts.length, 'part');
    return app.mode === 'disassembly' ? `Assembled: ${n}` : app.model.plan.assembly_status === 'reversed' ? 'Taken apart' : `Laid out: ${n}`;
  }
  const {step} = steps[index], names = step.moves.map(m => m.part);
  const several = names.length > 1;
  if (app.mode === 'assembly') return `${listed(names)} ${several ? 'go' : 'goes'} in`;
  const out = new Set((step.separates ?? []).flat());
  const leaves = names.some(n => out.has(n));
  return `${listed(names)} ${leaves ? (several ? 'come out' : 'comes out') : several ? 'are moved aside' : 'is moved aside'}`;
}

/** Caption after the last step. */
function endOf(app) {
  const {plan} = app.model;
  if (app.mode === 'assembly') return plan.assembly_status === 'partial' ? 'Put together, as far as there are paths' : 'Put together';
  const {text} = app.model.result;
  return text[0].toUpperCase() + text.slice(1);
}

export function makeTransport(app) {
  const play = iconButton('play', 'Play or pause (space)', () => app.play(), 'button.play');
  const range = element('input.scrub', {type: 'range', min: 0, max: 1, step: 'any', 'aria-label': 'Time',
    oninput: () => { app.play(false); app.seek(Number(range.value)); },
    onkeydown: e => { if (e.key.startsWith('Arrow') || e.key === 'Home' || e.key === 'End') e.preventDefault(); }});
  const strip = element('canvas.strip'), head = element('div.playhead');
  const speed = element('button.chip', {type: 'button', title: 'Speed (< and >)',
    onclick: () => app.setSpeed(SPEEDS[(SPEEDS.indexOf(app.speed) + 1) % SPEEDS.length])});
  const time = element('span.time');
  const number = element('span.number'), caption = element('span.caption'), lies = element('span.lies'), detail = element('span.detail');
  const modes = ['disassembly', 'assembly'].map(mode => element('button', {type: 'button', onclick: () => app.setMode(mode),
    title: mode === 'disassembly' ? 'Taking it apart (A)' : 'Putting it together (A)'},
    mode === 'disassembly' ? 'Take apart' : 'Put together'));
  const explode = element('input.slider', {type: 'range', min: 0, max: 1, step: 0.01, value: 0, id: 'explode',
    oninput: () => app.setExplode(Number(explode.value))});

  const bar = element('section.transport', {'aria-label': 'Playback'},
    element('div.words', {}, number, caption, lies, detail),
    element('div.bar', {}, iconButton('previous', 'Step back (left arrow)', () => app.stepBy(-1)), play,
      iconButton('next', 'Next step (right arrow)', () => app.stepBy(1)),
      element('div.track', {}, strip, head, range), time, speed),
    element('div.row', {}, element('div.segmented', {role: 'group', 'aria-label': 'Direction'}, modes),
      element('label.explode', {for: 'explode', title: 'Exploded view (E)'}, icon('explode'), element('span', {}, 'Explode'), explode)));

  /** One block per step, in the colour of the moving part; steps that are forced and not accepted are red. */
  function paintStrip() {
    const ratio = Math.min(2, window.devicePixelRatio), width = strip.clientWidth * ratio, height = strip.clientHeight * ratio;
    if (width === 0) return;
    strip.width = width;
    strip.height = height;
    const g = strip.getContext('2d'), {steps, duration} = app.line;
    for (const {step, begin, end, parts} of steps) {
      const x = begin / duration * width, w = Math.max(1, (end - begin) / duration * width);
      g.fillStyle = isBad(step) ? '#e5484d' : app.model.colour(parts[0], app.colours);
      g.beginPath();
      if (w > 6 * ratio) g.roundRect(x, 0, w, height, 2 * ratio); else g.rect(x, 0, w, height);
      g.fill();
    }
  }

  let over = false;
  function showTime() {
    const now = app.line.steps.length > 0 && app.time >= app.line.duration - 1e-6;
    if (now !== over) {
      over = now;
      showStep();
    }
    const share_ = app.line.duration > 0 ? app.time / app.line.duration : 0;
    range.value = app.time;
    head.style.setProperty('--at', share_);
    time.textContent = `${clock(app.time)} / ${clock(app.line.duration)}`;
  }

  function showStep() {
    const {steps} = app.line, at = app.step, {plan} = app.model;
    number.textContent = at < 0 ? `${counted(steps.length, 'step')}` : `Step ${at + 1} of ${steps.length}`;
    caption.textContent = over ? endOf(app) : captionOf(app, at);
    caption.title = at < 0 ? '' : steps[at].step.moves.map(m => m.part).join(', ');
    const words = steps.length > 0 ? app.model.about(app.mode, Math.max(at, 0)).lies_words : undefined;
    lies.textContent = words ? `lies: ${words}` : '';
    const forced = at < 0 ? undefined : steps[at].step.forced;
    detail.textContent = forced ? `${forced.accepted || 'forced'}: cuts in by ${shareOfSize(forced.depth, plan)} of the size` : '';
    detail.classList.toggle('bad', at >= 0 && isBad(steps[at].step));
  }

  function showPlay() {
    for (const button of bar.querySelectorAll('.bar button')) button.disabled = app.line.duration === 0;
    play.replaceChildren(icon(app.playing ? 'pause' : 'play'));
    play.classList.toggle('on', app.playing);
    speed.textContent = `${app.speed}×`;
  }

  function showMode() {
    range.max = app.line.duration;
    ['disassembly', 'assembly'].forEach((mode, i) => {
      modes[i].setAttribute('aria-pressed', String(app.mode === mode));
      modes[i].disabled = app.model.lines[mode].duration === 0;
    });
    paintStrip();
  }

  app.on(what => {
    if (what === 'time' || what === 'mode') showTime();
    if (what === 'step' || what === 'mode') showStep();
    if (what === 'play') showPlay();
    if (what === 'mode') { showMode(); showPlay(); }
    if (what === 'colours') paintStrip();
    if (what === 'explode') explode.value = app.explode;
  });
  new ResizeObserver(paintStrip).observe(strip);
  showMode(), showTime(), showStep(), showPlay();
  return bar;
}
