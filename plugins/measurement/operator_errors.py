"""The errors of a discrete operator on a function whose derivatives are known, chapter 1."""

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.mesh.surface import Surface
from surfexp.operators.diagnostics import adjointness_defect, null_modes
from surfexp.operators.manufactured import manufactured, operator_errors
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.statistics.measurement import Measurement

METRICS = {
    "edge_length": Metric("mean length of the edges", "unit of length"),
    "adjointness_defect": Metric("|G^T A + M D| over |G^T A|, Frobenius norm", better="lower"),
    "gradient_error": Metric("relative error of the gradient", better="lower"),
    "divergence_error": Metric("relative error of the divergence", better="lower"),
    "laplacian_error": Metric("relative error of the Laplacian", better="lower"),
    "laplacian_error_max": Metric("largest relative error of the Laplacian", better="lower"),
    "laplacian_error_weak": Metric("relative error of the Laplacian in the dual norm of H1", better="lower"),
    "null_modes": Metric("dimension of the kernel of the gradient", better="lower"),
}


@register("measurement", "operator_errors", metrics=METRICS, accepts={"surface": ("icosphere", "torus")})
def operator_errors_measurement(surface: Surface, operator: SurfaceOperator) -> Measurement:
    """Relative errors of gradient, divergence and Laplacian on a sphere or torus, adjointness defect and null modes."""
    metrics = {"edge_length": operator.edge_length, "adjointness_defect": adjointness_defect(operator)}
    metrics |= operator_errors(operator, manufactured(surface))
    if operator.vertex_count <= 3000:
        metrics["null_modes"] = float(null_modes(operator))
    return Measurement(operator.name, metrics)
