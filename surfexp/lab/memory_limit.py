"""The memory that the system lets a command have (`ulimit -v`), asked before libraries end the process for want of it."""

from __future__ import annotations

# measured with one and two threads; below them LLVM and OpenBLAS end the process in words of their own
LEAST_FOR_NUMERICS, LEAST_FOR_RUNS = 600_000_000, 1_000_000_000


def require_memory(least: int) -> None:
    """Refuse to go on where fewer bytes of address space are allowed.

    Parameters
    ----------
    least : int

    Raises
    ------
    MemoryError
        Naming both.
    """
    allowed = _allowed()
    if allowed is not None and allowed < least:
        raise MemoryError(f"{allowed / 1e6:.0f} MB are allowed by ulimit -v, {least / 1e6:.0f} MB are needed at least")


def _allowed() -> int | None:
    try:
        import resource
    except ImportError:  # not on Windows
        return None
    soft = resource.getrlimit(resource.RLIMIT_AS)[0]
    return None if soft == resource.RLIM_INFINITY else int(soft)
