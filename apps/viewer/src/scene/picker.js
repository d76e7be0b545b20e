// Finds the part under the pointer. A press followed by a movement rotates the view and selects nothing.
import {Raycaster, Vector2} from 'three';

const STILL = 6;  // px

export class Picker {
  constructor(stage, parts, section, {hover, choose}) {
    const canvas = stage.renderer.domElement, ray = new Raycaster(), at = new Vector2();
    let down = null, waiting = false, last = null;
    /** What the ray through the pointer hits first, null: nothing. */
    this.hitAt = event => {
      const box = canvas.getBoundingClientRect();
      at.set(2 * (event.clientX - box.left) / box.width - 1, 1 - 2 * (event.clientY - box.top) / box.height);
      ray.setFromCamera(at, stage.camera);
      const solid = parts.meshes.filter(m => m.visible);
      // A transparent part is selected only where there is no opaque one.
      const hits = ray.intersectObjects(solid, false).filter(h => !section.hides(h.point));
      return hits.find(h => !h.object.material.transparent) ?? hits[0] ?? null;
    };
    this.partAt = event => this.hitAt(event)?.object.userData.index ?? -1;
    canvas.addEventListener('pointerdown', e => { down = e.isPrimary ? [e.clientX, e.clientY] : null; });
    canvas.addEventListener('pointerup', e => {
      if (down && e.button === 0 && Math.hypot(e.clientX - down[0], e.clientY - down[1]) < STILL) choose(this.hitAt(e));
      down = null;
    });
    canvas.addEventListener('pointermove', e => {
      if (e.pointerType !== 'mouse' || e.buttons !== 0) return;
      last = e;
      if (waiting) return;
      waiting = true;
      setTimeout(() => {
        waiting = false;
        if (last) hover(this.partAt(last), last.clientX, last.clientY);
      }, 60);
    });
    canvas.addEventListener('pointerleave', () => { last = null; hover(-1, 0, 0); });
  }
}
