"""Meshes that the tests make."""
import numpy as np


def cube(lo, hi):
    """A closed box: (vertices, triangles), counter-clockwise seen from outside."""
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    triangles = np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])
    return np.asarray(lo) + corners * (np.asarray(hi) - np.asarray(lo)), triangles


def loose_blocks():
    """Four blocks in a row with gaps: each leaves in many directions."""
    return {f"block_{k}": cube([3 * k, 0, 0], [3 * k + 2, 2 + k, 3]) for k in range(4)}
