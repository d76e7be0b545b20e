// The panel beside the scene: the plan, its result, and the lists.
import {counted, isBad, titleOf} from '../plan/words.js';
import {makeAbout} from './about.js';
import {element} from './dom.js';
import {makePartList} from './partlist.js';
import {makeProblems} from './problems.js';
import {makeSteps} from './steps.js';

/** Of a page that shows one pile: does it stand? Without steps, the note says it in its first sentence. */
function pileSummary(plan, {falls, text}) {
  return element('div.summary', {}, element(`span.pill.${falls.length > 0 ? 'bad' : 'good'}`, {}, text.slice(0, text.indexOf('.'))),
    element('span', {}, counted(plan.assembly.parts.length, 'part')));
}

function summary(model) {
  const {plan, result} = model, pile = model.statics('disassembly', -1);
  if (plan.disassembly.length === 0 && pile) return pileSummary(plan, pile);
  const forced = plan.disassembly.filter(isBad).length;
  const [word, ...words] = result.text.split(': ');
  return element('div.summary', {}, element(`span.pill.${result.word === 'complete' ? 'good' : 'bad'}`, {}, word[0].toUpperCase() + word.slice(1)),
    element('span', {}, `${counted(plan.assembly.parts.length, 'part')}, ${counted(plan.disassembly.length, 'step')}: ${words.join(': ')}`), forced > 0 ? element('span.pill.bad', {}, `${counted(forced, 'step')} not verified`) : null);
}

export function makePanel(app) {
  const {plan} = app.model, problems = makeProblems(app);
  const tabs = [['steps', 'Steps', makeSteps(app)], ['parts', 'Parts', makePartList(app)],
    ...problems ? [['problems', 'Problems', problems.pane]] : [], ['about', 'Summary', makeAbout(app)]];
  const buttons = tabs.map(([key, words]) => element('button', {type: 'button', role: 'tab', id: `tab-${key}`, 'aria-controls': `pane-${key}`,
    onclick: () => open(key)}, words, key === 'problems' ? element('span.badge', {}, String(problems.count)) : null));
  tabs.forEach(([key, , pane]) => {
    pane.id = `pane-${key}`;
    pane.setAttribute('role', 'tabpanel');
    pane.setAttribute('aria-labelledby', `tab-${key}`);
  });
  function open(key) {
    tabs.forEach(([name, , pane], i) => {
      pane.hidden = name !== key;
      buttons[i].setAttribute('aria-selected', String(name === key));
    });
  }
  open(plan.disassembly.length === 0 && problems && !app.model.statics(app.mode, -1) ? 'problems' : 'steps');
  app.openTab = open;
  return element('aside.panel', {}, element('header.top', {}, element('h1', {title: plan.assembly.source}, titleOf(plan)), summary(app.model)),
    element('div.tabs', {role: 'tablist'}, buttons), tabs.map(([, , pane]) => pane));
}
