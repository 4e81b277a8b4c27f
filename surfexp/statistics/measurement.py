"""What was measured on the results of other stages."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import ClassVar


@dataclass(frozen=True, eq=False)
class Measurement:
    """Numbers about a result that is not changed by measuring it.

    Parameters
    ----------
    subject : str
        What was measured, for captions.
    metrics : dict of str to float
        Those of the result that was measured, where it is a solver's, and what was measured.
    notes
        As in `Surface`.
    """

    subject: str
    metrics: dict[str, float] = field(default_factory=dict)
    notes: tuple[str, ...] = ()
    HANDED_ON: ClassVar[tuple[str, ...]] = ("solver",)
    """Kinds of inputs whose metrics stand among those of the measurement."""
