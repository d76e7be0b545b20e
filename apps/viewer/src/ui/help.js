// Help on keys and mouse.
import {element, iconButton} from './dom.js';

const KEYS = [
  ['Playback', [['Space', 'play, pause'], ['← →', 'step back, next step'], ['Shift ← →', 'a little back, a little on'], ['Home End', 'to the beginning, to the end'],
    ['< >', 'slower, faster'], ['A', 'take apart, put together']]],
  ['View', [['F', 'fit into view'], ['0', 'view from the corner'], ['1 2 3', 'view from the front, the right, the top'], ['E', 'exploded view'], ['V', 'the camera follows the step'], ['P', 'print this step'], ['W', 'the tools of the step'], ['D', 'what falls if nobody holds it'], ['S', 'section: across X, Y, Z, none'], ['M', 'measure between two points'], ['T', 'paths: of this step, of all, none'], ['R', 'parts that are out stay or vanish'],
    ['C', 'colours: of the parts, by order'], ['G', 'shadow on the ground'], ['U', 'which axis is up'], ['L', 'light, dark']]],
  ['The selected part', [['H', 'hide'], ['X', 'transparent'], ['I', 'isolate'], ['Shift H', 'show all again'], ['Esc', 'select nothing']]],
  ['Mouse and touch', [['Drag', 'turn'], ['Right drag, two fingers', 'shift'], ['Wheel, pinch', 'zoom'], ['Click', 'select a part'], ['Double click', 'zoom to a part']]],
];

export function makeHelp() {
  const dialog = element('dialog.help', {'aria-label': 'Keyboard and mouse'},
    element('header', {}, element('h2', {}, 'Keyboard and mouse'), iconButton('close', 'Close (Esc)', () => dialog.close())),
    element('div.columns', {}, KEYS.map(([title, rows]) => element('section', {}, element('h3', {}, title),
      element('dl', {}, rows.map(([keys, what]) => [
        element('dt', {}, keys.split(', ').flatMap((key, i) => i > 0 ? [' or ', element('kbd', {}, key)] : [element('kbd', {}, key)])), element('dd', {}, what)]))))));
  dialog.addEventListener('click', event => { if (event.target === dialog) dialog.close(); });
  return dialog;
}
