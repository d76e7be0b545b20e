// Rigid displacements and the screw motion that joins two of them, as in docs/plan-format.md.
// A pose is 7 numbers x, y, z, qw, qx, qy, qz, anywhere in an array: x' = R(q) x + t. No function allocates.

const w = new Float64Array(3), v = new Float64Array(3), d = new Float64Array(3), turn = new Float64Array(4);

/** out = a x b, three numbers; `out` must be a different array. */
function cross(out, a, b) {
  out[0] = a[1] * b[2] - a[2] * b[1];
  out[1] = a[2] * b[0] - a[0] * b[2];
  out[2] = a[0] * b[1] - a[1] * b[0];
}

/** out[o..o+3] = a[i..] * b[j..], quaternions with the real part first. */
export function multiply(out, o, a, i, b, j) {
  const aw = a[i], ax = a[i + 1], ay = a[i + 2], az = a[i + 3];
  const bw = b[j], bx = b[j + 1], by = b[j + 2], bz = b[j + 3];
  out[o] = aw * bw - ax * bx - ay * by - az * bz;
  out[o + 1] = aw * bx + ax * bw + ay * bz - az * by;
  out[o + 2] = aw * by - ax * bz + ay * bw + az * bx;
  out[o + 3] = aw * bz + ax * by - ay * bx + az * bw;
}

/** out = R(q) p for the pose at pose[i..], plus its translation. */
export function transform(out, pose, i, p) {
  const qw = pose[i + 3], x = pose[i + 4], y = pose[i + 5], z = pose[i + 6];
  const px = p[0], py = p[1], pz = p[2];
  const tx = 2 * (y * pz - z * py), ty = 2 * (z * px - x * pz), tz = 2 * (x * py - y * px);
  out[0] = px + qw * tx + y * tz - z * ty + pose[i];
  out[1] = py + qw * ty + z * tx - x * tz + pose[i + 1];
  out[2] = pz + qw * tz + x * ty - y * tx + pose[i + 2];
  return out;
}

/** The twist that takes the pose at a[i..] to the one at b[j..] by the shorter rotation: `w` (rad) and `v`, about the origin. */
function twistBetween(a, i, b, j) {
  // turn = qb * conj(qa)
  const aw = a[i + 3], ax = -a[i + 4], ay = -a[i + 5], az = -a[i + 6];
  const bw = b[j + 3], bx = b[j + 4], by = b[j + 5], bz = b[j + 6];
  let qw = bw * aw - bx * ax - by * ay - bz * az;
  let x = bw * ax + bx * aw + by * az - bz * ay;
  let y = bw * ay - bx * az + by * aw + bz * ax;
  let z = bw * az + bx * ay - by * ax + bz * aw;
  if (qw < 0) qw = -qw, x = -x, y = -y, z = -z;
  const s = Math.hypot(x, y, z);
  const k = s > 0 ? 2 * Math.atan2(s, qw) / s : 0;
  w[0] = k * x, w[1] = k * y, w[2] = k * z;
  d[0] = b[j] - a[i], d[1] = b[j + 1] - a[i + 1], d[2] = b[j + 2] - a[i + 2];
  // v = V(w)^-1 d, with V the left Jacobian of the exponential map
  const angle2 = w[0] * w[0] + w[1] * w[1] + w[2] * w[2], angle = Math.sqrt(angle2);
  const c = angle2 < 1e-4 ? 1 / 12 + angle2 / 720 * (1 + angle2 / 42)
                          : 1 / angle2 - Math.cos(angle / 2) / (2 * angle * Math.sin(angle / 2));
  addRotated(v, d, -0.5, c);
}

const first = new Float64Array(3), second = new Float64Array(3);
/** out = p + b (w x p) + c (w x (w x p)). */
function addRotated(out, p, b, c) {
  cross(first, w, p);
  cross(second, w, first);
  for (let k = 0; k < 3; ++k) out[k] = p[k] + b * first[k] + c * second[k];
}

/**
 * The pose at u in [0, 1] on the constant screw motion from the pose at a[i..] to the one at b[j..], written to out[0..6].
 * It moves `a` by the twist u (w, v).
 */
export function screwInterpolate(out, a, i, b, j, u) {
  if (u <= 0 || u >= 1) {
    const from = u <= 0 ? a : b, at = u <= 0 ? i : j;
    for (let k = 0; k < 7; ++k) out[k] = from[at + k];
    return out;
  }
  twistBetween(a, i, b, j);
  for (let k = 0; k < 3; ++k) w[k] *= u, v[k] *= u;
  const angle2 = w[0] * w[0] + w[1] * w[1] + w[2] * w[2], angle = Math.sqrt(angle2);
  const series = angle2 < 1e-4;
  const half = series ? 0.5 - angle2 / 24 * (1 - angle2 / 30) : (1 - Math.cos(angle)) / angle2;
  const sixth = series ? 1 / 6 - angle2 / 120 * (1 - angle2 / 42) : (angle - Math.sin(angle)) / (angle2 * angle);
  addRotated(d, v, half, sixth);
  const k = angle < 1e-8 ? 0.5 : Math.sin(angle / 2) / angle;
  turn[0] = Math.cos(angle / 2), turn[1] = k * w[0], turn[2] = k * w[1], turn[3] = k * w[2];
  const tx = a[i] + d[0], ty = a[i + 1] + d[1], tz = a[i + 2] + d[2];
  multiply(out, 3, turn, 0, a, i + 3);
  const norm = Math.hypot(out[3], out[4], out[5], out[6]);
  for (let n = 3; n < 7; ++n) out[n] /= norm;
  // The twist rotates about the position of the part's origin at `a`, so the origin moves by V(u w) u v.
  out[0] = tx, out[1] = ty, out[2] = tz;
  return out;
}
