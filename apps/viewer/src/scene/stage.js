// The stage: renderer, camera, lights, ground. Draws only when something has changed.
import * as THREE from 'three';
import {OrbitControls} from 'three/addons/controls/OrbitControls.js';

const FLIGHT = 0.45;  // s, from one view to another

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
    this.groundOn = true;
    this.dirty = true;
    this.onFrame = null;  // (seconds since the last frame) => whether to go on
    this.onView = null;   // after the camera has moved
    this.#light();
    this.#ground();
    this.setUp('z');
    new ResizeObserver(() => this.resize()).observe(container);
    this.resize();
    this.before = 0;
    this.tick = this.tick.bind(this);
    requestAnimationFrame(this.tick);
  }

  /** The controls turn about the axis that was up when they were made. */
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

  setUp(axis) {
    this.axis = axis;
    this.up = axis === 'z' ? new THREE.Vector3(0, 0, 1) : new THREE.Vector3(0, 1, 0);
    this.camera.up.copy(this.up);
    this.#control();
    this.sky.position.copy(this.up);
    this.ground.quaternion.setFromUnitVectors(new THREE.Vector3(0, 0, 1), this.up);
    this.invalidate(true);
  }

  /** Ground and light for what lies within `box` (scene coordinates). */
  settle(box) {
    const sphere = box.getBoundingSphere(new THREE.Sphere());
    const low = box.min.dot(this.up), r = 1.6 * sphere.radius;
    this.ground.position.copy(sphere.center).addScaledVector(this.up, low - sphere.center.dot(this.up) - 0.004 * this.size);
    this.ground.scale.setScalar(8 * sphere.radius);
    const side = this.axis === 'z' ? new THREE.Vector3(-0.35, -0.25, 0) : new THREE.Vector3(-0.35, 0, 0.25);
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
    if (width === 0 || height === 0) return;
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.renderer.setSize(width, height);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.invalidate();
  }

  /** `moved`: parts have, so shadows have to be drawn again. */
  invalidate(moved = false) {
    this.dirty = true;
    if (moved) this.renderer.shadowMap.needsUpdate = true;
  }

  static DIRECTIONS = {
    corner: [0.62, -0.92, 0.62], front: [0, -1, 0], back: [0, 1, 0], right: [1, 0, 0], left: [-1, 0, 0],
    top: [0, -1e-3, 1], bottom: [0, -1e-3, -1],
  };

  /** Moves the camera so that `box` fills the view, from the present direction or a named one. */
  fit(box, {from = null, fly = true, margin = 1.12, minimum = 0} = {}) {
    const sphere = box.getBoundingSphere(new THREE.Sphere());
    sphere.radius = Math.max(sphere.radius, minimum, 1e-6 * this.size);
    const direction = new THREE.Vector3();
    if (from === null) {
      direction.subVectors(this.camera.position, this.controls.target).normalize();
    } else {
      const [x, y, z] = typeof from === 'string' ? Stage.DIRECTIONS[from] : from;
      if (this.axis === 'z' || typeof from !== 'string') direction.set(x, y, z); else direction.set(x, z, -y);
      direction.normalize();
    }
    // Eight corners tell more than a sphere, for assemblies that are long or flat.
    const half = Math.tan(this.camera.fov * Math.PI / 360), aspect = this.camera.aspect;
    const back = direction, right = new THREE.Vector3().crossVectors(this.up, back);
    if (right.lengthSq() < 1e-8) right.set(1, 0, 0);
    right.normalize();
    const top = new THREE.Vector3().crossVectors(back, right), center = box.getCenter(new THREE.Vector3());
    let distance = minimum / half, corner = new THREE.Vector3();
    for (let c = 0; c < 8; ++c) {
      corner.set(c & 1 ? box.max.x : box.min.x, c & 2 ? box.max.y : box.min.y, c & 4 ? box.max.z : box.min.z).sub(center);
      const depth = corner.dot(back);
      distance = Math.max(distance, depth + Math.abs(corner.dot(top)) * margin / half,
        depth + Math.abs(corner.dot(right)) * margin / (half * aspect));
    }
    this.controls.minDistance = 0.02 * sphere.radius;
    this.controls.maxDistance = Math.max(40 * sphere.radius, 20 * this.size);
    const goal = {target: center, position: center.clone().addScaledVector(direction, distance)};
    if (fly) {
      this.flight = {time: 0, from: {target: this.controls.target.clone(), position: this.camera.position.clone()}, to: goal};
    } else {
      this.flight = null;
      this.#place(goal.target, goal.position);
    }
    this.invalidate();
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
    // Turning about the target keeps the distance; a straight line could pass through the parts.
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
    this.ground.visible = this.groundOn && this.camera.position.dot(this.up) > this.ground.position.dot(this.up);
    this.renderer.render(this.scene, this.camera);
    this.onView?.(this.camera);
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
    }
    requestAnimationFrame(this.tick);
  }
}
