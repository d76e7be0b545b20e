// Buttons over the scene for visibility and appearance.
import {element, iconButton} from './dom.js';

const THEMES = ['auto', 'light', 'dark'];
const TRAILS = ['step', 'all', 'none'];
const TRAIL_WORDS = {step: 'Paths: of this step (T)', all: 'Paths: of all steps (T)', none: 'Paths: none (T)'};

const AXES = [[0, 0, 1], [0, 1, 0], [1, 0, 0], [0, 0, -1], [0, -1, 0], [-1, 0, 0]];
const same = (a, b) => a.every((x, k) => Math.abs(x - b[k]) < 1e-9);
const axisWords = up => {
  const k = up.findIndex(x => Math.abs(x) > 1 - 1e-9);
  return k < 0 ? up.map(x => Number(x.toFixed(2))).join(', ') : (up[k] < 0 ? '-' : '') + 'XYZ'[k];
};

export class Display {
  constructor(app) {
    this.app = app;
    this.theme = 'auto';
    this.media = matchMedia('(prefers-color-scheme: dark)');
    this.media.addEventListener('change', () => this.apply());
    this.up = app.model.view.up;
  }

  get dark() {
    return this.theme === 'auto' ? this.media.matches : this.theme === 'dark';
  }

  apply() {
    document.documentElement.dataset.theme = this.dark ? 'dark' : 'light';
    const {stage, parts} = this.app;
    if (!stage) return;
    parts.setTheme(this.dark);
    stage.shade = this.dark ? 0.45 : 0.2;
    stage.ground.material.opacity = stage.shade * (1 - 0.6 * this.app.explode);
    stage.sky.intensity = this.dark ? 1.25 : 1.6;
    stage.invalidate(true);
  }

  nextTheme() {
    this.theme = THEMES[(THEMES.indexOf(this.theme) + 1) % THEMES.length];
    this.apply();
    this.app.tell('display');
  }

  /** The next of: what the plan says, then the axes. */
  turnUp() {
    const all = [this.app.model.view.up, ...AXES].filter((a, k, list) => list.findIndex(b => same(a, b)) === k);
    this.up = all[(all.findIndex(a => same(a, this.up)) + 1) % all.length];
    this.app.stage?.setUp(this.up);
    if (this.app.stage) this.app.place();
    this.app.settle();
    this.app.stage?.fit(this.app.parts.boxes(i => this.app.opacity(i) > 0), {fly: false, from: 'corner', margin: 1.3});
    this.app.tell('display');
  }

  ground() {
    const {stage} = this.app;
    if (!stage) return;
    stage.groundOn = !stage.groundOn;
    stage.invalidate();
    this.app.tell('display');
  }

  nextTrails() {
    this.app.setTrails(TRAILS[(TRAILS.indexOf(this.app.trailing) + 1) % TRAILS.length]);
  }

  nextColours() {
    if (this.app.model.hasColours) this.app.setColours(this.app.colours === 'given' ? 'order' : 'given');
  }
}

export function makeTools(app, display, help) {
  const fit = iconButton('fit', 'Fit into view (F)', () => app.fit());
  const follow = iconButton('follow', '', () => app.setFollowing(!app.following));
  const trails = iconButton('trails', TRAIL_WORDS.step, () => display.nextTrails());
  const fade = iconButton('fade', '', () => app.setFading(!app.fading));
  const tools = iconButton('tool', '', () => app.setTools(!app.tools.on));
  const colours = iconButton('colours', '', () => display.nextColours());
  const up = iconButton('up', '', () => display.turnUp());
  const ground = iconButton('ground', '', () => display.ground());
  const cut = iconButton('section', '', () => app.cut()), ruler = iconButton('measure', '', () => app.measuring());
  const theme = iconButton('theme', '', () => display.nextTheme());
  const show = iconButton('help', 'Keyboard and mouse (?)', help);
  const name = (button, title) => { button.title = title; button.setAttribute('aria-label', title.replace(/ \(.*\)$/, '')); };
  colours.hidden = !app.model.hasColours;
  tools.hidden = !app.model.hasTools;
  const refresh = () => {
    name(follow, app.following ? 'The camera follows the step (V)' : 'The camera stays (V)');
    follow.classList.toggle('on', app.following);
    name(trails, TRAIL_WORDS[app.trailing]);
    trails.classList.toggle('off', app.trailing === 'none');
    name(fade, app.fading ? 'Parts that are out vanish (R)' : 'Parts that are out stay (R)');
    fade.classList.toggle('on', app.fading);
    name(tools, app.tools.on ? 'The tools of the step: shown (W)' : 'The tools of the step: hidden (W)');
    tools.classList.toggle('on', app.tools.on);
    name(colours, app.colours === 'given' ? 'Colours: of the parts (C)' : 'Colours: by order (C)');
    name(up, `Up is ${axisWords(display.up)} (U)`);
    name(ground, app.stage?.groundOn === false ? 'Shadow on the ground: off (G)' : 'Shadow on the ground: on (G)');
    name(cut, app.section?.axis ? `Section across ${app.section.axis.toUpperCase()} (S)` : 'Section (S)');
    cut.classList.toggle('on', Boolean(app.section?.axis));
    name(ruler, 'Measure (M)');
    ruler.classList.toggle('on', Boolean(app.measure?.on));
    name(theme, `Theme: ${display.theme} (L)`);
  };
  app.on(what => { if (what === 'display' || what === 'colours') refresh(); });
  refresh();
  return element('nav.tools', {'aria-label': 'View'}, fit, follow, trails, fade, tools, colours, cut, ruler, ground, up, theme, show);
}
