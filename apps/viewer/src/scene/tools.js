// The tools of a step in their place: the solids that the check found room for, and the hands that hold them.
import * as THREE from 'three';
import {transform} from '../plan/screw.js';

const STEEL = 0x2f9e7c, SKIN = 0xd9a58b, BEATS = 0.6;  // BEATS: swings per second of the animation

function solidOf({outline, inner, z: [low, high]}) {
  const shape = new THREE.Shape();
  for (let i = 0; i < outline.length; i += 2) shape[i === 0 ? 'moveTo' : 'lineTo'](outline[i], outline[i + 1]);
  shape.closePath();
  if (inner > 0) shape.holes.push(new THREE.Path().absarc(0, 0, inner, 0, 2 * Math.PI, true));
  return new THREE.ExtrudeGeometry(shape, {depth: high - low, bevelEnabled: false, curveSegments: 24}).translate(0, 0, low);
}

export class Tools {
  constructor(model, scene) {
    this.model = model;
    this.group = new THREE.Group();
    scene.add(this.group);
    this.steel = new THREE.MeshStandardMaterial({color: STEEL, roughness: 0.45, metalness: 0.25});
    this.skin = new THREE.MeshStandardMaterial({color: SKIN, roughness: 0.9, transparent: true, opacity: 0.2, depthWrite: false});
    this.drawn = [];  // {tool, node, swinging, mode, at}: `at`: time at which the tool is where its note says
    this.on = true;
    this.point = new Float64Array(3);
    this.pose = new Float64Array(7);
  }

  /** Turns what is shown as the assembly is: `pose` about the scene's origin. */
  lie(pose) {
    this.group.position.set(pose[0], pose[1], pose[2]);
    this.group.quaternion.set(pose[4], pose[5], pose[6], pose[3]);
  }

  /** Shows the tools of one step and no others; `index` -1: none. */
  show(mode, index) {
    for (const {node} of this.drawn) node.traverse(child => child.geometry?.dispose());
    this.group.clear();
    this.drawn = [];
    if (index < 0) return;
    const {begin, end} = this.model.lines[mode].steps[index];
    for (const tool of this.model.about(mode, index).tools ?? []) {
      const x = new THREE.Vector3(...tool.x), axis = new THREE.Vector3(...tool.axis), node = new THREE.Group();
      node.quaternion.setFromRotationMatrix(new THREE.Matrix4().makeBasis(x, axis.clone().cross(x), axis));
      node.scale.setScalar(1 / tool.mm);
      const swinging = new THREE.Group();
      for (const [prisms, material] of [[tool.tool, this.steel], [tool.hand, this.skin]])
        for (const prism of prisms) {
          const mesh = new THREE.Mesh(solidOf(prism), material);
          mesh.castShadow = material === this.steel;
          mesh.renderOrder = material === this.steel ? 0 : 3;
          mesh.raycast = () => {};
          swinging.add(mesh);
        }
      node.add(swinging);
      this.group.add(node);
      this.drawn.push({tool, node, swinging, mode, at: mode === 'assembly' ? end : begin});
    }
  }

  /** How far the fastener is from where it is driven, along the axis, in input units; `goes`: a pose of its part. */
  #lift(tool, at, goes) {
    const {point} = this, [w, x, y, z] = [at[3], -at[4], -at[5], -at[6]];
    for (let k = 0; k < 3; ++k) point[k] = tool.origin[k] - at[k];
    transform(point, [0, 0, 0, w, x, y, z], 0, point);
    transform(point, goes, 0, point);
    return tool.axis.reduce((sum, a, k) => sum + a * (point[k] - tool.origin[k]), 0);
  }

  /** Puts the tools where they are at `time`: they follow their fastener as far as it is driven, and are gone then. */
  place(time, visible) {
    const {model} = this, seat = new Float64Array(7);
    for (const {tool, node, swinging, mode, at} of this.drawn) {
      const lift = tool.turns ? this.#lift(tool, model.poseOf(tool.part, mode, at, seat), model.poseOf(tool.part, mode, time, this.pose)) : 0;
      const driven = Math.abs(lift) <= Math.max(tool.travel / tool.mm, 0) + 1e-9;
      node.visible = this.on && visible && driven;
      node.position.set(...tool.origin.map((p, k) => p - model.origin[k] + lift * tool.axis[k]));
      swinging.rotation.z = tool.turns ? tool.swing / 2 * Math.sin(2 * Math.PI * BEATS * (time - at)) : 0;
    }
  }

  /** What is shown now, for tests: names of tools, and where their frames are, input coordinates. */
  shown() {
    return this.drawn.filter(({node}) => node.visible).map(({tool, node}) => ({name: tool.name, part: this.model.parts[tool.part].name,
      turns: tool.turns, at: node.position.toArray().map((p, k) => p + this.model.origin[k])}));
  }
}
