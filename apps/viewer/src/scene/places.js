// Dots where a part that did not come out touches the parts that block it. They are visible through all parts.
import * as THREE from 'three';

const RADIUS = 0.009, MARK = 0xff3b30;  // RADIUS: relative to the assembly's size

export class Places {
  constructor(model, scene) {
    this.model = model;
    this.group = new THREE.Group();
    this.group.visible = false;
    scene.add(this.group);
    this.sphere = new THREE.SphereGeometry(RADIUS * model.size, 20, 12);
    this.material = new THREE.MeshBasicMaterial({color: MARK, depthTest: false, transparent: true, opacity: 0.9});
  }

  /** Turns what is shown as the assembly is: `pose` about the scene's origin. */
  lie(pose) {
    this.group.position.set(pose[0], pose[1], pose[2]);
    this.group.quaternion.set(pose[4], pose[5], pose[6], pose[3]);
  }

  /** `points`: input coordinates. */
  show(points) {
    this.group.clear();
    for (const point of points) {
      const dot = new THREE.Mesh(this.sphere, this.material);
      dot.position.set(...point.map((x, k) => x - this.model.origin[k]));
      dot.renderOrder = 10;
      dot.raycast = () => {};
      this.group.add(dot);
    }
    this.group.visible = points.length > 0;
  }

  /** The points shown, input coordinates. */
  shown() {
    return this.group.visible ? this.group.children.map(dot => dot.position.toArray().map((x, k) => x + this.model.origin[k])) : [];
  }
}
