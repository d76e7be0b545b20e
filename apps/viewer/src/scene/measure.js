// Distances between two points that are picked on parts. Corners and sharp edges near the pointer attract the point.
import * as THREE from 'three';

const NEAR = 11;  // px, from a corner or an edge
const COLOUR = 0xe0249a;

/** The point of segment a-b that is nearest to `p` on the screen, as a share of it. */
function along(a, b, p) {
  const x = b.x - a.x, y = b.y - a.y, length = x * x + y * y;
  return length > 0 ? Math.min(1, Math.max(0, ((p.x - a.x) * x + (p.y - a.y) * y) / length)) : 0;
}

export class Measure {
  constructor(stage, parts) {
    Object.assign(this, {stage, parts});
    this.on = false;
    this.ends = [];  // {index, local, kind}: points on parts, which move with them
    this.group = new THREE.Group();
    const dot = new THREE.SphereGeometry(1, 20, 12);
    const material = new THREE.MeshBasicMaterial({color: COLOUR, depthTest: false, transparent: true});
    this.dots = [0, 1].map(() => new THREE.Mesh(dot, material));
    this.line = new THREE.Line(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({color: COLOUR, depthTest: false, transparent: true}));
    for (const node of [...this.dots, this.line]) {
      node.renderOrder = 12;
      node.raycast = () => {};
      node.frustumCulled = false;
      this.group.add(node);
    }
    stage.scene.add(this.group);
    this.show();
  }

  /** The hit point (scene), or the corner or the point of a sharp edge of the part that is near it on the screen. */
  snapped({object, point}) {
    const {camera, container} = this.stage, {clientWidth: w, clientHeight: h} = container;
    const screen = v => { const p = v.clone().project(camera); return {x: (p.x + 1) * w / 2, y: (1 - p.y) * h / 2}; };
    const mouse = screen(point), body = this.parts.bodies[object.userData.index], {geometry} = body.edges;
    const corners = geometry.attributes.position, index = geometry.index, a = new THREE.Vector3(), b = new THREE.Vector3();
    let best = {kind: 'surface', point, px: NEAR};
    let corner = {px: NEAR};
    for (let i = 0; i + 1 < index.count; i += 2) {
      a.fromBufferAttribute(corners, index.getX(i)).applyMatrix4(object.matrixWorld);
      b.fromBufferAttribute(corners, index.getX(i + 1)).applyMatrix4(object.matrixWorld);
      const sa = screen(a), sb = screen(b);
      if (Math.min(sa.x, sb.x) > mouse.x + NEAR || Math.max(sa.x, sb.x) < mouse.x - NEAR) continue;
      const u = along(sa, sb, mouse), px = Math.hypot(sa.x + u * (sb.x - sa.x) - mouse.x, sa.y + u * (sb.y - sa.y) - mouse.y);
      // Of edges that lie behind each other, the one nearest to what was hit.
      const near = a.clone().lerp(b, u), depth = near.distanceTo(point);
      if (px < NEAR && (best.kind === 'surface' || depth < best.depth)) best = {kind: 'edge', point: near, px, depth};
      for (const [end, at] of [[a, sa], [b, sb]]) {
        const off = Math.hypot(at.x - mouse.x, at.y - mouse.y), deep = end.distanceTo(point);
        if (off < NEAR && (corner.depth === undefined || deep < corner.depth)) corner = {kind: 'corner', point: end.clone(), px: off, depth: deep};
      }
    }
    return corner.depth !== undefined && corner.depth <= (best.depth ?? 0) + 0.02 * this.parts.model.size ? corner : best;
  }

  /** Takes one more point; a third one begins anew. */
  pick(hit) {
    const {point, kind} = this.snapped(hit), index = hit.object.userData.index;
    if (this.ends.length === 2) this.ends = [];
    this.ends.push({index, kind, local: point.clone().applyMatrix4(hit.object.matrixWorld.clone().invert())});
    this.show();
  }

  clear() {
    this.ends = [];
    this.show();
  }

  /** Where the points are now, scene coordinates. */
  points() {
    return this.ends.map(({index, local}) => local.clone().applyMatrix4(this.parts.bodies[index].mesh.matrixWorld));
  }

  /** null, or {distance, along: [x, y, z]} in input units, as the parts are now. */
  result() {
    const [a, b] = this.points();
    return b ? {distance: a.distanceTo(b), along: b.clone().sub(a).toArray().map(Math.abs)} : null;
  }

  show() {
    const points = this.points(), {camera, controls} = this.stage;
    const radius = 0.006 * (controls ? camera.position.distanceTo(controls.target) : this.parts.model.size);
    this.dots.forEach((dot, k) => {
      dot.visible = k < points.length;
      if (dot.visible) dot.position.copy(points[k]);
      dot.scale.setScalar(radius);
    });
    this.line.visible = points.length === 2;
    if (this.line.visible) this.line.geometry.setFromPoints(points);
    this.stage.invalidate();
  }
}
