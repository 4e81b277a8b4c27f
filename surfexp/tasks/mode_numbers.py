"""The numbers of modes, under which pictures show them and files hold them."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from surfexp.spectrum.eigensystem import EigenSystem
    from surfexp.tasks.mode_alignment import ModeAlignment


def mode_numbers(modes: EigenSystem | ModeAlignment) -> range:
    """Return the number of each mode: the constant one is 0, and what stands without it begins with 1.

    The first of a window has the number of eigenvalues below it.

    Parameters
    ----------
    modes : EigenSystem or ModeAlignment

    Raises
    ------
    ValueError
        If there is none, as in a window between two eigenvalues.
    """
    count = modes.vectors.shape[1]
    if not count:
        raise ValueError("there are 0 eigenpairs, a picture or a map needs 1: take wider bounds")
    below = int(getattr(modes, "metrics", {}).get("first_number", 0))
    first = below + (getattr(modes, "boundary", "") != "neumann")
    return range(first, first + count)
