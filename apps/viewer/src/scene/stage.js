// The stage: renderer, camera, lights, ground. Draws only after changes.
import * as THREE from 'three';
import {OrbitControls} from 'three/addons/controls/OrbitControls.js';

const FLIGHT = 0.45;  // s, from one view to another
const SLOW = 0.075;   // s; motion is not smooth when frames take longer

/** Yields the corners of boxes one after the other, all in the same vector object. */
function* corners(boxes) {
  const corner = new THREE.Vector3();
  for (const {min, max} of boxes)
    for (let c = 0; c < 8; ++c) yield corner.set(c & 1 ? max.x : min.x, c & 2 ? max.y : min.y, c & 4 ? max.z : min.z);
}

/** Extent of boxes on the screen, as seen from `distance`; lengths are measured in the plane of `center`. */
function extent(boxes, center, right, top, back, distance) {
  const out = {left: Infinity, right: -Infinity, bottom: Infinity, top: -Infinity};
  for (const corner of corners(boxes)) {
    corner.sub(center);
    const scale = distance / Math.max(distance - corner.dot(back), 0.05 * distance);
    const x = corner.dot(right) * scale, y = corner.dot(top) * scale;
    out.left = Math.min(out.left, x), out.right = Math.max(out.right, x);
    out.bottom = Math.min(out.bottom, y), out.top = Math.max(out.top, y);
  }
  return out;
}

export class Stage {
  constructor(container, size) {
    this.container = container;
    this.size = size;
    this.renderer = new THREE.WebGLRenderer({antialias: true, alpha: true, powerPreference: 'high-performance'});
    this.renderer.setClearColor(0, 0);
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = THREE.PCFShadowMap;
    this.renderer.shadowMap.autoUpdate = false;
    container.append(this.renderer.domElement);
    this.scene = new THREE.Scene();
    this.scene.matrixAutoUpdate = false;
    this.camera = new THREE.PerspectiveCamera(35, 1, 0.01 * size, 100 * size);
    this.scene.add(this.camera);
    this.flight = null;
    this.most = 2;     // largest number of rendered pixels per CSS pixel
    this.slow = 0;     // number of consecutive slow frames
    this.groundOn = true;
    this.shade = 0.2;  // opacity of the shadow on the ground
    this.dirty = true;
    this.onFrame = null;  // (seconds since the last frame) => whether to continue
    this.onView = null;   // called after the camera has moved
    this.#light();
    this.#ground();
    this.setUp([0, 0, 1]);
    new ResizeObserver(() => this.resize()).observe(container);
    this.resize();
    this.before = 0;
    this.tick = this.tick.bind(this);
    requestAnimationFrame(this.tick);
  }

