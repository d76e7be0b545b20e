// Print of one step: the picture as it is shown, and what the step says.
import {titleOf} from '../plan/words.js';
import {element} from './dom.js';
import {captionOf} from './transport.js';

/** Opens the browser's print dialog for a sheet that only the printer sees. */
export function printStep(app) {
  const {steps} = app.line, at = app.step;
  if (at < 0) return;
  const facts = document.querySelector('.steps li.open .facts')?.cloneNode(true);
  const {lies_words: lies} = app.model.about(app.mode, at);
  const sheet = element('section.sheet', {}, element('p', {}, `${titleOf(app.model.plan)} · ${app.mode === 'assembly' ? 'put together' : 'take apart'}`),
    element('h1', {}, `Step ${steps[at].step.step} of ${steps.length}: ${captionOf(app, at)}`), lies ? element('p', {}, `lies: ${lies}`) : null,
    app.notes.of(steps[at].step) ? element('p.own', {}, app.notes.of(steps[at].step)) : null,
    app.stage ? element('img', {alt: '', src: app.stage.picture()}) : null, facts);
  document.body.append(sheet);
  const image = sheet.querySelector('img'), show = () => {
    window.print();
    sheet.remove();
  };
  // Not decode(): a browser that draws no frame, as behind other windows, never answers it.
  if (!image || image.complete) show();
  else image.onload = image.onerror = show;
}
