// Seeded random cases for the tests.
export function randomNumbers(seed) {
  let s = seed >>> 0;
  const next = () => {  // mulberry32
    s = s + 0x6d2b79f5 >>> 0;
    let t = Math.imul(s ^ s >>> 15, 1 | s);
    t = t + Math.imul(t ^ t >>> 7, 61 | t) ^ t;
    return ((t ^ t >>> 14) >>> 0) / 4294967296;
  };
  const between = (a, b) => a + (b - a) * next();
  const vector = size => [between(-size, size), between(-size, size), between(-size, size)];
  const unit = () => {
    for (;;) {
      const v = vector(1), n = Math.hypot(...v);
      if (n > 0.1 && n <= 1) return v.map(x => x / n);
    }
  };
  const turn = (axis, angle) => [Math.cos(angle / 2), ...axis.map(x => x * Math.sin(angle / 2))];
  const pose = size => [...vector(size), ...turn(unit(), between(0, Math.PI))];
  const integer = (a, b) => a + Math.floor(next() * (b - a + 1));
  return {next, between, vector, unit, turn, pose, integer};
}

export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const distance = (a, b) => Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);

/** Applies a screw to a point: rotation about an axis through `through` (Rodrigues) and translation along it. */
export function screwed(p, axis, through, angle, along) {
  const r = p.map((x, k) => x - through[k]), c = cross(axis, r), s = dot(axis, r) * (1 - Math.cos(angle));
  return r.map((x, k) => through[k] + x * Math.cos(angle) + c[k] * Math.sin(angle) + axis[k] * (s + along));
}

/** Applies a pose to a point by the rotation matrix, independently of the code under test. */
export function placed(pose, p) {
  const [x, y, z, w, i, j, k] = pose;
  return [
    (1 - 2 * (j * j + k * k)) * p[0] + 2 * (i * j - w * k) * p[1] + 2 * (i * k + w * j) * p[2] + x,
    2 * (i * j + w * k) * p[0] + (1 - 2 * (i * i + k * k)) * p[1] + 2 * (j * k - w * i) * p[2] + y,
    2 * (i * k - w * j) * p[0] + 2 * (j * k + w * i) * p[1] + (1 - 2 * (i * i + j * j)) * p[2] + z,
  ];
}

/** The pose `first`, followed by the screw. */
export function afterScrew(first, axis, through, angle, along) {
  const t = screwed(first.slice(0, 3), axis, through, angle, along), [w, x, y, z] = first.slice(3);
  const [a, b, c, d] = [Math.cos(angle / 2), ...axis.map(n => n * Math.sin(angle / 2))];
  return [...t, a * w - b * x - c * y - d * z, a * x + b * w + c * z - d * y, a * y - b * z + c * w + d * x, a * z + b * y - c * x + d * w];
}
