// The parts in the scene: surfaces shared by congruent parts, sharp edges as lines, one matrix each.
import * as THREE from 'three';
import {multiply, transform} from '../plan/screw.js';

const GHOST = 0.16;  // opacity of transparent parts

function geometriesOf(shape) {
  const positions = new THREE.BufferAttribute(shape.positions, 3);
  const normals = new Float32Array(shape.normals.length);
  for (let i = 0; i < normals.length; ++i) normals[i] = shape.normals[i] / 32767;
  const surface = new THREE.BufferGeometry();
  surface.setAttribute('position', positions);
  surface.setAttribute('normal', new THREE.BufferAttribute(normals, 3));
  surface.setIndex(new THREE.BufferAttribute(shape.triangles, 1));
  surface.computeBoundingBox();
  surface.computeBoundingSphere();
  const edges = new THREE.BufferGeometry();
  edges.setAttribute('position', positions);
  edges.setIndex(new THREE.BufferAttribute(shape.edges, 1));
  edges.boundingSphere = surface.boundingSphere;
  return {surface, edges};
}

/** One part: a mesh with its edges as child. `solid` and `ghost` are materials; switching them compiles no shader. */
class Body {
  constructor(part, geometries, lines) {
    this.part = part;
    this.solid = new THREE.MeshStandardMaterial({
      roughness: 0.62, metalness: 0.06, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1,
    });
    this.lines = lines;
    this.mesh = new THREE.Mesh(geometries.surface, this.solid);
    // move() writes one matrix, which is the matrix of the mesh, its world matrix, and that of its edges.
    this.mesh.matrixAutoUpdate = this.mesh.matrixWorldAutoUpdate = false;
    this.mesh.matrix = this.mesh.matrixWorld;
    this.mesh.castShadow = this.mesh.receiveShadow = true;
    this.mesh.userData.index = part.index;
    this.edges = new THREE.LineSegments(geometries.edges, lines.solid);
    this.edges.matrixAutoUpdate = this.edges.matrixWorldAutoUpdate = false;
    this.edges.matrix = this.edges.matrixWorld = this.mesh.matrixWorld;
    this.edges.raycast = () => {};
    this.edges.visible = geometries.edges.index.count > 0;
    this.mesh.add(this.edges);
    this.ghost = null;
    this.opacity = 1;
  }

  setColour(css) {
    this.solid.color.set(css);
    this.ghost?.color.set(css);
  }

  setGlow(css, strength) {
    for (const material of [this.solid, this.ghost]) {
      material?.emissive.set(css);
      if (material) material.emissiveIntensity = strength;
    }
  }

  /** 0: not drawn, below 1: transparent. */
  setOpacity(opacity, marked) {
    this.mesh.visible = opacity > 0.01;
    if (!this.mesh.visible) return;
    const through = opacity < 0.99;
    if (through && this.ghost === null) {
      this.ghost = this.solid.clone();
      this.ghost.transparent = true;
      this.ghost.depthWrite = false;
    }
    this.mesh.material = through ? this.ghost : this.solid;
    if (through) this.ghost.opacity = opacity;
    this.mesh.castShadow = !through;
    this.mesh.renderOrder = through ? 2 : 0;
    this.edges.renderOrder = through ? 3 : 1;
    this.edges.material = marked ? this.lines.marked : through ? this.lines.ghost : this.lines.solid;
  }
}

export class Parts {
  constructor(model, scene) {
    this.model = model;
    this.lines = {
      solid: new THREE.LineBasicMaterial({color: 0x10141c, transparent: true, opacity: 0.55}),
      ghost: new THREE.LineBasicMaterial({color: 0x10141c, transparent: true, opacity: 0.16, depthWrite: false}),
      marked: new THREE.LineBasicMaterial({color: 0x3358ff}),
    };
    const geometries = model.shapes.map(geometriesOf);
    this.bodies = model.parts.map(part => new Body(part, geometries[part.shape], this.lines));
    this.meshes = this.bodies.map(b => b.mesh);
    for (const mesh of this.meshes) scene.add(mesh);
    this.pose = new Float64Array(7);
    this.place = new Float64Array(7);
  }

  setTheme(dark) {
    this.lines.solid.color.set(dark ? 0x05070b : 0x10141c);
    this.lines.ghost.color.set(dark ? 0xc9d3e6 : 0x10141c);
    this.lines.marked.color.set(dark ? 0x9db4ff : 0x2347e8);
  }

  /**
   * Puts part `i` at `pose` (7 numbers, input coordinates), shifted by `share` of its offset in the exploded view.
   * `lies`: a pose about the scene's origin that comes after, or null.
   */
  move(i, pose, share, lies = null) {
    const {part, mesh} = this.bodies[i], {place} = part, out = this.place;
    multiply(out, 3, pose, 3, place, 3);
    transform(out, pose, 0, place);
    const {origin, offsets} = this.model, offset = offsets[i];
    for (let k = 0; k < 3; ++k) out[k] += share * offset[k] - origin[k];
    if (lies) {
      multiply(out, 3, lies, 3, out, 3);
      transform(out, lies, 0, out);
    }
    const w = out[3], x = out[4], y = out[5], z = out[6], m = mesh.matrixWorld.elements;
    m[0] = 1 - 2 * (y * y + z * z), m[1] = 2 * (x * y + w * z), m[2] = 2 * (x * z - w * y);
    m[4] = 2 * (x * y - w * z), m[5] = 1 - 2 * (x * x + z * z), m[6] = 2 * (y * z + w * x);
    m[8] = 2 * (x * z + w * y), m[9] = 2 * (y * z - w * x), m[10] = 1 - 2 * (x * x + y * y);
    m[12] = out[0], m[13] = out[1], m[14] = out[2];
  }

  /** Position at which point `p` of part `i` (assembled, input coordinates) is drawn by the mesh's matrix. Input coordinates. */
  shownPoint(i, p) {
    const {part, mesh} = this.bodies[i];
    const assembled = new THREE.Matrix4().compose(new THREE.Vector3(...part.place.slice(0, 3)),
      new THREE.Quaternion(part.place[4], part.place[5], part.place[6], part.place[3]), new THREE.Vector3(1, 1, 1));
    const local = new THREE.Vector3(...p).applyMatrix4(assembled.invert());
    return local.applyMatrix4(mesh.matrixWorld).toArray().map((x, k) => x + this.model.origin[k]);
  }

  /** Boxes around the parts that `wanted` accepts, in scene coordinates; a box of the whole assembly's size when there are none. */
  boxes(wanted) {
    const out = this.bodies.filter(b => wanted(b.part.index)).map(({mesh}) => mesh.geometry.boundingBox.clone().applyMatrix4(mesh.matrixWorld));
    const half = new THREE.Vector3().setScalar(this.model.size / 2);
    return out.length > 0 ? out : [new THREE.Box3(half.clone().negate(), half)];
  }

  static ghostly(presence) {
    return GHOST * presence;
  }
}
