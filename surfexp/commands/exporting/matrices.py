"""Eigensystems, operators, distances and skeletons, in the formats of NumPy, SciPy, VTK and graph programs."""

from __future__ import annotations

import numpy as np
from scipy.io import mmwrite
from scipy.sparse import save_npz

from surfexp.commands.exporting.writers import Place, arrays_of, write, write_arrays, write_csv
from surfexp.embedding.distance import Distance
from surfexp.operators.assembly import mass_matrix, stiffness
from surfexp.operators.calculus import gradient_matrix
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.skeleton.export import write_skeleton
from surfexp.skeleton.skeleton import Skeleton
from surfexp.spectrum.eigensystem import EigenSystem
from surfexp.tasks.written_files import write as write_result


@write.register
def _eigensystem(system: EigenSystem, place: Place) -> None:
    """`values`, `vectors` and `residuals` as .npz; values with residual and cluster (from 1, 0 is none) as .csv."""
    write_result(place.file(".npz"), system)
    cluster = np.zeros(len(system.values), dtype=np.int64)
    for number, (start, stop) in enumerate(system.clusters, 1):
        cluster[start:stop] = number
    rows = zip(range(len(system.values)), system.values, system.residuals, cluster, strict=True)
    write_csv(place.file("-values.csv"), ("mode", "value", "residual", "cluster"), rows)


@write.register
def _operator(operator: SurfaceOperator, place: Place) -> None:
    """Stiffness, mass and gradient (rows 2 f and 2 f + 1 belong to face f) as sparse .npz, by choice as .mtx too."""
    matrices = {"stiffness": stiffness(operator), "mass": mass_matrix(operator)}
    if operator.hats is not None:
        matrices["gradient"] = gradient_matrix(operator)
    if operator.averaged_gradient is not None:
        matrices |= {
            f"averaged_gradient_{axis}": one for axis, one in zip("xyz", operator.averaged_gradient, strict=True)
        }
    for name, matrix in matrices.items():
        save_npz(place.file(f"-{name}.npz"), matrix)
        if place.matrix_market:
            mmwrite(place.file(f"-{name}.mtx"), matrix, comment=f"{operator.name} {name}")


@write.register
def _distance(distance: Distance, place: Place) -> None:
    """Map, basis and embeddings as .npz; value, lower bound and proof as a row of .csv."""
    write_arrays(place.file(".npz"), arrays_of(distance))
    row = (distance.value, distance.lower_bound, distance.optimal, distance.evaluations, distance.method)
    write_csv(place.file(".csv"), ("value", "lower_bound", "optimal", "evaluations", "method"), [row])


@write.register
def _skeleton(skeleton: Skeleton, place: Place) -> None:
    """The graph as .vtk for viewers of surfaces, and as .graphml with all that is known of its nodes."""
    for suffix in (".vtk", ".graphml"):
        write_skeleton(place.file(suffix), skeleton)
