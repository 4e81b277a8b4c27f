"""Signs of modes of people where two maps agree."""

from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp_studies.modes_across_people.agreed_signs import agreed_signs

METRICS = {
    "agreed": Metric("leading modes that both maps call their own counterpart with the same sign, a pair"),
    "{rule} right": Metric("share of these with the sign of a rule", better="higher"),
}


register(
    "statistic",
    "agreed_signs",
    metrics=METRICS,
    options={
        "count": Field(ge=5, le=500, description="modes after the constant"),
    },
)(agreed_signs)
