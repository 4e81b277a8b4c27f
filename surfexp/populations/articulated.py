"""Bodies with bones: families of poses that are nearly isometric, made instead of scanned."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.mesh.shape_metrics import with_metrics
from surfexp.mesh.shapes.implicit_surface import mesh_implicit
from surfexp.mesh.shapes.round_cones import round_cones
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh

BLEND = 0.08
GRID = 0.045
STIFFER, ATTEMPTS = 0.7, 8
FEWEST_VERTICES = 400
# a skin with less area than this, relative to the pose at rest, has limbs that melted together
LARGEST_CHANGE = 0.025

# parent (-1: none), place along it, direction x y z, length, radii at both ends, degrees of freedom to turn
# fmt: off
BODIES: dict[str, list[tuple[float, ...]]] = {
    "biped": [
        (-1, 0.0, 0, 0, 1, 0.95, 0.24, 0.28, 10), (0, 1.1, 0, 0, 1, 0.35, 0.13, 0.20, 20),
        (0, 0.95, 1, 0, -0.3, 0.50, 0.15, 0.12, 45), (2, 1.0, 1, 0, -0.5, 0.50, 0.12, 0.09, 50),
        (0, 0.95, -1, 0, -0.3, 0.50, 0.15, 0.12, 45), (4, 1.0, -1, 0, -0.5, 0.50, 0.12, 0.09, 50),
        (0, 0.0, 0.42, 0, -1, 0.65, 0.19, 0.14, 25), (6, 1.0, 0.05, 0, -1, 0.65, 0.14, 0.10, 30),
        (0, 0.0, -0.42, 0, -1, 0.65, 0.19, 0.14, 25), (8, 1.0, -0.05, 0, -1, 0.65, 0.14, 0.10, 30),
    ],
    "heavy_biped": [
        (-1, 0.0, 0, 0, 1, 0.80, 0.40, 0.34, 10), (0, 1.2, 0, 0, 1, 0.22, 0.14, 0.24, 20),
        (0, 0.95, 1, 0, -0.3, 0.55, 0.19, 0.15, 45), (2, 1.0, 1, 0, -0.5, 0.40, 0.15, 0.13, 50),
        (0, 0.95, -1, 0, -0.3, 0.55, 0.19, 0.15, 45), (4, 1.0, -1, 0, -0.5, 0.40, 0.15, 0.13, 50),
        (0, 0.0, 0.45, 0, -1, 0.60, 0.24, 0.19, 25), (6, 1.0, 0.05, 0, -1, 0.50, 0.19, 0.15, 30),
        (0, 0.0, -0.45, 0, -1, 0.60, 0.24, 0.19, 25), (8, 1.0, -0.05, 0, -1, 0.50, 0.19, 0.15, 30),
    ],
    "quadruped": [
        (-1, 0.0, 0, 1, 0, 1.20, 0.26, 0.28, 12), (0, 1.0, 0, 1, 0.9, 0.45, 0.17, 0.15, 25),
        (1, 1.0, 0, 1, -0.1, 0.28, 0.19, 0.12, 25), (0, 0.0, 0, -1, 0.4, 0.85, 0.10, 0.06, 45),
        (0, 0.95, 0.45, 0.1, -1, 0.50, 0.16, 0.12, 25), (4, 1.0, 0.02, 0, -1, 0.45, 0.12, 0.09, 30),
        (0, 0.95, -0.45, 0.1, -1, 0.50, 0.16, 0.12, 25), (6, 1.0, -0.02, 0, -1, 0.45, 0.12, 0.09, 30),
        (0, 0.05, 0.45, -0.1, -1, 0.50, 0.17, 0.12, 25), (8, 1.0, 0.02, 0, -1, 0.45, 0.12, 0.09, 30),
        (0, 0.05, -0.45, -0.1, -1, 0.50, 0.17, 0.12, 25), (10, 1.0, -0.02, 0, -1, 0.45, 0.12, 0.09, 30),
    ],
    "long_neck": [
        (-1, 0.0, 0, 1, 0, 0.95, 0.30, 0.30, 10), (0, 1.0, 0, 0.6, 1, 1.25, 0.20, 0.12, 25),
        (1, 1.0, 0, 1, -0.3, 0.32, 0.14, 0.09, 25), (0, 0.0, 0, -1, -0.5, 0.40, 0.08, 0.06, 35),
        (0, 0.95, 0.4, 0.1, -1, 0.70, 0.16, 0.11, 20), (4, 1.0, 0.02, 0, -1, 0.65, 0.11, 0.08, 25),
        (0, 0.95, -0.4, 0.1, -1, 0.70, 0.16, 0.11, 20), (6, 1.0, -0.02, 0, -1, 0.65, 0.11, 0.08, 25),
        (0, 0.05, 0.4, -0.1, -1, 0.70, 0.17, 0.11, 20), (8, 1.0, 0.02, 0, -1, 0.65, 0.11, 0.08, 25),
        (0, 0.05, -0.4, -0.1, -1, 0.70, 0.17, 0.11, 20), (10, 1.0, -0.02, 0, -1, 0.65, 0.11, 0.08, 25),
    ],
    "octopod": [
        (-1, 0.0, 0, 0, 1, 0.35, 0.34, 0.42, 8),
        *((0, 0.0, np.cos(a), np.sin(a), -0.35, 0.75, 0.17, 0.11, 18) for a in 2 * np.pi * np.arange(6) / 6),
        *((k, 1.0, np.cos(a), np.sin(a), -0.5, 0.75, 0.11, 0.06, 35)
          for k, a in zip(range(1, 7), 2 * np.pi * np.arange(6) / 6, strict=True)),
    ],
    "worm": [
        (-1, 0.0, 1, 0, 0, 0.6, 0.16, 0.20, 30), (0, 1.0, 1, 0, 0, 0.6, 0.20, 0.21, 35), (1, 1.0, 1, 0, 0, 0.6, 0.21, 0.21, 35),
        (2, 1.0, 1, 0, 0, 0.6, 0.21, 0.20, 35), (3, 1.0, 1, 0, 0, 0.6, 0.20, 0.15, 35), (4, 1.0, 1, 0, 0, 0.5, 0.15, 0.08, 35),
    ],
}
# fmt: on


def articulated_body(body: str = "biped", pose: int = 0, bending: float = 1.0, vertices: int = 2000) -> Surface:
    """Mesh the skin of a body with bones in one of many nearly isometric poses; closed, genus 0.

    Every bone keeps its length and thickness and turns at its joint, so that poses are isometric but for the skin near
    joints. Where limbs of a pose would touch, all its turns become smaller until the skin is a sphere in topology.

    Parameters
    ----------
    body : str
        A name of `BODIES`.
    pose : int
        Seed of the turns; 0 is the pose at rest.
    bending : float
        Factor of all turns.
    vertices : int

    Raises
    ------
    ValueError
        If the body is unknown, a number is out of bounds, or no pose without touching limbs was found.
    """
    if body not in BODIES:
        raise ValueError(f"body {body!r} is unknown, choose one of {', '.join(BODIES)}")
    if pose < 0 or bending < 0 or vertices < FEWEST_VERTICES:
        raise ValueError(
            f"pose = {pose}, bending = {bending:g}, vertices = {vertices}: at least 0, 0 and {FEWEST_VERTICES} are needed"
        )
    rest = _skin(posed_bones(body, 0, 0.0), vertices)
    for attempt in range(ATTEMPTS):
        factor = bending * STIFFER**attempt
        mesh = _skin(posed_bones(body, pose, factor), vertices) if pose else rest
        change = mesh.area / rest.area - 1.0
        if mesh.component_count == 1 and mesh.genus == 0 and abs(change) < LARGEST_CHANGE:
            notes = (f"Limbs touched: turns were reduced to {factor / bending:.2f} of their size.",) if attempt else ()
            name = f"{body.replace('_', ' ')}, pose {pose}"
            return replace(with_metrics(Surface(mesh, name, metrics={"area_change": change})), notes=notes)
    raise ValueError(f"pose {pose} of {body!r}: limbs touch at any bending, take another pose")


def posed_bones(body: str, pose: int, bending: float = 1.0) -> Floats:
    """(k, 9) round cones of a pose, as `round_cones` takes them."""
    return _posed(body, pose, bending)[0]


def carried_body(body: str = "biped", pose: int = 1, bending: float = 1.0, vertices: int = 2000) -> Surface:
    """Carry the skin of the pose at rest along by the bones of another: vertex i is vertex i of the body at rest.

    Each vertex moves with the bones that it is near to, blended over `BLEND` (linear blend skinning), so that the map
    between the two surfaces is known and is an isometry but for the skin near joints.
    """
    rest = articulated_body(body, 0, vertices=vertices)
    bones, _ = _posed(body, 0, 0.0)
    cones, rotations = _posed(body, pose, bending)
    points = rest.mesh.vertices
    depths = np.stack([round_cones(points, bone[None]) for bone in bones], axis=1)
    shares = np.exp((depths.min(axis=1, keepdims=True) - depths) / (0.5 * BLEND))
    shares /= shares.sum(axis=1, keepdims=True)
    carried = np.stack(
        [cone[:3] + (points - bone[:3]) @ turn.T for bone, cone, turn in zip(bones, cones, rotations, strict=True)]
    )
    moved = np.einsum("vk,kvd->vd", shares, carried)
    name = f"{body.replace('_', ' ')}, carried to pose {pose}"
    return with_metrics(Surface(TriangleMesh(moved, rest.mesh.faces), name))


def _posed(body: str, pose: int, bending: float) -> tuple[Floats, Floats]:
    """Round cones (k, 9) of a pose, and the rotations (k, 3, 3) of its bones from the pose at rest."""
    from scipy.spatial.transform import Rotation

    rng = np.random.default_rng([pose, *body.encode()])
    cones: list[Floats] = []
    frames: list[Rotation] = []
    for parent, along, x, y, z, length, thick, thin, freedom in BODIES[body]:
        axis = rng.normal(size=3)
        angle = np.radians(freedom) * bending * rng.uniform(-1.0, 1.0)
        turn = Rotation.from_rotvec(angle * axis / np.linalg.norm(axis))
        root = int(parent) < 0
        frame = turn if root else frames[int(parent)] * turn
        direction = frame.apply(np.array([x, y, z]) / np.linalg.norm([x, y, z]))
        before = cones[int(parent)] if not root else None
        start = np.zeros(3) if before is None else before[:3] + along * (before[3:6] - before[:3])
        cones.append(np.concatenate([start, start + length * direction, [thick, thin, BLEND]]))
        frames.append(frame)
    return np.array(cones), np.array([frame.as_matrix() for frame in frames])


def _skin(cones: Floats, vertices: int) -> TriangleMesh:
    reach = cones[:, 6:8].max() + 3.0 * GRID
    ends = np.concatenate([cones[:, :3], cones[:, 3:6]])
    lower, upper = ends.min(axis=0) - reach, ends.max(axis=0) + reach
    return mesh_implicit(lambda points: round_cones(points, cones), lower.tolist(), upper.tolist(), GRID, vertices)
