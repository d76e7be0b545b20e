// A plane that cuts the parts open. What is cut looks solid: the inner sides of surfaces are drawn flat, without light.
import * as THREE from 'three';

const AXES = {x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1]};
const FLAT = '\tif (!gl_FrontFacing) gl_FragColor.rgb = 0.62 * diffuse + vec3(0.06);\n';

export class Section {
  constructor(stage, parts) {
    Object.assign(this, {stage, parts});
    this.axis = null;   // 'x', 'y', 'z', or null: nothing is cut
    this.share = 0.5;   // of the extent along the axis
    this.flipped = false;
    this.drawn = new THREE.Plane();  // as the assembly is drawn
    this.plane = new THREE.Plane();  // as it lies
    this.pose = null;
    Object.assign(this, {turn: new THREE.Matrix4(), at0: new THREE.Vector3(), turn0: new THREE.Quaternion(), one: new THREE.Vector3(1, 1, 1)});
    stage.renderer.localClippingEnabled = true;
  }

  #materials() {
    return [...this.parts.bodies.flatMap(({solid, ghost}) => ghost ? [solid, ghost] : [solid]), ...Object.values(this.parts.lines)];
  }

  set({axis = this.axis, share = this.share, flipped = this.flipped}) {
    Object.assign(this, {axis, share, flipped});
    this.apply();
  }

  /** Also after parts became transparent for the first time. */
  apply() {
    const planes = this.axis ? [this.plane] : null;
    if (this.axis) {
      const box = this.extent();
      const normal = new THREE.Vector3(...AXES[this.axis]).multiplyScalar(this.flipped ? 1 : -1);
      const at = box.min.clone().lerp(box.max, this.share);
      this.drawn.setFromNormalAndCoplanarPoint(normal, at);
      if (this.pose) this.lie(this.pose);
      else this.plane.copy(this.drawn);
    }
    for (const material of this.#materials()) {
      if (Boolean(material.clippingPlanes) === Boolean(planes)) continue;
      material.clippingPlanes = planes;
      material.clipShadows = true;
      if (material.isMeshStandardMaterial) {
        material.side = planes ? THREE.DoubleSide : THREE.FrontSide;
        material.onBeforeCompile = planes ? shader => {
          shader.fragmentShader = shader.fragmentShader.replace('#include <dithering_fragment>', `#include <dithering_fragment>\n${FLAT}`);
        } : () => {};
        material.customProgramCacheKey = () => planes ? 'cut' : '';
      }
      material.needsUpdate = true;
    }
    this.stage.invalidate(true);
  }

  /** Turns the plane as the assembly is: `pose` about the scene's origin. */
  lie(pose) {
    this.pose = pose;
    this.turn.compose(this.at0.set(pose[0], pose[1], pose[2]), this.turn0.set(pose[4], pose[5], pose[6], pose[3]), this.one);
    this.plane.copy(this.drawn).applyMatrix4(this.turn);
  }

  /** Where the assembly is when nothing has moved. */
  extent() {
    const {origin, parts} = this.parts.model, box = new THREE.Box3(), corner = new THREE.Vector3();
    for (const {lo, hi} of parts) for (const c of [lo, hi]) box.expandByPoint(corner.set(...c.map((x, k) => x - origin[k])));
    return box;
  }

  /** Is a point of the scene cut away? */
  hides(point) {
    return this.axis !== null && this.plane.distanceToPoint(point) < 0;
  }

  /** Input coordinate of the plane along its axis. */
  at() {
    const k = 'xyz'.indexOf(this.axis), box = this.extent();
    const lo = box.min.getComponent(k), hi = box.max.getComponent(k);
    return lo + this.share * (hi - lo) + this.parts.model.origin[k];
  }
}
