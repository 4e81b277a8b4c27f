"""Maps rebuilt from modes of their own surface and of other geometries."""

from typing import Annotated

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp_studies.geometric_modes.geometric_modes import mode_reconstruction, reconstruction_differences

METRICS = {
    "area {map}, {basis}": Metric("mean accuracy of a map over log of the number of modes", better="higher"),
    "end {map}, {basis}": Metric("accuracy of a map by all modes", better="higher"),
    "{basis} less {other}, {map}": Metric("area of one basis less that of another, on one map"),
}
DIFFERENCE_METRICS = {
    "maps": Metric("maps that the intervals are drawn from"),
    "{basis} less {other}": Metric("area of one basis less that of another, mean over maps; or an end of its interval"),
}


register(
    "statistic",
    "mode_reconstruction",
    metrics=METRICS,
    options={
        "maps": Annotated[tuple[str, ...], Field((), description="maps of the surface")],
        "twins": Annotated[
            tuple[str, ...], Field(description="bases of whose modes random maps are made: own, or a class")
        ],
        "seeds": Field(ge=1, le=1000, description="random maps of each"),
        "first": Field(ge=1, le=5000, description="fewest modes"),
        "last": Field(ge=2, le=5000, description="most modes"),
    },
    names={"own": "eigensolver"},
)(mode_reconstruction)


register(
    "statistic",
    "reconstruction_differences",
    metrics=DIFFERENCE_METRICS,
    options={
        "maps": Annotated[
            tuple[str, ...],
            Field(
                (
                    "thickness",
                    "sulc",
                ),
                min_length=2,
                description="maps, drawn with replacement",
            ),
        ],
        "seed": Field(ge=0, description="seed of the draws"),
    },
)(reconstruction_differences)
