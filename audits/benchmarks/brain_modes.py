"""Four hundred modes of a cortex without its medial wall, from GIFTI files to an npz file, against neuromodes."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

import surfexp as sx
from audits.benchmarks.line import Line, not_installed, race
from audits.benchmarks.measurement import Cost, cost_of_children, measure_both
from surfexp.contract.arrays import Floats
from surfexp.mesh.shapes.icosphere import icosphere

RIVAL = "neuromodes as it installs"
WARM, FIRST = 16.0, 5.0
SIZES = {"32k": 400, "4k": 40}
FIRST_CALL = (
    "import sys; from audits.benchmarks.brain_modes import ours; ours(sys.argv[1], int(sys.argv[2]), sys.argv[3])"
)


def warm_up() -> None:
    """Compile what the lines use."""
    sx.eigenpairs(icosphere(3), 20)


def lines(quick: bool) -> list[Line]:
    """Return the line of a warm process and that of the first call of a new user."""
    density = "4k" if quick else "32k"
    count = SIZES[density]
    work = f"{count} modes of a masked fsLR-{density} cortex, from GIFTI to npz"
    names = f"{work}, in a warm process", f"{work}, the first call ever, with its start and compilation"
    if find_spec("neuromodes") is None:
        return [
            not_installed(name, RIVAL, least, "neuromodes") for name, least in zip(names, (WARM, FIRST), strict=True)
        ]
    with TemporaryDirectory() as folder:
        (values, cost), (theirs, their_cost) = measure_both(
            partial(ours, density, count, f"{folder}/ours.npz"), partial(neuromodes, density, count, folder)
        )
        first = _first_call(density, count, Path(folder))
    error = float(np.abs(values[1:] / theirs[1:] - 1.0).max())
    accuracy = f"largest relative difference of eigenvalues {error:.1e}; ours proved complete, residual at most 1e-8"
    first = Cost(first.cpu, first.wall, their_cost.runs)
    note = "the rival in a warm process here too"
    return [
        race(names[0], RIVAL, WARM, cost, their_cost, accuracy, fair=error < 1e-4),
        race(names[1], RIVAL, FIRST, first, their_cost, accuracy, fair=error < 1e-4, note=note),
    ]


def _files(density: str) -> tuple[Path, Path]:
    specification = find_spec("neuromodes")
    assert specification is not None and specification.origin is not None
    stem = Path(specification.origin).parent / "data" / f"sp-human_tpl-fsLR_den-{density}_hemi-L_"
    return Path(f"{stem}midthickness.surf.gii"), Path(f"{stem}medmask.label.gii")


def ours(density: str, count: int, target: str) -> Floats:
    """Read, mask, solve to 1e-8 with its proof, write."""
    surface, mask = _files(density)
    system = sx.eigenpairs(sx.read(surface, mask=mask), count)
    if not system.complete:
        raise RuntimeError("the modes are not proved complete")
    np.savez(target, values=system.values, vectors=system.vectors)
    return system.values


def neuromodes(density: str, count: int, folder: str) -> Floats:
    """The same by its documented calls."""
    import nibabel
    from neuromodes.eigen import EigenSolver

    surface, mask = _files(density)
    inside = nibabel.load(mask).darrays[0].data.astype(bool)
    solver = EigenSolver(surface, mask=inside).solve(count)
    np.savez(f"{folder}/theirs.npz", values=solver.evals, vectors=solver.emodes)
    return np.asarray(solver.evals)


def _first_call(density: str, count: int, folder: Path) -> Cost:
    """The cost of a process that finds no compiled code."""
    command = [sys.executable, "-c", FIRST_CALL, density, str(count), f"{folder}/first.npz"]
    environment = os.environ | {"XDG_CACHE_HOME": f"{folder}/cache"}
    environment.pop("NUMBA_CACHE_DIR", None)
    run: Callable[[], object] = partial(subprocess.run, command, check=True, env=environment)
    return cost_of_children(run)
