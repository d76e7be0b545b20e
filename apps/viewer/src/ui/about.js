// The summary: what was checked, not checked and assumed, and the figures of the plan.
import {counted, number, seconds, share} from '../plan/words.js';
import {objectiveText} from '../plan/checks.js';
import {element, icon} from './dom.js';

/** Lines of the account, which come with the page. */
const account = (kind, title, sign, lines) => lines.length === 0 ? null : element(`section.account.${kind}`, {}, element('h2', {}, icon(sign), title),
  element('ul', {}, lines.map(line => element('li', {}, line))));

const CONTACTS = {clearance: 'clearance', kissing: 'touching', uniform_interference: 'of one depth, as in a press fit or a thread',
  local_interference: 'in a small place, as in a snap fit', duplicate: 'twice the same', inside: 'one inside the other'};

export function makeAbout(app) {
  const {checked, not_checked: open, assumed, order} = app.model.view.account;
  const {plan} = app.model, {assembly} = plan, rows = [];
  const row = (name, ...value) => rows.push(element('dt', {}, name), element('dd', {}, ...value));
  const worst = Math.max(0, ...plan.disassembly.map(s => s.max_penetration));
  const total = plan.disassembly.reduce((sum, s) => sum + s.seconds, 0);
  row('assembly', assembly.source);
  row('parts', `${assembly.parts.length}, ${plan.remaining.length} stay`);
  row('result', app.model.result.text);
  if (assembly.excluded.length > 0) row('left out', assembly.excluded.map(e => `${e.name}: ${e.reason}`).join('; '));
  row('steps', `${plan.disassembly.length}, found in ${seconds(total)}`);
  const layers = Math.max(0, ...plan.disassembly.map(s => s.layer ?? 0));
  if (layers > 0) row('layers', `${layers} (steps of one layer do not wait for each other)`);
  row('putting together', {complete: 'each part is brought from the layout', partial: 'some parts are not brought from the layout',
    reversed: 'the disassembly backwards'}[plan.assembly_status] ?? 'not planned');
  row('deepest', `no step cuts in deeper than ${share(worst, plan)} of the size (${number(worst)} of ${number(plan.verified_max_penetration)} units allowed)`);
  const objective = objectiveText(plan);
  if (objective) row('objective', objective);
  const box = assembly.bbox;
  if (box) row('size', box[1].map((x, k) => number(x - box[0][k])).join(' × ') + ` ${assembly.unit ?? 'input units'}`);
  row('units', `${number(assembly.scale)} assembly units per input unit`);
  row('made by', `${plan.generator.name} ${plan.generator.version}, seed ${plan.seed}`);
  row('input', element('code', {}, assembly.sha256));
  const overlaps = assembly.overlaps.slice().sort((a, b) => b.depth - a.depth);
  const why = element('div', {});
  const showWhy = () => why.replaceChildren(account('plain', 'Why this order', 'help', order[app.mode]));
  app.on(what => { if (what === 'mode') showWhy(); });
  showWhy();
  return element('div.pane', {}, why, account('good', 'Checked', 'check', checked), account('warn', 'Not checked', 'warning', open),
    account('plain', 'Assumed', 'help', assumed), element('dl.facts.wide', {}, rows),
    overlaps.length === 0 ? null : element('details', {}, element('summary', {}, `${counted(overlaps.length, 'pair')} overlap when assembled`),
      element('p.note', {}, 'Usual in CAD: allowed as it was, for this pair alone.'),
      element('ul.plain', {}, overlaps.map(o => element('li', {}, `${o.a} and ${o.b}: ${share(o.depth, plan)} of the size${o.class ? `, ${CONTACTS[o.class] ?? o.class}` : ''}`)))));
}
