"""One small surface with a map in every format that is read: what the bad files are made from."""

from __future__ import annotations

import gzip
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np

import surfexp as sx
from surfexp.contract.arrays import Floats, Integers
from surfexp.io.label_files import write_labels
from surfexp.io.writing import write_mesh
from surfexp.io.written_maps import write_maps

MESHES = ("a.off", "a.obj", "a.ply", "a.stl", "a.surf.gii", "a.vtk", "a.vtp", "a.npz", "lh.white", "a.tri")
MAPS = ("m.shape.gii", "m.npy", "m.npz", "m.csv", "m.txt", "m.mgh", "m.mgz", "lh.curv", "m.dscalar.nii")
LABELS = ("p.label.gii", "lh.p.annot", "lh.p.label")
# without a count of what follows, or where a number may end anywhere: a cut file may be a whole one
UNCOUNTED = ("a.obj", "a.tri", "m.csv", "m.txt")


@dataclass(frozen=True, eq=False)
class Truth:
    """What a reader should find in the sound files."""

    vertices: Floats
    faces: Integers
    values: Floats
    labels: Integers


@cache
def truth() -> Truth:
    """A bumpy sphere of 42 vertices, its height, and three regions."""
    mesh = sx.shape("icosphere", levels=1).mesh
    vertices = mesh.vertices * (1.0 + 0.2 * mesh.vertices[:, :1])
    vertices = vertices.astype(np.float32).astype(np.float64)
    height = vertices[:, 2].astype(np.float32).astype(np.float64)
    return Truth(vertices, mesh.faces, height, np.digitize(height, [-0.4, 0.4]))


def write_sound_files(folder: Path) -> dict[str, bytes]:
    """Write the surface in every format; return the bytes by name."""
    known = truth()
    mesh = sx.shape("icosphere", levels=1).mesh
    mesh = type(mesh)(known.vertices, known.faces)
    for name in MESHES:
        if name == "a.tri":
            _write_tosca(folder, known)
        else:
            write_mesh(folder / name, mesh)
    for name in MAPS:
        write_maps(folder / name, {"height": known.values}, "left")
    for name in LABELS[:2]:
        write_labels(folder / name, known.labels, ["unknown", "low", "high"])
    inside = np.flatnonzero(known.labels == 2)
    rows = "".join(
        f"{v} {x:.3f} {y:.3f} {z:.3f} 0.0\n" for v, (x, y, z) in zip(inside, known.vertices[inside], strict=True)
    )
    (folder / LABELS[2]).write_text(f"#!ascii label\n{len(inside)}\n{rows}")
    found = {file.name: file.read_bytes() for file in sorted(folder.iterdir())}
    for name in ("a.surf.gii", "m.shape.gii"):
        found[f"{name}.gz"] = gzip.compress(found[name], mtime=0)
    return found


def _write_tosca(folder: Path, known: Truth) -> None:
    (folder / "a.vert").write_text("".join(f"{x:.9g} {y:.9g} {z:.9g}\n" for x, y, z in known.vertices))
    (folder / "a.tri").write_text("".join(f"{a + 1} {b + 1} {c + 1}\n" for a, b, c in known.faces))
