// Shows the directions of the input's axes. A click on an axis makes the camera look along it.
const NAMES = ['X', 'Y', 'Z'], COLOURS = ['#e5484d', '#30a46c', '#3e7bfa'];
const SVG = 'http://www.w3.org/2000/svg';

export function makeGizmo(app) {
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
      // A view along the up axis would leave the camera's up direction undefined.
      if (name.toLowerCase() === app.stage.axis) from[k === 2 ? 1 : 2] = k === 2 ? -1e-3 : 1e-3;
      app.fit(true, 1.2, from);
    });
    svg.append(group);
    return {line, ball, text, group};
  });
  const draw = camera => {
    const m = camera.matrixWorldInverse.elements;
    const ends = axes.map((_, k) => ({k, x: 27 * m[4 * k], y: -27 * m[4 * k + 1], z: m[4 * k + 2]}));
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
