// Arrows of forces: weights, contacts, and what a hand carries. They are visible through all parts.
import * as THREE from 'three';

const COLOURS = {weight: 0x7a5cff, contact: 0x2fa84f, hold: 0x12b5cb};
const LONGEST = 0.22, SHORTEST = 0.07, THICK = 0.0045;  // relative to the assembly's size

export class Forces {
  constructor(model, scene) {
    this.model = model;
    this.group = new THREE.Group();
    scene.add(this.group);
    this.shaft = new THREE.CylinderGeometry(1, 1, 1, 12).translate(0, 0.5, 0);
    this.head = new THREE.ConeGeometry(1, 1, 16).translate(0, -0.5, 0);
    this.materials = Object.fromEntries(Object.entries(COLOURS).map(([kind, color]) => [kind, new THREE.MeshBasicMaterial({color, depthTest: false, transparent: true, opacity: 0.92})]));
    this.arrows = [];
  }

  /** Turns what is shown as the assembly is: `pose` about the scene's origin. */
  lie(pose) {
    this.group.position.set(pose[0], pose[1], pose[2]);
    this.group.quaternion.set(pose[4], pose[5], pose[6], pose[3]);
  }

  /** `arrows`: {kind, at, force}, in input coordinates. A contact's arrow ends where it acts, the others begin there. */
  show(arrows) {
    this.group.clear();
    this.arrows = arrows;
    const {size, origin} = this.model, most = Math.max(...arrows.map(a => Math.hypot(...a.force)), 1e-300);
    for (const {kind, at, force} of arrows) {
      const amount = Math.hypot(...force), length = size * (SHORTEST + (LONGEST - SHORTEST) * amount / most), radius = THICK * size;
      const arrow = new THREE.Group(), head = new THREE.Mesh(this.head, this.materials[kind]), shaft = new THREE.Mesh(this.shaft, this.materials[kind]);
      head.scale.set(2.6 * radius, 7 * radius, 2.6 * radius);
      head.position.y = length;
      shaft.scale.set(radius, length - 7 * radius, radius);
      for (const mesh of [shaft, head]) {
        mesh.renderOrder = 11;
        mesh.raycast = () => {};
        arrow.add(mesh);
      }
      const along = new THREE.Vector3(...force).normalize();
      arrow.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), along);
      arrow.position.set(...at.map((x, k) => x - origin[k]));
      if (kind === 'contact') arrow.position.addScaledVector(along, -length);
      this.group.add(arrow);
    }
  }

  /** Kinds and places of the arrows that are shown, for tests. */
  shown() {
    return this.arrows.map(({kind, at}) => ({kind, at}));
  }
}
