"""A signature: what is compared of a shape, as one row of numbers."""

from __future__ import annotations

from dataclasses import dataclass, field

from surfexp.contract.arrays import Floats


@dataclass(frozen=True, eq=False)
class Signature:
    """Numbers that stand for a shape.

    Parameters
    ----------
    values : (d,) float64
        The signature.
    name : str
        Its kind: "shape_dna", "nodal_counts", "area", ...
    parts : dict of str to float64 array
        Other signatures of the same shape, by kind, where several were computed at once.
    metrics, notes
        As in `Surface`.
    """

    values: Floats
    name: str = ""
    parts: dict[str, Floats] = field(default_factory=dict)
    metrics: dict[str, float] = field(default_factory=dict)
    notes: tuple[str, ...] = ()

    def part(self, name: str = "") -> Floats:
        """Return the values of one part, or of the signature itself.

        Raises
        ------
        ValueError
            If there is no such part.
        """
        if name in ("", self.name):
            return self.values
        if name not in self.parts:
            known = ", ".join(sorted({self.name, *self.parts}))
            raise ValueError(f"signature {self.name!r} has no part {name!r}, choose one of {known}")
        return self.parts[name]
