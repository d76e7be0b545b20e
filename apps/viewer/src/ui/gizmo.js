// Shows the directions of the input's axes. A click on an axis makes the camera look along it.
import {transform} from '../plan/screw.js';

const NAMES = ['X', 'Y', 'Z'], COLOURS = ['#e5484d', '#30a46c', '#3e7bfa'];
const SVG = 'http://www.w3.org/2000/svg';

export function makeGizmo(app) {
  const axis = new Float64Array(3), turn = new Float64Array(7);
  /** The direction in the scene of one of the input: the assembly may lie otherwise than drawn. */
  const turned = (out, direction) => {
    for (let k = 3; k < 7; ++k) turn[k] = app.lies[k];
    return transform(out, turn, 0, direction);
  };
  const svg = document.createElementNS(SVG, 'svg');
  svg.setAttribute('viewBox', '-40 -40 80 80');
  svg.setAttribute('class', 'gizmo');
  svg.setAttribute('role', 'group');
  svg.setAttribute('aria-label', 'Axes');
  const axes = NAMES.map((name, k) => {
    const line = document.createElementNS(SVG, 'line'), ball = document.createElementNS(SVG, 'circle');
    const text = document.createElementNS(SVG, 'text'), group = document.createElementNS(SVG, 'g');
    line.setAttribute('stroke', COLOURS[k]);
    ball.setAttribute('r', 9);
    ball.setAttribute('fill', COLOURS[k]);
    text.textContent = name;
    group.append(line, ball, text);
    group.addEventListener('click', () => {
      const from = [0, 0, 0];
      from[k] = 1;
      turned(from, from);
      // A view along the up axis would leave the camera's up direction undefined.
      const up = app.stage.up;
      if (Math.abs(from[0] * up.x + from[1] * up.y + from[2] * up.z) > 0.999) {
        const front = up.clone().set(0, -1e-3, 0).applyQuaternion(app.stage.upright).toArray();
        for (let i = 0; i < 3; ++i) from[i] += front[i];
      }
      app.fit(true, 1.2, from);
    });
    svg.append(group);
    return {line, ball, text, group};
  });
  const draw = camera => {
    const m = camera.matrixWorldInverse.elements;
    const ends = axes.map((_, k) => {
      axis.fill(0);
      axis[k] = 1;
      const [x, y, z] = turned(axis, axis), row = r => m[r] * x + m[4 + r] * y + m[8 + r] * z;
      return {k, x: 27 * row(0), y: -27 * row(1), z: row(2)};
    });
    for (const {k, x, y} of ends) {
      axes[k].line.setAttribute('x2', x.toFixed(1));
      axes[k].line.setAttribute('y2', y.toFixed(1));
      for (const node of [axes[k].ball, axes[k].text]) node.setAttribute('transform', `translate(${x.toFixed(1)} ${y.toFixed(1)})`);
    }
    ends.sort((a, b) => a.z - b.z);
    const order = ends.map(e => e.k).join('');
    if (svg.dataset.order !== order) {
      svg.dataset.order = order;
      for (const {k} of ends) svg.append(axes[k].group);
    }
  };
  app.stage.onView = draw;
  return svg;
}
