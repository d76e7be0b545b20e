// The list of steps: moving parts, holds, what to do. A click seeks to the step.
import {verdictRows, verdictsOf} from '../plan/checks.js';
import {forcedWords, isBad, lengthWords, number, seconds, share} from '../plan/words.js';
import {addressOfStep} from './address.js';
import {element, icon, swatch} from './dom.js';
import {makeNote} from './notes.js';
import {printStep} from './print.js';

let detailsOpen = false;  // for all steps alike

/** What to do in a step, and behind "Details" how it was found and checked. */
function facts(app, index) {
  const {step} = app.line.steps[index], {plan} = app.model, rows = [], details = [];
  const put = to => (name, ...value) => to.push(element('dt', {}, name), element('dd', {}, ...value));
  const row = put(rows), detail = put(details);
  const {lies_words: lies, turned, threads = [], order} = app.model.about(app.mode, index);
  if (turned) row('first', 'turn the assembly');
  if (lies) row('lies', lies);
  const held = app.model.held(app.mode, index);
  if (held.length > 0) row('hold', element('span.chips', {}, held.map(i => element('button.chip.held', {type: 'button', onclick: () => app.select(i),
    onmouseenter: () => app.hover(i), onmouseleave: () => app.hover(-1)}, app.model.parts[i].name))));
  const verdicts = verdictRows(verdictsOf(plan, step, app.mode));
  for (const [name, text] of verdicts) if (name === 'note' || name === 'not allowed') row(name, text);
  for (const words of threads) row('note', `${words}.`);
  if (step.moves.length > 1) row('moves', step.moves.map(m => m.part).join(', '));
  if (step.separates?.some(g => g.length > 1)) row('group', step.separates.filter(g => g.length > 1).map(g => g.join(', ')).join(' | '));
  if (step.forced) row('forced', forcedWords(step.forced, plan));
  const {how_far: far} = app.model.about(app.mode, index);
  if (far) row('how far', `${far}.`);
  if (step.contacts?.length > 0) row('touches', step.contacts.join(', '));
  if (order) row('order', `${order}.`);
  if (step.max_penetration !== undefined && !step.forced)
    detail('cuts in', `at most ${number(step.max_penetration)} of ${number(plan.verified_max_penetration)} units allowed (${share(step.max_penetration, plan)} of the size)`);
  if (step.clearance !== undefined) detail('clearance', `${number(step.clearance)} units`);
  if (step.planner) detail('found by', `${step.planner}${step.depth ? `, ${step.depth} action${step.depth === 1 ? '' : 's'}` : ''}, in ${seconds(step.seconds ?? 0)}`);
  for (const o of step.overlaps ?? [])
    detail('overlap', `${o.pair.join(' and ')}: ${lengthWords(o.assembled, plan)} when assembled, up to ${number(o.depth)} along the way${o.at ? `, at ${o.at.map(number).join(', ')}` : ''}${o.region ? '; only where they overlap when assembled' : ''}`);
  for (const [name, text] of verdicts) if (name !== 'note' && name !== 'not allowed') detail(name, text);
  const here = addressOfStep(app.mode, step.step), picture = app.model.statics(app.mode, index);
  return element('div.facts-of', {}, rows.length > 0 ? element('dl.facts', {}, rows) : null,
    element('div.chips', {}, element('a.chip', {href: here, title: 'The address of this step'}, icon('link'), here),
      element('button.chip', {type: 'button', title: 'Print this step (P)', onclick: () => printStep(app)}, icon('print'), 'Print')),
    element('div.chips', {}, far ? element('button.chip', {type: 'button', onclick: () => app.showReached(index)}, icon('eye'), 'Show how far it comes') : null,
      picture ? fallButton(app, picture) : null),
    makeNote(app, step),
    element('details', {open: detailsOpen}, element('summary', {onclick: event => { detailsOpen = !event.currentTarget.parentElement.open; }}, 'Details'), element('dl.facts', {}, details)));
}

/** Plays what falls, and shows the forces on what is held; stops it again. */
function fallButton(app, {falls}) {
  const words = falls.length > 0 ? 'Show what falls without hands' : 'Show the forces';
  return element('button.chip.fall', {type: 'button', title: `${words} (D)`, 'aria-pressed': String(Boolean(app.fall)), onclick: () => app.fall ? app.leaveFall() : app.showFall()}, words);
}

