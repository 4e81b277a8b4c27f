"""A cohort: the spectra of many surfaces from a table, through `surfexp run`, killed once and resumed."""

from __future__ import annotations

import csv
import json
import os
import signal
import subprocess
import sys
import time
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from audits.benchmarks.line import Line
from audits.benchmarks.measurement import cost_of_children
from surfexp.anatomy.subcortical import subcortical_surface
from surfexp.contract.arrays import Floats
from surfexp.io.ply import write_ply
from surfexp.lab.store import store
from surfexp.mesh.triangle_mesh import TriangleMesh

STRUCTURES = ("caudate", "putamen", "hippocampus", "thalamus", "amygdala")
DONOR, VERTICES, MODES = "9861", 2500, 50
PEOPLE, QUICK_PEOPLE = 200, 3
LIMIT_SECONDS, LIMIT_GROWTH = 0.25, 100.0
EXPERIMENT = {
    "experiment": "cohort",
    "title": "Spectra of a cohort",
    "target": "classifier",
    "operator": "fem",
    "eigensolver": {"name": "slicing", "count": MODES},
    "signature": {"name": "shape_dna", "count": MODES - 1},
    "distance_matrix": {"name": "signatures", "inputs": {"signatures": {"dataset": "shapes"}}},
    "classifier": "nearest_neighbour",
    "datasets": {"shapes": []},
}


def warm_up() -> None:
    """Nothing is measured in this process."""


def lines(quick: bool) -> list[Line]:
    """Return the line of the cohort: wall seconds a surface on all processors of this machine."""
    people = QUICK_PEOPLE if quick else PEOPLE
    with TemporaryDirectory() as name:
        folder = Path(name)
        surfaces = write_cohort(folder, people)
        command = [
            sys.executable,
            "-m",
            "surfexp.commands.command_line",
            "run",
            "experiment=cohort",
            "datasets=cohort.csv",
        ]
        before = partial(_killed, command, folder, surfaces // 3)
        first = cost_of_children(before)
        kept = _certified(folder)[0]
        rest = cost_of_children(partial(subprocess.run, command, cwd=folder, check=True, stdout=subprocess.DEVNULL))
        spectra, residual, peaks = _certified(folder)
    seconds = (first.wall + rest.wall) / surfaces
    growth = float(np.median(peaks[-len(peaks) // 10 :]) - np.median(peaks[: len(peaks) // 10 + 1]))
    told = f"{spectra:,} of {surfaces:,} spectra of {MODES} modes proved complete, largest residual {residual:.1e}; "
    told += f"killed with {kept:,} spectra done and resumed, all of it counted; after that "
    told += f"{rest.cpu / (surfaces - kept):.2f} processor seconds a surface; "
    told += f"median peak memory of a stage {np.median(peaks):.0f} MB, "
    told += f"{growth:+.0f} MB from the first tenth to the last"
    met = seconds <= LIMIT_SECONDS and spectra == surfaces and growth <= LIMIT_GROWTH
    work = f"cohort: {surfaces:,} surfaces of {VERTICES:,} V, {MODES} modes each, from a table, wall seconds a surface"
    return [Line(work, "a limit", f"≤ {LIMIT_SECONDS:g} s", f"{seconds:.3g} s", met, None, accuracy=told)]


def write_cohort(folder: Path, people: int) -> int:
    """Write deformed copies of ten structures for each person, their table and the experiment; return their number."""
    random = np.random.default_rng(0)
    bases = {
        (what, side): subcortical_surface(DONOR, what, side).mesh for what in STRUCTURES for side in ("left", "right")
    }
    rows = []
    for person in range(people):
        for (structure, side), mesh in bases.items():
            path = f"{person:03}-{side}-{structure}.ply"
            write_ply(folder / path, TriangleMesh(_bent(mesh.vertices, random), mesh.faces))
            rows.append({"path": path, "class": structure, "group": f"{person:03}"})
    with (folder / "cohort.csv").open("w", newline="") as file:
        table = csv.DictWriter(file, list(rows[0]))
        table.writeheader()
        table.writerows(rows)
    (folder / "conf" / "experiment").mkdir(parents=True)
    (folder / "conf" / "experiment" / "cohort.yaml").write_text(json.dumps(EXPERIMENT))
    return len(rows)


def _bent(vertices: Floats, random: np.random.Generator) -> Floats:
    """A smooth one-to-one deformation of space: waves longer than the surface, of slopes under a half."""
    size = float(np.ptp(vertices, axis=0).max())
    waves, phases = random.uniform(-1.0, 1.0, (3, 3)) * np.pi / size, random.uniform(0.0, 2.0 * np.pi, 3)
    bent: Floats = vertices * random.uniform(0.9, 1.1, 3) + 0.05 * size * np.sin(vertices @ waves.T + phases)
    return bent


def _killed(command: list[str], folder: Path, spectra: int) -> None:
    """Run a command until so many spectra are stored, and kill it."""
    process = subprocess.Popen(command, cwd=folder, stdout=subprocess.DEVNULL, start_new_session=True)
    while process.poll() is None and len(_records(folder)) < spectra:
        time.sleep(0.5)
    os.killpg(process.pid, signal.SIGKILL)
    process.wait()


def _records(folder: Path) -> list[Path]:
    return list(folder.glob("results/store/eigensolver/*/record.json"))


def _certified(folder: Path) -> tuple[int, float, Floats]:
    """How many spectra are proved complete, the largest residual, and peak memory in MB by the time of the record."""
    complete, residual, peaks = 0, 0.0, []
    for record in sorted(_records(folder), key=lambda path: path.stat().st_mtime):
        system = store.load(folder / "results", "eigensolver", record.parent.name)
        complete += bool(system.complete) and len(system.values) == MODES
        residual = max(residual, float(system.residuals.max()))
        event = folder / "results" / "events" / "eigensolver" / f"{record.parent.name}.json"
        peaks.append(json.loads(event.read_text())["peak_memory_mb"])
    return complete, residual, np.array(peaks)