  /** Makes new controls, since OrbitControls keeps the up axis from its construction. */
  #control() {
    const target = this.controls?.target;
    this.controls?.dispose();
    this.controls = new OrbitControls(this.camera, this.renderer.domElement);
    if (target) this.controls.target.copy(target);
    this.controls.enableDamping = true;
    this.controls.dampingFactor = 0.12;
    this.controls.zoomToCursor = true;
    this.controls.addEventListener('change', () => this.invalidate());
    this.controls.addEventListener('start', () => { this.flight = null; });
  }

  #light() {
    this.sky = new THREE.HemisphereLight(0xffffff, 0x8f96a8, 1.55);
    const key = new THREE.DirectionalLight(0xffffff, 1.3);
    key.position.set(-0.6, 0.8, 1);  // over the viewer's left shoulder
    this.camera.add(key, key.target);
    key.target.position.set(0, 0, -1);
    this.sun = new THREE.DirectionalLight(0xffffff, 0.9);
    this.sun.castShadow = true;
    this.sun.shadow.mapSize.set(2048, 2048);
    this.sun.shadow.radius = 4;
    this.sun.shadow.intensity = 0.75;
    this.scene.add(this.sky, this.sun, this.sun.target);
  }

  #ground() {
    this.ground = new THREE.Mesh(new THREE.PlaneGeometry(1, 1), new THREE.ShadowMaterial({opacity: 0.22, depthWrite: false}));
    this.ground.receiveShadow = true;
    this.ground.renderOrder = -1;
    this.scene.add(this.ground);
  }

  /** `up`: a direction of the scene, unit. */
  setUp(up) {
    this.up = new THREE.Vector3(...up);
    // From a scene with Z up: the shortest turn; upside down over the front, so that right stays right.
    this.upright = up[2] < -1 + 1e-9 ? new THREE.Quaternion(1, 0, 0, 0) : new THREE.Quaternion().setFromUnitVectors(new THREE.Vector3(0, 0, 1), this.up);
    this.camera.up.copy(this.up);
    this.#control();
    this.sky.position.copy(this.up);
    this.ground.quaternion.setFromUnitVectors(new THREE.Vector3(0, 0, 1), this.up);
    this.invalidate(true);
  }

  /** Fits ground and light to `boxes` (scene coordinates). */
  settle(boxes) {
    const box = boxes.reduce((sum, one) => sum.union(one), new THREE.Box3());
    const sphere = box.getBoundingSphere(new THREE.Sphere());
    const low = box.min.dot(this.up), r = 1.6 * sphere.radius;
    this.ground.position.copy(sphere.center).addScaledVector(this.up, low - sphere.center.dot(this.up) - 0.004 * this.size);
    this.ground.scale.setScalar(8 * sphere.radius);
    const side = new THREE.Vector3(-0.35, -0.25, 0).applyQuaternion(this.upright);
    this.sun.target.position.copy(sphere.center);
    this.sun.position.copy(sphere.center).addScaledVector(side.add(this.up), 2 * r);
    const shadow = this.sun.shadow.camera;
    shadow.left = shadow.bottom = -r;
    shadow.right = shadow.top = r;
    shadow.near = 0.1 * r;
    shadow.far = 5 * r;
    shadow.updateProjectionMatrix();
    this.sun.shadow.normalBias = 0.0035 * this.size;
    this.sun.shadow.bias = -0.0004;
    this.invalidate(true);
  }

  resize() {
    const {clientWidth: width, clientHeight: height} = this.container;
    const ratio = Math.min(window.devicePixelRatio, this.most);
    if (width === 0 || height === 0 || this.drawnSize === `${width} ${height} ${ratio}`) return;
    this.drawnSize = `${width} ${height} ${ratio}`;
    this.renderer.setPixelRatio(ratio);
    this.renderer.setSize(width, height);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.invalidate();
  }

  /** The picture as it is shown, as the address of an image. */
  picture() {
    this.#draw();
    return this.renderer.domElement.toDataURL('image/png');
  }

  /** Where a point of the scene is, CSS pixels of the window. */
  onScreen(point) {
    this.camera.updateMatrixWorld();  // it may have moved since the last frame
    const p = new THREE.Vector3(...point).project(this.camera), box = this.renderer.domElement.getBoundingClientRect();
    return [box.left + (p.x + 1) * box.width / 2, box.top + (1 - p.y) * box.height / 2];
  }

  /** `moved`: parts have moved, so shadows must be drawn again. */
  invalidate(moved = false) {
    this.dirty = true;
    if (moved) this.renderer.shadowMap.needsUpdate = true;
  }

  static DIRECTIONS = {
    corner: [0.62, -0.92, 0.62], front: [0, -1, 0], back: [0, 1, 0], right: [1, 0, 0], left: [-1, 0, 0],
    top: [0, -1e-3, 1], bottom: [0, -1e-3, -1],
  };

  /** Moves the camera so that `boxes` fill the view, from the current direction or a named one. */
  fit(boxes, {from = null, fly = true, margin = 1.12, minimum = 0} = {}) {
    const back = this.#direction(from), right = new THREE.Vector3().crossVectors(this.up, back);
    if (right.lengthSq() < 1e-8) right.set(1, 0, 0);
    right.normalize();
    const top = new THREE.Vector3().crossVectors(back, right);
    const all = boxes.reduce((sum, box) => sum.union(box), new THREE.Box3());
    const center = all.getCenter(new THREE.Vector3()), radius = Math.max(all.getSize(new THREE.Vector3()).length() / 2, minimum);
    const half = Math.tan(this.camera.fov * Math.PI / 360), wide = half * this.camera.aspect;
    let distance = 0;
    // Two passes, because the centre of the picture depends on the distance.
    for (let pass = 0; pass < 2; ++pass) {
      const seen = extent(boxes, center, right, top, back, Math.max(distance, 2 * radius / Math.min(half, wide)));
      center.addScaledVector(right, (seen.right + seen.left) / 2).addScaledVector(top, (seen.top + seen.bottom) / 2);
      distance = minimum / half;
      for (const corner of corners(boxes)) {
        corner.sub(center);
        const depth = corner.dot(back);
        distance = Math.max(distance, depth + margin * Math.abs(corner.dot(top)) / half, depth + margin * Math.abs(corner.dot(right)) / wide);
      }
    }
    this.controls.minDistance = 0.02 * radius;
    this.controls.maxDistance = Math.max(40 * radius, 20 * this.size);
    const goal = {target: center, position: center.clone().addScaledVector(back, distance)};
    if (fly) {
      this.flight = {time: 0, from: {target: this.controls.target.clone(), position: this.camera.position.clone()}, to: goal};
    } else {
      this.flight = null;
      this.#place(goal.target, goal.position);
    }
    this.invalidate();
  }

  /** Direction from the target to the camera. */
  #direction(from) {
    const out = new THREE.Vector3();
    if (from === null) return out.subVectors(this.camera.position, this.controls.target).normalize();
    const [x, y, z] = typeof from === 'string' ? Stage.DIRECTIONS[from] : from;
    out.set(x, y, z);
    if (typeof from === 'string') out.applyQuaternion(this.upright);
    return out.normalize();
  }

  #place(target, position) {
    this.controls.target.copy(target);
    this.camera.position.copy(position);
    this.controls.update();
  }

  #fly(seconds) {
    const f = this.flight;
    if (!f) return;
    f.time = Math.min(FLIGHT, f.time + seconds);
    const u = f.time / FLIGHT, e = u * u * (3 - 2 * u);
    // Rotating about the target keeps the distance; a straight line could pass through the parts.
    const target = f.from.target.clone().lerp(f.to.target, e);
    const a = f.from.position.clone().sub(f.from.target), b = f.to.position.clone().sub(f.to.target);
    const length = a.length() + e * (b.length() - a.length());
    const turn = new THREE.Quaternion().setFromUnitVectors(a.clone().normalize(), b.clone().normalize());
    const arm = a.normalize().applyQuaternion(new THREE.Quaternion().slerp(turn, e)).multiplyScalar(length);
    this.#place(target, target.clone().add(arm));
    if (u >= 1) this.flight = null;
    this.dirty = true;
  }

  #draw() {
    const distance = this.camera.position.distanceTo(this.controls.target);
    const far = distance + 12 * this.size + this.ground.scale.x, near = Math.max(0.004 * distance, 1e-4 * far);
    if (Math.abs(this.camera.near - near) > 0.05 * near || Math.abs(this.camera.far - far) > 0.05 * far) {
      this.camera.near = near;
      this.camera.far = far;
      this.camera.updateProjectionMatrix();
    }
    this.ground.visible = this.groundOn && this.sun.castShadow && this.camera.position.dot(this.up) > this.ground.position.dot(this.up);
    this.renderer.render(this.scene, this.camera);
    this.onView?.(this.camera);
  }

  /** Reduces quality when frames are slow: first the shadows, then the resolution. */
  #keepUp(seconds) {
    this.slow = seconds > SLOW ? this.slow + 1 : 0;
    if (this.slow < 6) return;
    this.slow = 0;
    if (this.sun.castShadow) {
      this.sun.castShadow = false;
    } else if (this.most > 1) {
      this.most = 1;
      this.resize();
    }
  }

  tick(now) {
    const seconds = Math.min(0.1, (now - this.before) / 1000);
    this.before = now;
    this.onFrame?.(seconds);
    this.#fly(seconds);
    if (!this.flight) this.controls.update();
    if (this.dirty) {
      this.dirty = false;
      this.#draw();
      this.#keepUp(seconds);
    } else {
      this.slow = 0;
    }
    requestAnimationFrame(this.tick);
  }
}
