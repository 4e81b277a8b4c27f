"""How far a denoised surface is from the clean one."""

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.fem import fem
from surfexp.statistics.measurement import Measurement
from surfexp.variational.image import Image
from surfexp.variational.normal_filtering import normal_deviation
from surfexp.variational.solution import Solution
from surfexp.variational.truth_metrics import restoration_metrics

METRICS = {
    "vertex_error_before": Metric(
        "root mean square distance of the noisy vertices to the clean ones", "unit of length"
    ),
    "vertex_error": Metric("root mean square distance of the vertices to the clean ones", "unit of length", "lower"),
    "normal_error_before": Metric("mean angle between noisy and clean face normals", "degrees"),
    "normal_error": Metric("mean angle between face normals and clean ones", "degrees", "lower"),
    "normal_error_share": Metric("angle between normals after over before", better="lower"),
}


@register("measurement", "geometry_error", metrics=METRICS)
def geometry_error(solver: Solution, noisy: Surface, clean: Surface) -> Measurement:
    """Distance and normals of the vertices that a solver found, measured against the clean surface."""
    truth = clean.mesh
    moved, before = TriangleMesh(solver.values, truth.faces), TriangleMesh(noisy.mesh.vertices, truth.faces)
    image = Image(before.vertices, clean=truth.vertices)
    errors = [restoration_metrics(image, fem(truth), mesh.vertices)["rmse"] for mesh in (before, moved)]
    metrics = {
        "vertex_error_before": errors[0],
        "vertex_error": errors[1],
        "normal_error_before": normal_deviation(before, truth),
        "normal_error": normal_deviation(moved, truth),
    }
    metrics["normal_error_share"] = metrics["normal_error"] / max(metrics["normal_error_before"], 1e-12)
    return Measurement(solver.solver, solver.metrics | metrics, solver.notes)
