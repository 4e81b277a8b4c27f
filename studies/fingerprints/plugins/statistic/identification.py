"""Who is recognised by a descriptor."""

from typing import Annotated, Literal

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp_studies.fingerprints.identification import identification

METRICS = {
    "people": Metric("people"),
    "rank_one": Metric("share recognised over all changes", better="higher"),
    "rank_one_low": Metric("lower end of its 95 % interval"),
    "rank_one_high": Metric("upper end of its 95 % interval"),
    "rank_one {change}": Metric("share recognised after a change", better="higher"),
    "rank_one_low {change}": Metric("lower end of its 95 % interval"),
    "rank_one_high {change}": Metric("upper end of its 95 % interval"),
    "centred_rank_one": Metric("share recognised where the mean over people is taken off", better="higher"),
    "centred_rank_one {change}": Metric("the same after a change", better="higher"),
    "icc": Metric("median over entries of ICC(2,1) over all changes", better="higher"),
    "icc_within": Metric("the same among the people of one donor, mean over donors", better="higher"),
    "constant_entries": Metric("entries in which nothing differs", better="lower"),
    "descriptors": Metric("descriptors computed by two routes"),
    "answers_changed": Metric("answers that are others with the usual solver", better="lower"),
    "usual_rank_one": Metric("share recognised over all changes with the usual solver", better="higher"),
    "usual_shift": Metric("largest distance of the two routes over the least distance of two people", better="lower"),
    "beyond_certificate": Metric("share of descriptors in which the routes differ by more than is certified"),
    "largest_certificate": Metric("largest certificate of an entry, relative to it", better="lower"),
}


register(
    "statistic",
    "identification",
    metrics=METRICS,
    options={
        "part": Annotated[
            Literal["area", "shape_dna", "brainprint", "nodal_counts", "heat_means", "wave_means", "hks", "wks", "gps"],
            Field("shape_dna", description="descriptor"),
        ],
        "alpha": Field(ge=0, le=4, description="entry n is divided by n^alpha, (4.3); 0: Euclidean"),
    },
)(identification)
