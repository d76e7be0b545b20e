// The paths of the centres of moving parts, as thick lines.
import {Group} from 'three';
import {Line2} from 'three/addons/lines/Line2.js';
import {LineGeometry} from 'three/addons/lines/LineGeometry.js';
import {LineMaterial} from 'three/addons/lines/LineMaterial.js';
import {partly} from '../plan/lies.js';
import {transform} from '../plan/screw.js';

/** p = the point that `pose` takes to p. */
function backwards(p, pose) {
  const inverse = [0, 0, 0, pose[3], -pose[4], -pose[5], -pose[6]];
  for (let k = 0; k < 3; ++k) p[k] -= pose[k];
  transform(p, inverse, 0, p);
}

export class Trails {
  constructor(model, scene) {
    this.model = model;
    this.group = new Group();
    scene.add(this.group);
    this.made = new Map();  // by mode and step: a group, created when first shown
    this.shown = [];
  }

  /** Turns what is shown as the assembly is: `pose` about the scene's origin. */
  lie(pose) {
    this.group.position.set(pose[0], pose[1], pose[2]);
    this.group.quaternion.set(pose[4], pose[5], pose[6], pose[3]);
  }

  #make(mode, index, scheme, up) {
    const {model} = this, group = new Group(), point = new Float64Array(3);
    const {step, parts, times} = model.lines[mode].steps[index], lies = model.lies[mode];
    // The group lies as the assembly does; what waits in the layout does not.
    const whole = lies.during(new Float64Array(7), index, up), some = new Float64Array(7);
    step.moves.forEach((move, m) => {
      const {center} = model.parts[parts[m]], points = [];
      for (const [k, pose] of move.poses.entries()) {
        transform(point, pose, 0, center);
        for (let n = 0; n < 3; ++n) point[n] -= model.origin[n];
        if (lies.any) {
          transform(point, partly(some, whole, lies.share(parts[m], times[k])), 0, point);
          backwards(point, whole);
        }
        points.push(...point);
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

  /** Shows the paths of these steps and no others; `up`: unit. */
  show(mode, indices, scheme, up) {
    for (const group of this.shown) group.visible = false;
    this.shown = indices.map(index => {
      const key = `${mode} ${index} ${scheme} ${up}`;
      if (!this.made.has(key)) this.made.set(key, this.#make(mode, index, scheme, up));
      return this.made.get(key);
    });
    for (const group of this.shown) group.visible = true;
  }
}
