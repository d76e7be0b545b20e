// Parts that did not come out: the attempts, blocking parts and places, furthest pose, proof, and advice.
import {forcedWords, isBad, lengthWords, number, outcomeTitle, seconds, sentence, share, shareOfSize} from '../plan/words.js';
import {element, icon} from './dom.js';

const TURNED = 0.05;  // degrees; smaller rotations are not reported

function link(app, name, kind = 'button.chip') {
  const index = app.model.index.get(name);
  return element(kind, {type: 'button', title: `Select ${name}`, onclick: () => app.select(index),
    onmouseenter: () => app.hover(index), onmouseleave: () => app.hover(-1)}, name);
}

/** Details of one part: the blocking parts and its furthest pose. `message`: what the planner said of this part only. */
function attempt(app, unsolved, alone, message) {
  const {model} = app, index = model.index.get(unsolved.part), {plan} = model;
  const overlaps = plan.assembly.overlaps.filter(o => o.a === unsolved.part || o.b === unsolved.part);
  const row = (name, ...value) => [element('dt', {}, name), element('dd', {}, ...value)];
  const {travel, turn_degrees: angle, moved} = model.reach.get(index);
  const far = `${lengthWords(travel, plan)} (${shareOfSize(travel, plan)} of the size)`;
  const words = moved ? 'Show how far it got' : 'Show what holds it';
  const show = element('button.primary', {type: 'button', 'aria-pressed': 'false',
    onclick: () => app.best?.index === index ? app.leaveBest() : app.showBest(index)}, words);
  app.on(what => {
    if (what !== 'best') return;
    const on = app.best?.index === index;
    show.setAttribute('aria-pressed', String(on));
    show.textContent = on ? 'Back to the assembly' : words;
  });
  return element('section.attempt', {'data-part': unsolved.part},
    alone ? null : link(app, unsolved.part, 'button.title'),
    message ? element('p.message', {}, message) : null,
    element('dl.facts', {},
      unsolved.attempts ? row('tried', tried(unsolved)) : null,
      row('blocked by', unsolved.blocked_by.length > 0 ? unsolved.blocked_by.map(n => link(app, n)) : 'nothing on record'),
      row('furthest', !moved ? 'it did not move' : angle < TURNED ? far : `${far}, turned by ${number(Number(angle.toPrecision(2)))}°`),
      unsolved.places?.length > 0 ? row('touches', unsolved.places.map(p => `${p.part} at (${p.at.map(number).join(', ')})`).join('; ')) : null,
      overlaps.length > 0 ? row('overlaps', overlaps.map(o => `${o.a === unsolved.part ? o.b : o.a} by ${number(o.depth)} units (${share(o.depth, plan)})`).join(', ')) : null),
    show);
}

/** "3 searches by guided, 12 s, to depth 4" */
function tried({planner, attempts, seconds: time, depth}) {
  return `${attempts === 1 ? '1 search' : `${attempts} searches`} by ${planner}, ${seconds(time)}${depth > 0 ? `, to depth ${depth}` : ''}`;
}

/** Renders text between backquotes as code. */
const withCode = text => text.split('`').map((piece, i) => i % 2 === 1 ? element('code', {}, piece) : piece);

function nextSteps({advice}) {
  return advice.length === 0 ? null : element('div.advice', {}, element('strong', {}, 'What you can do'),
    element('ul', {}, advice.map(text => element('li', {}, withCode(text)))));
}

/** The texts of the plan's proofs for these parts. */
function proofs(app, group) {
  const {certificates = []} = app.model.plan;
  const numbers = [...new Set(group.map(u => u.certificate).filter(n => n !== undefined && n !== null && certificates[n]))];
  return numbers.map(n => element('p.proof', {}, element('strong', {}, `Proof (${certificates[n].kind}): `), certificates[n].text));
}

/** True if the planner's message repeats the text of the proof. */
const isProof = (app, group, message) => group.some(u => app.model.plan.certificates?.[u.certificate]?.text === message);

