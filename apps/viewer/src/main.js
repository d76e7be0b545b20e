// Entry point: reads the data in the page, builds the user interface, and starts.
import {App} from './app.js';
import {readPage} from './data.js';
import {expose} from './expose.js';
import {Model} from './model.js';
import {titleOf} from './plan/words.js';
import {Forces} from './scene/forces.js';
import {Measure} from './scene/measure.js';
import {Parts} from './scene/parts.js';
import {Picker} from './scene/picker.js';
import {Places} from './scene/places.js';
import {Section} from './scene/section.js';
import {Stage} from './scene/stage.js';
import {Tools} from './scene/tools.js';
import {Trails} from './scene/trails.js';
import {followAddress} from './ui/address.js';
import {element} from './ui/dom.js';
import {makeGizmo} from './ui/gizmo.js';
import {makeHelp} from './ui/help.js';
import {makeInspect} from './ui/inspect.js';
import {listen} from './ui/keyboard.js';
import {Notes} from './ui/notes.js';
import {makeOverlay} from './ui/overlay.js';
import {makePanel} from './ui/panel.js';
import {Display, makeTools} from './ui/display.js';
import {makeTransport} from './ui/transport.js';

const MANY = 40, VERY_MANY = 90;  // steps from which playback begins faster

function fail(title, ...words) {
  document.body.replaceChildren(element('main.failure', {}, element('h1', {}, title), words.map(w => element('p', {}, w))));
}

/** Makes the scene; null, and a message, when the browser cannot draw it. */
function makeScene(app, view) {
  let stage;
  try {
    stage = new Stage(view, app.model.size);
  } catch (error) {
    console.warn(`no WebGL: ${error.message}`);
    view.append(element('div.nowebgl', {role: 'alert'}, element('h2', {}, 'This browser cannot draw in 3D'),
      element('p', {}, 'WebGL 2 is missing or turned off. Turn on hardware acceleration in the settings, or open this file in another browser.'),
      element('p', {}, 'The steps, the parts and the problems of the plan are listed all the same.')));
    return null;
  }
  stage.renderer.domElement.addEventListener('webglcontextlost', event => {
    event.preventDefault();
    view.append(element('div.nowebgl', {role: 'alert'}, element('h2', {}, 'The graphics driver gave up'), element('p', {}, 'Reload the page to draw again.')));
  });
  return stage;
}

function start() {
  const page = readPage(document);
  if (page === null) {
    fail('There is no plan in this page', 'This is the template that `dismantle plan` and `dismantle view` fill.');
    return;
  }
  const app = new App(new Model(page)), display = new Display(app);
  app.notes = new Notes(app);
  document.title = `${titleOf(page.plan)} · Dismantle`;
  const steps = page.plan.disassembly.length;
  app.speed = steps >= VERY_MANY ? 4 : steps >= MANY ? 2 : 1;
  display.apply();

  const help = makeHelp(), overlay = makeOverlay(app), view = element('div.view');
  const scene = element('main.scene', {}, view);
  document.body.replaceChildren(element('div.page', {}, scene, makeTransport(app), makePanel(app)), help);
  const stage = makeScene(app, view);
  if (stage) {
    if (display.up[2] !== 1) stage.setUp(display.up);
    const parts = new Parts(app.model, stage.scene);
    app.show(stage, parts, new Trails(app.model, stage.scene), new Places(app.model, stage.scene), new Tools(app.model, stage.scene), new Forces(app.model, stage.scene));
    display.apply();
    const section = new Section(stage, parts), measure = new Measure(stage, parts);
    Object.assign(app, {section, measure});
    const picker = new Picker(stage, parts, section, {
      hover: (index, x, y) => { app.hover(index); overlay.hover(index, x, y); },
      choose: hit => { if (measure.on) app.measureAt(hit); else app.select(hit ? hit.object.userData.index : -1); },
    });
    stage.renderer.domElement.addEventListener('dblclick', event => {
      const index = picker.partAt(event);
      if (index >= 0) stage.fit(parts.boxes(i => i === index), {margin: 2});
      else app.fit();
    });
    scene.append(makeTools(app, display, () => help.showModal()), makeGizmo(app), ...overlay.nodes, makeInspect(app, section, measure));
  }
  listen(app, display, help);
  followAddress(app);
  tellFrame(app);
  expose(app, display);
}

/** A page that shows this one in a frame is told which part is selected: that of `dismantle serve` marks parts. */
function tellFrame(app) {
  if (window.parent === window || !location.protocol.startsWith('http')) return;
  app.on(what => {
    if (what === 'selection') window.parent.postMessage({dismantle: 'selection', part: app.model.parts[app.selected]?.name ?? null}, location.origin);
  });
}

try {
  start();
} catch (error) {
  console.error(error);
  fail('This page cannot be shown', `${error.message}`, 'It may be damaged: write it again with `dismantle view PLAN.json`.');
}
