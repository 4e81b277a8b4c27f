"""Energy above a bound on the scale of the data term, which no model chooses."""

from __future__ import annotations

import numpy as np

from surfexp.operators.calculus import total_variation


def excess_over_data(fidelity, operator, values, lower_bound):
    """Return (energy - bound) / int |r|."""
    energy = total_variation(operator, values) + fidelity.value(values)
    return (energy - lower_bound) / float(operator.mass @ np.abs(fidelity.slope))