/** Parts that share one reason. */
function card(app, reason) {
  const group = reason.parts.map(({part}) => app.model.unsolved.get(part)), [{part, outcome, message}] = group;
  const alone = group.length === 1, shared = group.every(u => u.message === message);
  return element('article.card', {}, element('header', {}, icon('warning'),
    alone ? link(app, part, 'button.title') : element('strong.title', {}, `${group.length} parts, one reason`), element('span.pill.bad', {}, outcomeTitle(outcome))),
  element('p', {}, sentence(reason.meaning)), shared && message && !isProof(app, group, message) ? element('p.message', {}, message) : null,
  proofs(app, group), group.map(u => attempt(app, u, alone, shared ? '' : u.message)), nextSteps(reason));
}

function certificate(app, c) {
  const parts = Array.isArray(c.parts) ? c.parts : [];
  const scope = c.full_tolerance === false && c.margin > 0 ? `It holds for motions that cut in by no more than ${share(c.margin, app.model.plan)} of the size.`
    : c.full_tolerance ? 'It holds for every motion within the tolerance.' : '';
  return element('article.card', {}, element('header', {}, icon('check'), element('strong', {}, `Proof: ${c.kind ?? 'certificate'}`)),
    c.text ? element('p.proof', {}, c.text) : null,
    parts.length > 0 ? element('p', {}, 'The first of these cannot be separated from the others: ', element('span.chips', {}, parts.filter(n => app.model.index.has(n)).map(n => link(app, n)))) : null,
    scope ? element('p.note', {}, withCode(`${scope} \`dismantle verify\` checks it again.`)) : null,
    c.numbers ? element('details', {}, element('summary', {}, 'Data'), element('pre', {}, Object.entries(c.numbers).map(([key, value]) => `${key}: ${JSON.stringify(value)}`).join('\n'))) : null);
}

/** How far the parts of a forced step come, and a button that shows it. */
function farOf(app, step) {
  const {how_far: far} = app.model.view.steps.disassembly[step.step - 1];
  return far ? element('p', {}, `${far}. `, element('button.chip', {type: 'button', onclick: () => {
    app.setMode('disassembly');
    app.showReached(app.line.steps.findIndex(s => s.step === step));
  }}, 'Show how far it comes')) : null;
}

/** Null when there are no problems. */
export function makeProblems(app) {
  const {plan} = app.model, certificates = Array.isArray(plan.certificates) ? plan.certificates : [];
  const silent = app.model.view.untried.map(i => app.model.parts[i].name);
  const forced = plan.disassembly.filter(isBad);
  const {excluded} = plan.assembly;
  const count = plan.unsolved.length + certificates.length + excluded.length + forced.length;
  if (count === 0 && plan.status === 'complete') return null;
  const pane = element('div.pane.problems', {},
    plan.unsolved.length > 0 ? element('p.note', {}, 'These parts should have come out and did not. The plan holds for all that did.') : null,
    app.model.view.reasons.map(reason => card(app, reason)),
    forced.map(s => element('article.card', {}, element('header', {}, icon('warning'), element('strong', {}, `Step ${s.step} is forced`)),
      element('p', {}, `${s.moves.map(m => m.part).join(', ')}: no verified path is known. It is taken out where it cuts in least. This step is not verified.`),
      element('p.bad', {}, forcedWords(s.forced, plan)), farOf(app, s), s.forced.reason ? element('p.message', {}, s.forced.reason) : null)),
    certificates.map(c => certificate(app, c)),
    silent.length > 0 ? element('article.card', {}, element('header', {}, element('strong', {}, 'Still together')),
      element('p', {}, silent.length > 1 || plan.unsolved.length > 0 ? 'No failed attempt of these is on record:' : 'Not tried:'),
      element('div.chips', {}, silent.map(n => link(app, n)))) : null,
    excluded.length > 0 ? element('article.card', {}, element('header', {}, icon('warning'), element('strong', {}, 'Left out of the plan')),
      element('dl.facts', {}, excluded.map(e => [element('dt', {}, e.name), element('dd', {}, e.reason)]))) : null);
  return {pane, count: count || silent.length};
}
