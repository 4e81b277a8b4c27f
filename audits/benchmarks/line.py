"""A line of the table: work, rival, ratio and verdict."""

from __future__ import annotations

from dataclasses import dataclass

from audits.benchmarks.measurement import Cost


@dataclass(frozen=True)
class Line:
    """What one comparison gave.

    Parameters
    ----------
    work, rival : str
    target : str
        What is asked for.
    result : str
        What was seen, in the same terms.
    met : bool
    ours, theirs : Cost, optional
    accuracy : str
        Tolerances and the accuracy that both sides reached.
    note : str
    points : tuple of (float, float)
        How the seconds grow, for a figure: size and seconds.
    curve : str
        What the figure calls them.
    """

    work: str
    rival: str
    target: str
    result: str
    met: bool
    ours: Cost | None = None
    theirs: Cost | None = None
    accuracy: str = ""
    note: str = ""
    points: tuple[tuple[float, float], ...] = ()
    curve: str = ""

    def __post_init__(self) -> None:
        """Refuse medians of unequal numbers of runs."""
        if self.ours and self.theirs and self.ours.runs != self.theirs.runs:
            raise ValueError(
                f"{self.work}: ours is the median of {self.ours.runs} runs, the rival of {self.theirs.runs}"
            )

    @property
    def name(self) -> str:
        """Work and rival."""
        return f"{self.work}, {self.rival}"

    @property
    def verdict(self) -> str:
        """ "met" or "not met"."""
        return "met" if self.met else "not met"


def race(
    work: str, rival: str, least: float, ours: Cost, theirs: Cost, accuracy: str, *, fair: bool = True, note: str = ""
) -> Line:
    """Return the line whose ratio of processor seconds should be at least `least`; `fair` is any further condition."""
    ratio = theirs.cpu / ours.cpu
    return Line(work, rival, f"{least:g}×", f"{ratio:.1f}×", fair and ratio >= least, ours, theirs, accuracy, note)


def within(work: str, seconds: float, cost: Cost, accuracy: str, fair: bool) -> Line:
    """Return the line whose processor seconds should be at most `seconds`; `fair` is any further condition."""
    met = fair and cost.cpu <= seconds
    return Line(work, "a limit", f"≤ {seconds:.3g} s", f"{cost.cpu:.3g} s", met, cost, None, accuracy)


def not_installed(work: str, rival: str, least: float, packages: str) -> Line:
    """Return the line of a rival that cannot be run."""
    return Line(work, rival, f"{least:g}×", f"not installed: {packages}", met=False)
