"""Meshes bent by joints: linear blend skinning, as the rasterizer and the page do it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from bioscope.geometry.transforms import composed, inverse, matrices

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from bioscope._engine import Mesh

    Floats = NDArray[np.floating]


def rest_pose(mesh: Mesh) -> NDArray[np.float32]:
    """Return the joints' transforms at rest in mesh space, (joints, 8)."""
    return np.array([rest for _, _, rest in mesh.joints], np.float32).reshape(-1, 8)


def parents(mesh: Mesh) -> list[int | None]:
    """Return the number of each joint's parent, none for a root."""
    return [parent for _, parent, _ in mesh.joints]


def bent(mesh: Mesh, pose: Floats) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Return positions and unit normals (vertices, 3) of a mesh bent to a pose.

    Parameters
    ----------
    mesh
        A mesh with joints.
    pose
        Transforms of its joints, (joints, 8): in mesh space, or any space the result is wanted in.
    """
    moves = matrices(composed(pose, inverse(rest_pose(mesh)))).reshape(len(pose), 12)
    blend = np.zeros((len(mesh.positions), 12), moves.dtype)
    for indices, weights in zip(mesh.joint_indices.T, mesh.joint_weights.T, strict=True):
        if weights.any():
            blend += moves[indices] * weights[:, None]
    rows = blend.reshape(-1, 3, 4)
    positions = np.einsum("vrc,vc->vr", rows[:, :, :3], mesh.positions) + rows[:, :, 3]
    normals = np.einsum("vrc,vc->vr", rows[:, :, :3], mesh.normals)
    return positions.astype(np.float32), units(normals)


def units(vectors: NDArray[np.floating]) -> NDArray[np.float32]:
    """Return vectors (n, 3) at length 1; up where there is no direction."""
    lengths = np.linalg.norm(vectors, axis=1, keepdims=True)
    up = np.array([0.0, 1.0, 0.0])
    return np.where(lengths > 1e-12, vectors / np.maximum(lengths, 1e-12), up).astype(np.float32)
