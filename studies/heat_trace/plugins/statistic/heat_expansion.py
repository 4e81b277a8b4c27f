"""The heat trace and its expansion, theorem 3.1.2."""

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp_studies.heat_trace.heat_expansion import heat_expansion

METRICS = {
    "corrected_error": Metric("mean relative error of the corrected expansion", better="lower"),
    "published_error": Metric("mean relative error of the published expansion", better="lower"),
    "area": Metric("area", "unit of length squared"),
    "area_heard": Metric("area heard from the eigenvalues", "unit of length squared"),
    "area_ratio": Metric("area heard over the true one"),
    "constant": Metric("constant term of the expansion"),
    "constant_heard": Metric("constant term heard from the eigenvalues"),
    "constant_off": Metric("error of the constant term heard", better="lower"),
    "boundary_length": Metric("length of the boundary", "unit of length"),
    "boundary_heard": Metric("length of the boundary heard from the eigenvalues", "unit of length"),
    "boundary_ratio": Metric("length of the boundary heard over the true one"),
    "complete": Metric("1 where it is proved that no eigenvalue is missing, else 0", better="higher"),
}


register("statistic", "heat_expansion", metrics=METRICS, options={}, names={"system": "eigensolver"})(heat_expansion)
