// Overlays of the scene: the name under the pointer, the selected part, and a note if a pose is that of a failed attempt.
import {listed} from '../plan/words.js';
import {element, icon, iconButton, swatch} from './dom.js';

export function makeOverlay(app) {
  const {model} = app;
  const tip = element('div.tip', {hidden: true});
  const card = element('div.selected', {hidden: true});
  const banner = element('div.banner', {hidden: true});

  function showCard() {
    const i = app.selected;
    card.hidden = i < 0;
    if (i < 0) return;
    const {name} = model.parts[i], step = model.stepOf(i), unsolved = model.unsolved.has(i);
    const on = (flag, button) => { button.setAttribute('aria-pressed', String(Boolean(flag))); return button; };
    card.replaceChildren(...[swatch(model.colour(i, app.colours)), element('strong.name', {title: name}, name),
      unsolved ? element('button.chip.bad', {type: 'button', onclick: () => app.openTab('problems')}, 'stuck: why?')
        : step >= 0 ? element('button.chip', {type: 'button', title: 'Go to the step that takes it out', onclick: () => { if (app.mode !== 'disassembly') app.setMode('disassembly'); app.goToStep(step, true); }}, `out in step ${model.lines.disassembly.steps[step].step.step}`)
        : element('span.state', {}, 'stays'),
      on(app.clear.has(i), iconButton('ghost', 'Transparent or solid (X)', () => app.toggle('clear', i))),
      on(app.isolated?.has(i), iconButton('isolate', 'Isolate (I)', () => app.isolate(app.isolated ? null : new Set([i])))),
      on(app.hidden.has(i), iconButton(app.hidden.has(i) ? 'eyeoff' : 'eye', 'Hide or show (H)', () => app.toggle('hidden', i))),
      iconButton('close', 'Select nothing (Esc)', () => app.select(-1))]);
  }

  /** What the arrows are, and what falls. */
  function showFall() {
    const {fall} = app, kinds = new Set(fall.arrows.map(a => a.kind)), key = (kind, words) => kinds.has(kind) ? element(`span.force.${kind}`, {}, words) : null;
    const names = [...fall.motions.keys()].map(i => model.parts[i].name);
    const words = names.length > 0 ? `Without a hand ${listed(names, 3)} ${names.length > 1 ? 'fall' : 'falls'}: how it begins.` : fall.text;
    banner.replaceChildren(icon(names.length > 0 ? 'warning' : 'check'), element('span', {title: fall.text}, words),
      ...[key('weight', 'weight'), key('contact', 'contact'), key('hold', 'hand')].filter(Boolean),
      element('button.chip', {type: 'button', onclick: () => app.leaveFall()}, 'Back'));
  }

  function showBanner() {
    banner.hidden = !app.best && !app.fall;
    if (app.fall) return showFall();
    if (!app.best) return;
    const {unsolved} = app.best;
    const blocked = unsolved.blocked_by.length > 0 ? `, blocked by ${unsolved.blocked_by.slice(0, 3).join(', ')}${unsolved.blocked_by.length > 3 ? ' and others' : ''}` : '';
    banner.replaceChildren(icon('warning'), element('span', {}, model.reach.get(app.best.index).moved
      ? `${unsolved.part}: the pose that came furthest${blocked}. Drawn straight, not along a path that was checked.` : `${unsolved.part} did not move${blocked}.`),
      element('button.chip', {type: 'button', onclick: () => app.leaveBest()}, 'Back'));
  }

  app.on(what => {
    if (what === 'selection' || what === 'seen' || what === 'colours') showCard();
    if (what === 'best' || what === 'fall') showBanner();
  });

  return {nodes: [banner, card, tip], hover(index, x, y) {
    tip.hidden = index < 0;
    if (index < 0) return;
    tip.textContent = model.parts[index].name;
    const box = tip.parentElement.getBoundingClientRect();
    tip.style.left = `${Math.min(x - box.left + 14, box.width - 120)}px`;
    tip.style.top = `${y - box.top + 14}px`;
  }};
}