/** The line of a run: "3–6  4x screw". A click shows its steps, or hides them. */
function makeRun(app, {first, count, words}) {
  const {steps} = app.line, inner = element('ol', {hidden: true});
  const line = element('button.step', {type: 'button', 'aria-expanded': 'false', title: 'Show or hide these steps', onclick: () => run.toggle()},
    element('span.count', {}, `${steps[first].step.step}–${steps[first + count - 1].step.step}`),
    element('span.swatches', {}, swatch(app.model.colour(steps[first].parts[0], app.colours))), element('span.title', {}, words), element('span.more', {}));
  const run = {node: element('li.run', {}, line, inner), inner, chosen: false, has: false,
    toggle() { run.chosen = inner.hidden; run.has = false; run.show(); },
    /** Open as long as the user chose so, or the current step is one of these. */
    show() {
      inner.hidden = !run.chosen && !run.has;
      line.setAttribute('aria-expanded', String(!inner.hidden));
      run.node.classList.toggle('expanded', !inner.hidden);
    }};
  return run;
}

export function makeSteps(app) {
  const list = element('ol.steps', {'aria-label': 'Steps'});
  let items = [], runs = [], runOf = [], open = -1;

  function make() {
    items = app.line.steps.map((entry, index) => {
      const {step, parts} = entry;
      const colours = element('span.swatches', {}, parts.slice(0, 3).map(i => swatch(app.model.colour(i, app.colours))));
      const names = element('span.name', {}, step.moves.map(m => m.part).join(', '));
      const button = element('button.step', {type: 'button', title: 'Go to this step',
        onclick: () => { app.goToStep(index); if (parts.length === 1) app.select(parts[0]); }},
        element('span.count', {}, String(step.step)), colours, names,
        app.model.held(app.mode, index).length > 0 ? element('span.pill.held', {}, 'hold') : null,
        element('span.pill.noted', {title: 'You have a note on this step'}, 'note'),
        step.forced ? element(`span.pill${isBad(step) ? '.bad' : ''}`, {}, isBad(step) ? 'forced' : step.forced.accepted) : null);
      return element('li', {}, button);
    });
    runs = [];
    runOf = items.map(() => null);
    for (const told of app.model.runs(app.mode)) {
      const run = makeRun(app, told);
      runs.push(run);
      for (let i = told.first; i < told.first + told.count; ++i) {
        runOf[i] = run;
        run.inner.append(items[i]);
      }
    }
    list.replaceChildren(...new Set(items.map((item, i) => runOf[i]?.node ?? item)));
    open = -1;
    markNotes();
    mark();
  }

  function mark() {
    if (open >= 0 && items[open]) {
      items[open].classList.remove('open');
      items[open].querySelector('.facts-of')?.remove();
    }
    open = app.step;
    for (const run of runs) {
      run.has = runOf[open] === run;
      run.show();
    }
    const item = items[open];
    if (!item) return;
    item.classList.add('open');
    item.append(facts(app, open));
    if (list.offsetParent !== null) follow(item);
  }

  /** Scrolls the list, not the page. */
  function follow(item) {
    const box = list.parentElement, top = item.offsetTop - box.offsetTop;
    if (box.scrollHeight <= box.clientHeight) return;
    if (top < box.scrollTop || top + item.offsetHeight > box.scrollTop + box.clientHeight) box.scrollTop = top - box.clientHeight / 3;
  }

  const markNotes = () => items.forEach((item, i) => { item.querySelector('.noted').hidden = app.notes.of(app.line.steps[i].step) === ''; });
  app.on(what => {
    if (what === 'mode' || what === 'colours') make();
    if (what === 'notes') markNotes();
    if (what === 'step') mark();
    if (what === 'fall') for (const button of pane.querySelectorAll('.fall')) button.setAttribute('aria-pressed', String(Boolean(app.fall)));
  });
  const pane = element('div.pane', {});
  make();
  const note = element('p.note', {});
  const showNote = () => {
    const {plan} = app.model;
    note.textContent = app.mode === 'assembly' && plan.assembly_message ? plan.assembly_message
      : app.mode === 'assembly' && plan.assembly_status === 'reversed' ? 'The disassembly played backwards: no layout was asked for.' : '';
    note.hidden = note.textContent === '';
  };
  app.on(what => { if (what === 'mode') showNote(); });
  showNote();
  const pile = app.model.statics(app.mode, -1), none = app.model.plan.disassembly.length === 0;
  pane.append(...[note, pile ? element('article.card', {}, element('p', {}, pile.text), element('div.chips', {}, fallButton(app, pile))) : null,
    none && !pile ? element('p.note', {}, 'No part came out: there are no steps.') : null, list].filter(Boolean));
  return pane;
}
