// Tools that look closer: a section plane, and distances.
import {lengthWords, number} from '../plan/words.js';
import {element, iconButton} from './dom.js';

const AXES = [null, 'x', 'y', 'z'];

/** Sets up `app.cut()` and `app.measuring()`; returns their panels. */
export function makeInspect(app, section, measure) {
  const {plan} = app.model;
  const cut = element('div.card', {hidden: true}), ruler = element('div.card', {hidden: true, role: 'status'});

  const place = element('input.slider', {type: 'range', min: 0, max: 1, step: 0.002, value: 0.5, 'aria-label': 'Place of the section',
    oninput: () => { section.set({share: Number(place.value)}); words(); }});
  const where = element('span.state', {});
  const words = () => { where.textContent = section.axis ? `${section.axis.toUpperCase()} = ${lengthWords(section.at(), plan)}` : ''; };
  const buttons = ['x', 'y', 'z'].map(axis => element('button', {type: 'button', onclick: () => app.cut(axis)}, axis.toUpperCase()));
  cut.append(element('strong', {}, 'Section'), element('div.segmented', {role: 'group', 'aria-label': 'Axis'}, buttons), place, where,
    element('button.chip', {type: 'button', onclick: () => section.set({flipped: !section.flipped})}, 'Other half'),
    iconButton('close', 'No section (S)', () => app.cut(null)));

  app.cut = (axis = AXES[(AXES.indexOf(section.axis) + 1) % AXES.length]) => {
    section.set({axis});
    cut.hidden = axis === null;
    buttons.forEach((button, k) => button.setAttribute('aria-pressed', String('xyz'[k] === axis)));
    words();
    app.tell('display');
  };

  function show() {
    const {ends} = measure, result = measure.result();
    const names = ends.map(({index, kind}) => `${app.model.parts[index].name}${kind === 'surface' ? '' : ` (${kind})`}`);
    ruler.replaceChildren(...result
      ? [element('strong', {}, lengthWords(result.distance, plan)), element('span', {}, result.along.map((x, k) => `${'XYZ'[k]} ${number(x)}`).join(', ')),
        element('span.state', {}, names.join(' to '))]
      : [element('strong', {}, 'Measure'), element('span', {}, ends.length === 0 ? 'Click a point of a part' : `From ${names[0]}: click the other point`)],
    iconButton('close', 'Stop measuring (M)', () => app.measuring(false)));
  }

  app.measuring = (on = !measure.on) => {
    measure.on = on;
    measure.clear();
    ruler.hidden = !on;
    show();
    app.tell('display');
  };
  app.measureAt = hit => {
    if (!hit) return;
    measure.pick(hit);
    show();
  };
  app.on(what => {
    if (!measure.on || measure.ends.length === 0) return;
    if (what === 'time' || what === 'explode') requestAnimationFrame(() => { if (app.stale) app.place(); measure.show(); show(); });
  });
  app.on(what => { if (section.axis && (what === 'seen' || what === 'step' || what === 'best')) requestAnimationFrame(() => section.apply()); });
  return element('div.inspect', {}, cut, ruler);
}
