"""How often an ambiguous map is called so, and how often one is that is not: pairs with known truth.

Run with `python -m audits.benchmarks.map_ambiguity [FOLDER ...]`. Pairs are generated bodies in two poses and swollen ellipsoids
meshed anew, at two resolutions, symmetric by construction or lopsided on purpose; folders hold poses of one body with equal
numbering, which are symmetric, and lopsided where one flank is swollen by the same vertices in both poses.

The rule, stated before the run: pairs are divided by the parity of their number. On the even half the share of energies
within which two maps are called indistinct is that of the largest sum of the two rates of right answers; of several the
middle one. The odd half judges it.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

from surfexp.contract.arrays import Floats
from surfexp.embedding.rival_maps import INDISTINCT_SHARE, NEGLIGIBLE_ENERGY
from surfexp.embedding.surface_map import Pair, contested
from surfexp.io.reading import read_mesh
from surfexp.mesh.repair import repair
from surfexp.mesh.shapes.ellipsoid import ellipsoid
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.elements_surface import surface_elements
from surfexp.populations.articulated import BODIES, articulated_body
from surfexp.populations.disguise import disguise
from surfexp.spectrum.eigensolver import eigenpairs

# bones of a left limb; without a nose the bodies on two legs have front and back alike, too
LIMBS = {"biped": (2, 3), "heavy_biped": (6, 7), "quadruped": (4, 5), "long_neck": (8, 9)}
NOSE = (1, 0.8, 0, 1, 0, 0.35, 0.12, 0.08, 0)
LONGER, POSES, SHAPES, MODES, COORDINATES = 1.3, 8, 24, 41, 10
SHARES = np.round(np.arange(0.02, 2.0, 0.01), 2)


@dataclass(frozen=True, eq=False)
class Case:
    """Two surfaces, and whether a symmetry makes the map between them ambiguous."""

    family: str
    number: int
    symmetric: bool
    source: Surface
    target: Surface


def bodies() -> Iterator[Case]:
    """Yield pairs of poses, of a body and of the same with one limb longer."""
    for body, limb in LIMBS.items():
        lopsided = f"{body}, lopsided"
        bones = [list(bone) for bone in BODIES[body]]
        for k in limb:
            bones[k][5] *= LONGER
        BODIES[lopsided] = [*(tuple(bone) for bone in bones), *([NOSE] if "biped" in body else [])]
        for pose in range(1, POSES + 1):
            count = 1000 if pose % 4 < 2 else 2000
            for name in (body, lopsided):
                surfaces = [articulated_body(name, stand, vertices=count) for stand in (0, 20 + pose)]
                yield Case("bodies", pose, name == body, *surfaces)


def swollen(seed: int, symmetric: bool) -> Surface:
    """Return an ellipsoid swollen by random waves, mirrored in x if it is to be symmetric."""
    rng = np.random.default_rng(seed)
    mesh = ellipsoid(3 + seed // 2 % 2, tuple(rng.uniform(0.6, 1.6, 3))).mesh
    waves, phases = 1.2 * rng.normal(size=(6, 3)), rng.uniform(0.0, 2.0 * np.pi, 6)

    def swelling(points: Floats) -> Floats:
        return np.asarray(0.12 * np.sin(points @ waves.T + phases).sum(axis=1))

    field = swelling(mesh.vertices)
    if symmetric:
        field = 0.5 * (field + swelling(mesh.vertices * [-1.0, 1.0, 1.0]))
    return Surface(TriangleMesh(mesh.vertices * np.exp(field)[:, None], mesh.faces), f"ellipsoid {seed}")


def ellipsoids() -> Iterator[Case]:
    """Yield swollen ellipsoids and themselves meshed anew."""
    for seed in range(SHAPES):
        for symmetric in (True, False):
            source = swollen(100 + seed, symmetric)
            yield Case("ellipsoids", seed, symmetric, source, disguise(source, remeshed=True, seed=seed))


def flank_swelling(mesh: TriangleMesh) -> Floats:
    """Return weights about the vertex farthest to one side of the plane in which a body is most nearly symmetric."""
    points = mesh.vertices - mesh.vertices.mean(axis=0)
    mirrored = [points * np.where(np.arange(3) == axis, -1.0, 1.0) for axis in range(3)]
    lateral = int(np.argmin([cKDTree(points).query(image)[0].mean() for image in mirrored]))
    middle = points[np.abs(points[:, lateral]).argmax()]
    reach = 0.12 * np.sqrt(mesh.area)
    return np.asarray(np.exp(-(((points - middle) ** 2).sum(axis=1)) / reach**2))


def poses(folders: list[str]) -> Iterator[Case]:
    """Yield the first body of each folder with every other one."""
    for folder in folders:
        files = sorted(Path(folder).iterdir())
        meshes = [repair(*read_mesh(path)[:2], largest_component=True).mesh for path in files]
        meshes = [mesh for mesh in meshes if len(mesh.vertices) == len(meshes[0].vertices)]
        weights = flank_swelling(meshes[0])
        for number, mesh in enumerate(meshes[1:], 1):
            yield Case("poses", number, True, Surface(meshes[0], folder), Surface(mesh, folder))
            pair = []
            for one in (meshes[0], mesh):
                push = 0.12 * np.sqrt(one.area) * weights[:, None] * one.vertex_normals
                pair.append(Surface(TriangleMesh(one.vertices + push, one.faces), folder))
            yield Case("poses", number, False, *pair)


def energy_ratio(case: Case) -> float:
    """Return the larger over the smaller energy of the best two maps, less one; infinite where there is only one."""
    systems = []
    for surface in (case.source, case.target):
        elements = surface_elements(surface.mesh)
        systems.append(eigenpairs(elements.stiffness, elements.mass, MODES))
    pair = Pair(case.source, case.target, *systems)
    found = contested(pair, pair.optimal(COORDINATES, 1500, 0), COORDINATES).metrics
    if "rival_energy" not in found:
        return float("inf")
    less, more = sorted((found["map_energy"], found["rival_energy"]))
    return more / max(less, NEGLIGIBLE_ENERGY) - 1.0


def rates(ratios: Floats, symmetric: np.ndarray, share: float) -> tuple[float, float]:
    """Return the share of ambiguous pairs that are called so, and that of the others that are."""
    said = ratios <= share
    return float(said[symmetric].mean()), float(said[~symmetric].mean())


def main() -> None:
    """Print every pair, the rates by family, and what the rule chooses."""
    cases, ratios = [], []
    for source in (bodies(), ellipsoids(), poses(sys.argv[1:])):
        for case in source:
            cases.append((case.family, case.number, case.symmetric))
            ratios.append(energy_ratio(case))
            size = f"{len(case.source.mesh.vertices)} {len(case.target.mesh.vertices)}"
            print(*cases[-1], case.source.name, size, f"{ratios[-1]:.3f}", flush=True)
    values, symmetric = np.array(ratios), np.array([case[2] for case in cases])
    families, even = np.array([case[0] for case in cases]), np.array([case[1] % 2 == 0 for case in cases])
    scores = [said - alarms for said, alarms in (rates(values[even], symmetric[even], share) for share in SHARES)]
    best = SHARES[np.isclose(scores, max(scores))]
    chosen = float(best[len(best) // 2])
    print(f"chosen on the even half: {chosen:g} of {best[0]:g} to {best[-1]:g}")
    for share in dict.fromkeys((INDISTINCT_SHARE, chosen)):
        for name in (*dict.fromkeys(families), "all"):
            part = ~even & ((families == name) | (name == "all"))
            said, alarms = rates(values[part], symmetric[part], share)
            print(f"| {share:g} | {name} | {part.sum()} | {said:.2f} | {alarms:.2f} |")


if __name__ == "__main__":
    main()
