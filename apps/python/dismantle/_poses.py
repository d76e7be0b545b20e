"""Arithmetic of poses: rows x, y, z, qw, qx, qy, qz that take a point x to R(q) x + t."""
import numpy as np


def _checked(pose):
    pose = np.asarray(pose, dtype=float)
    if pose.ndim == 0 or pose.shape[-1] != 7:
        raise ValueError(f"expected poses (..., 7), got {pose.shape}")
    return pose


def _rotations(quaternions):
    """(..., 4) to (..., 3, 3)."""
    w, x, y, z = np.moveaxis(quaternions / np.linalg.norm(quaternions, axis=-1, keepdims=True), -1, 0)
    return np.stack([
        np.stack([1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)], -1),
        np.stack([2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)], -1),
        np.stack([2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)], -1),
    ], -2)


def transform(pose, points):
    """Where points are at a pose: (7,) and (N, 3) to (N, 3); (K, 7) and (N, 3) to (K, N, 3). With the vertices of a part and a
    step's poses, both in input units, this is the part along its path."""
    pose, points = _checked(pose), np.asarray(points, dtype=float)
    return points @ np.swapaxes(_rotations(pose[..., 3:]), -1, -2) + pose[..., None, :3]


def compose(a, b):
    """First b, then a: (..., 7) each, shapes as numpy broadcasts them."""
    a, b = np.broadcast_arrays(_checked(a), _checked(b))
    (aw, av), (bw, bv) = ((q[..., 3:4], q[..., 4:]) for q in (a, b))
    t = (_rotations(a[..., 3:]) @ b[..., :3, None])[..., 0] + a[..., :3]
    q = np.concatenate([aw * bw - np.sum(av * bv, -1, keepdims=True), aw * bv + bw * av + np.cross(av, bv)], -1)
    return np.concatenate([t, q / np.linalg.norm(q, axis=-1, keepdims=True)], -1)


def inverse(pose):
    """The pose that undoes it, (..., 7)."""
    pose = _checked(pose)
    q = pose[..., 3:] * [1, -1, -1, -1] / np.linalg.norm(pose[..., 3:], axis=-1, keepdims=True)
    return np.concatenate([-(_rotations(q) @ pose[..., :3, None])[..., 0], q], -1)


def matrix(pose):
    """Homogeneous matrices (..., 4, 4), as trimesh, Open3D and pyrender take them."""
    pose = _checked(pose)
    out = np.zeros(pose.shape[:-1] + (4, 4))
    out[..., :3, :3], out[..., :3, 3], out[..., 3, 3] = _rotations(pose[..., 3:]), pose[..., :3], 1
    return out


def pose_of_matrix(matrix):
    """The poses (..., 7) of homogeneous matrices (..., 4, 4) without scale or shear. Raises ValueError for others."""
    m = np.asarray(matrix, dtype=float)
    if m.ndim < 2 or m.shape[-2:] != (4, 4):
        raise ValueError(f"expected matrices (..., 4, 4), got {m.shape}")
    r = m[..., :3, :3]
    if not (np.allclose(r @ np.swapaxes(r, -1, -2), np.eye(3), atol=1e-6) and np.all(np.linalg.det(r) > 0)
            and np.allclose(m[..., 3, :], [0, 0, 0, 1], atol=1e-9)):
        raise ValueError("expected rotations and translations only")
    # Of the four formulas for the quaternion of a matrix, use the one that divides by the largest component.
    d = np.einsum("...ii->...i", r)
    trace = d.sum(-1)
    squares = np.stack([1 + trace, *(1 + 2 * d[..., k] - trace for k in range(3))], -1)
    u = [r[..., 2, 1] - r[..., 1, 2], r[..., 0, 2] - r[..., 2, 0], r[..., 1, 0] - r[..., 0, 1]]
    v = [r[..., 2, 1] + r[..., 1, 2], r[..., 0, 2] + r[..., 2, 0], r[..., 1, 0] + r[..., 0, 1]]
    ways = np.stack([np.stack([squares[..., 0], u[0], u[1], u[2]], -1), np.stack([u[0], squares[..., 1], v[2], v[1]], -1),
                     np.stack([u[1], v[2], squares[..., 2], v[0]], -1), np.stack([u[2], v[1], v[0], squares[..., 3]], -1)], -2)
    best = np.argmax(squares, -1)
    q = np.take_along_axis(ways, best[..., None, None], -2)[..., 0, :]
    q = q / np.linalg.norm(q, axis=-1, keepdims=True)
    return np.concatenate([m[..., :3, 3], np.where(q[..., :1] < 0, -q, q)], -1)
