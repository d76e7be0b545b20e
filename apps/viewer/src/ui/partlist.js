// The list of parts: find, choose, hide, make transparent, isolate.
import {element, iconButton, icon, swatch} from './dom.js';

export function makePartList(app) {
  const {model} = app;
  const find = element('input.find', {type: 'search', placeholder: 'Find a part', 'aria-label': 'Find a part', oninput: filter});
  const all = element('button.chip', {type: 'button', title: 'Show all parts as they are (shift H)', onclick: () => app.showAll()}, 'Show all');
  const list = element('ul.parts', {'aria-label': 'Parts'});
  const order = model.parts.map(p => p.index).sort((a, b) => {
    const key = i => model.unsolved.has(i) ? -1 : model.view.rank[i] ?? 1e9;
    return key(a) - key(b) || a - b;
  });

  const open = i => model.plan.assembly.parts[i].open === true;
  const stateOf = i => (open(i) ? 'open, ' : '') + leaving(i);
  const leaving = i => model.unsolved.has(i) ? 'stuck' : model.outIn(i) ? `step ${model.outIn(i).step}` : 'stays';
  const rows = new Map();
  for (const i of order) {
    const {name} = model.parts[i];
    const dot = swatch(model.colour(i, app.colours));
    const hide = iconButton('eye', 'Hide or show (H)', () => app.toggle('hidden', i));
    const clear = iconButton('ghost', 'Transparent or solid (X)', () => app.toggle('clear', i));
    const alone = iconButton('isolate', 'Isolate (I)', () => app.isolate(app.isolated?.has(i) && app.isolated.size === 1 ? null : new Set([i])));
    const row = element('li', {'data-part': name,
      onmouseenter: () => app.hover(i), onmouseleave: () => app.hover(-1)},
      element('button.part', {type: 'button', title: open(i) ? `${name}: its surface is not closed, and is a wall` : name, onclick: () => app.select(app.selected === i ? -1 : i)}, dot,
        element('span.name', {}, name), element('span.state', {}, stateOf(i))), clear, alone, hide);
    if (model.unsolved.has(i)) row.classList.add('bad');
    rows.set(i, {row, dot, hide, clear, alone});
    list.append(row);
  }

  function filter() {
    const words = find.value.trim().toLowerCase();
    for (const [i, {row}] of rows) row.hidden = words !== '' && !model.parts[i].name.toLowerCase().includes(words);
  }

  function show() {
    for (const [i, {row, hide, clear, alone}] of rows) {
      const hidden = app.hidden.has(i) || Boolean(app.isolated && !app.isolated.has(i));
      row.classList.toggle('off', hidden);
      row.classList.toggle('on', app.selected === i);
      if (hide.dataset.off !== String(hidden)) {
        hide.dataset.off = String(hidden);
        hide.replaceChildren(icon(hidden ? 'eyeoff' : 'eye'));
      }
      hide.setAttribute('aria-pressed', String(hidden));
      clear.setAttribute('aria-pressed', String(app.clear.has(i)));
      alone.setAttribute('aria-pressed', String(Boolean(app.isolated?.has(i))));
    }
    all.disabled = app.hidden.size === 0 && app.clear.size === 0 && app.isolated === null;
  }

  app.on(what => {
    if (what === 'seen' || what === 'selection') show();
    if (what === 'selection' && app.selected >= 0 && list.offsetParent !== null) {
      const {row} = rows.get(app.selected), box = list.parentElement, top = row.offsetTop - box.offsetTop;
      if (top < box.scrollTop || top + row.offsetHeight > box.scrollTop + box.clientHeight) box.scrollTop = top - box.clientHeight / 3;
    }
    if (what === 'colours') for (const [i, {dot}] of rows) dot.style.setProperty('--colour', model.colour(i, app.colours));
  });
  show();
  return element('div.pane', {}, element('div.finder', {}, find, all), list);
}
