"""The dual ascent of a primal-dual method on several threads."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from functools import partial
from itertools import pairwise

import numpy as np

from surfexp.contract.arrays import Floats
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.variational.solvers.face_sweeps import dual_ascent, face_steps


class ThreadedAscent:
    """`dual_ascent` over runs of faces at once: each has a load of its own, which are then added in their order.

    The result is the same at every run; it differs from that of one thread by rounding.

    Parameters
    ----------
    operator : SurfaceOperator
    channels : int
    threads : int
        1 adds nothing to the plain sweep.

    Raises
    ------
    ValueError
        If there are more threads than faces, or none.
    """

    def __init__(self, operator: SurfaceOperator, channels: int, threads: int) -> None:
        count = len(operator.faces)
        if not 1 <= threads <= count:
            raise ValueError(f"threads = {threads} for {count} faces, take 1 to {count}")
        ends = np.linspace(0, count, threads + 1).astype(int)
        self._runs = [slice(start, stop) for start, stop in pairwise(ends)]
        fields = operator.faces, operator.hat_gradients, operator.areas, face_steps(operator.hat_gradients)
        self._fields = [tuple(field[run] for field in fields) for run in self._runs]
        self._loads = np.zeros((threads - 1, operator.vertex_count, channels))
        self._pool = ThreadPoolExecutor(threads) if threads > 1 else None

    def __call__(self, step: float, values: Floats, dual: Floats, load: Floats) -> None:
        """Set p <- P(p + step s_T G phi) and leave its load; shapes (n, c), (m, c, 2), (n, c)."""
        if self._pool is None:
            dual_ascent(*self._fields[0], step, values, dual, load)
            return
        loads = [load, *self._loads]
        jobs = [
            self._pool.submit(partial(dual_ascent, *fields, step, values, dual[run], part))
            for fields, run, part in zip(self._fields, self._runs, loads, strict=True)
        ]
        for job in jobs:
            job.result()
        for part in self._loads:
            load += part

    def close(self) -> None:
        """End the threads."""
        if self._pool is not None:
            self._pool.shutdown()
