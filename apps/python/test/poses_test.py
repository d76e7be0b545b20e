import numpy as np
import pytest

import dismantle


def random_poses(rng, shape):
    poses = rng.normal(size=(*shape, 7))
    poses[..., 3:] /= np.linalg.norm(poses[..., 3:], axis=-1, keepdims=True)
    return poses


def same_displacement(a, b):
    return np.allclose(dismantle.matrix(a), dismantle.matrix(b), atol=1e-12)


def test_transform_compose_and_inverse_agree():
    rng = np.random.default_rng(1)
    for shape in ((), (5,), (2, 3)):
        a, b, points = random_poses(rng, shape), random_poses(rng, shape), rng.normal(size=(4, 3))
        once = dismantle.transform(dismantle.compose(a, b), points)
        assert once.shape == (*shape, 4, 3)
        for k in np.ndindex(shape):
            assert np.allclose(once[k], dismantle.transform(a[k], dismantle.transform(b[k], points)))
        identity = np.broadcast_to([0, 0, 0, 1, 0, 0, 0], a.shape)
        assert same_displacement(dismantle.compose(a, dismantle.inverse(a)), identity)
        assert same_displacement(dismantle.compose(dismantle.inverse(a), a), identity)


def test_a_pose_composes_with_many():
    rng = np.random.default_rng(2)
    one, many = random_poses(rng, ()), random_poses(rng, (6,))
    assert same_displacement(dismantle.compose(one, many)[3], dismantle.compose(one, many[3]))


def test_matrices_and_back():
    rng = np.random.default_rng(3)
    poses = random_poses(rng, (200,))
    poses[:8, 3:] = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1], [-1, 0, 0, 0], [0, -1, 0, 0],
                     [0.6, 0.8, 0, 0], [1e-9, 0, 0, 1]]  # where one formula alone divides by zero
    back = dismantle.pose_of_matrix(dismantle.matrix(poses))
    assert np.all(back[:, 3] >= 0) and same_displacement(back, poses)
    points = rng.normal(size=(3, 3))
    homogeneous = np.concatenate([points, np.ones((3, 1))], 1)
    assert np.allclose((homogeneous @ dismantle.matrix(poses[9]).T)[:, :3], dismantle.transform(poses[9], points))
    for wrong in (2 * np.eye(4), np.diag([1, 1, -1, 1.0]), np.eye(3)):
        with pytest.raises(ValueError):
            dismantle.pose_of_matrix(wrong)
    with pytest.raises(ValueError, match="7"):
        dismantle.transform(np.zeros(6), points)


def test_they_are_the_poses_of_the_engine(box):
    """The middle of a screw is half of it, twice."""
    rng = np.random.default_rng(4)
    for _ in range(20):
        a, b = random_poses(rng, (2,))
        half = dismantle.interpolate(a, b, 0.5)
        step = dismantle.compose(half, dismantle.inverse(a))
        assert same_displacement(dismantle.compose(step, half), dismantle.interpolate(a, b, 1))


def test_a_part_along_its_path(box):
    plan = dismantle.run(box, seed=1)
    step = plan.steps[0]
    part, poses = next(iter(step.moves.items()))
    along = dismantle.transform(poses, box[part].vertices)
    assert along.shape == (len(poses), len(box[part].vertices), 3)
    assert np.allclose(along[0], box[part].vertices)  # where it is when assembled
    assert np.abs(along[-1] - along[0]).max() > 0
