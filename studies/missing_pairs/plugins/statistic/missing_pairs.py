"""Eigenpairs that the usual solver leaves out."""

from typing import Annotated

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp_studies.missing_pairs.missing_pairs import missing_by_kind, missing_pairs

METRICS = {
    "runs": Metric("runs of the usual solver"),
    "runs_with_missing": Metric("runs that leave an eigenpair out", better="lower"),
    "runs_with_surplus": Metric("runs that return an eigenpair too often", better="lower"),
    "runs_without_result": Metric("runs that end without a result", better="lower"),
    "missing": Metric("most eigenpairs that a run leaves out", better="lower"),
    "value_error": Metric("largest relative error of a value that is returned", better="lower"),
    "span_sine": Metric("largest sine between a returned vector and the certified ones", better="lower"),
}
BY_KIND_METRICS = METRICS | {
    "meshes": Metric("meshes"),
    "runs_with_missing {kind}": Metric("runs that leave an eigenpair out, on one kind of mesh", better="lower"),
    "missing_share": Metric("runs that leave an eigenpair out", "%", "lower"),
    "missing_share_highest": Metric("upper end of the 95 % interval of their share", "%", "lower"),
}


register(
    "statistic",
    "missing_pairs",
    metrics=METRICS,
    options={
        "counts": Annotated[tuple[int, ...], Field(min_length=1, description="numbers of pairs")],
        "seeds": Field(ge=1, le=1000, description="start vectors for each"),
    },
    names={"certified": "eigensolver"},
)(missing_pairs)


register("statistic", "missing_by_kind", metrics=BY_KIND_METRICS, options={})(missing_by_kind)
