// The paths of the centres of moving parts, as thick lines.
import {Group} from 'three';
import {Line2} from 'three/addons/lines/Line2.js';
import {LineGeometry} from 'three/addons/lines/LineGeometry.js';
import {LineMaterial} from 'three/addons/lines/LineMaterial.js';
import {transform} from '../plan/screw.js';

export class Trails {
  constructor(model, scene) {
    this.model = model;
    this.group = new Group();
    scene.add(this.group);
    this.made = new Map();  // by mode and step: a group, created when first shown
    this.shown = [];
  }

  #make(mode, index, scheme) {
    const {model} = this, group = new Group(), point = new Float64Array(3);
    const {step, parts} = model.lines[mode].steps[index];
    step.moves.forEach((move, m) => {
      const {center} = model.parts[parts[m]], points = [];
      for (const pose of move.poses) {
        transform(point, pose, 0, center);
        for (let k = 0; k < 3; ++k) points.push(point[k] - model.origin[k]);
      }
      const line = new Line2(new LineGeometry().setPositions(points),
        new LineMaterial({color: model.colour(parts[m], scheme), linewidth: 3, transparent: true, opacity: 0.9}));
      line.raycast = () => {};
      line.renderOrder = 4;
      group.add(line);
    });
    this.group.add(group);
    return group;
  }

  /** Shows the paths of these steps and no others. */
  show(mode, indices, scheme) {
    for (const group of this.shown) group.visible = false;
    this.shown = indices.map(index => {
      const key = `${mode} ${index} ${scheme}`;
      if (!this.made.has(key)) this.made.set(key, this.#make(mode, index, scheme));
      return this.made.get(key);
    });
    for (const group of this.shown) group.visible = true;
  }
}
