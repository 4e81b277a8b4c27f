"""Commands on a mesh of a million vertices: seconds, memory, and the share that is not starting, reading, judging and writing."""

from __future__ import annotations

import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

import surfexp as sx
from audits.benchmarks.line import Line
from audits.benchmarks.measurement import Cost
from surfexp.contract.arrays import Floats
from surfexp.mesh.shapes.torus import torus
from surfexp.mesh.surface import Surface

COMMAND = (sys.executable, "-m", "surfexp.commands.command_line")
AROUND, QUICK_AROUND = 1580, 40
LEAST_SHARE = 0.5
# of ru_maxrss
UNIT_OF_MEMORY = 1024 if sys.platform.startswith("linux") else 1
FINISHED = (0, 3)
Call = Callable[[Surface, Floats], object]
# the words of a command, and the call of the face that is its mathematics
# a process begins with the peak memory of the one that starts it: so one that is small stands between
WATCH = """
import os, sys
pid = os.fork()
if not pid:
    null = os.open(os.devnull, os.O_RDWR)
    os.dup2(null, 1), os.dup2(null, 2)
    os.execv(sys.argv[1], sys.argv[1:])
_, status, usage = os.wait4(pid, 0)
print(os.waitstatus_to_exitcode(status), usage.ru_utime + usage.ru_stime, usage.ru_maxrss)
"""
CALLS: tuple[tuple[str, Call], ...] = (
    ("noise {mesh} {map}", sx.noise),
    ("smooth {mesh} {map} --width 0.1 --to out.npy", lambda surface, values: sx.smooth(surface, values, 0.1)),
    ("denoise {mesh} {map} --to out.npy", sx.denoise),
    (
        "denoise {mesh} {map} --method rof --to out.npy",
        lambda surface, values: sx.denoise(surface, values, method="rof"),
    ),
    ("segment {mesh} {map} --to out.npy", sx.segment),
    ("curvature {mesh} --to out.npy", lambda surface, _: sx.mean_curvature(surface)),
    ("geodesic {mesh} 0 --to out.npy", lambda surface, _: sx.geodesic(surface, [0])),
    (
        "skeleton {mesh} {clean} --to out.graphml",
        lambda surface, _: sx.reeb_graph(surface, surface.mesh.vertices[:, 0]),
    ),
    ("modes {mesh} -k 50 --to out.npz", lambda surface, _: sx.eigenpairs(surface, 50)),
)


def warm_up() -> None:
    """Compile what the commands use."""
    lines(quick=True)


def lines(quick: bool) -> list[Line]:
    """Return a line for each command."""
    around = QUICK_AROUND if quick else AROUND
    surface = torus(n_u=around, n_v=around * 2 // 5)
    clean = surface.mesh.vertices[:, 0].copy()
    noisy = clean + 0.1 * np.random.default_rng(0).standard_normal(len(clean))
    with TemporaryDirectory() as folder:
        files = {"mesh": str(Path(folder) / "mesh.ply")}
        sx.write(files["mesh"], surface)
        for name, values in (("map", noisy), ("clean", clean)):
            files[name] = str(Path(folder) / f"{name}.npy")
            np.save(files[name], values)
        judged = sx.read(files["mesh"])
        return [_line(words, files, folder, call, judged, noisy) for words, call in CALLS]


def _line(words: str, files: dict[str, str], folder: str, call: Call, surface: Surface, values: Floats) -> Line:
    begin = time.perf_counter()
    cpu, memory = _command(words.format(**files).split(), folder)
    wall = time.perf_counter() - begin
    begin = time.perf_counter()
    call(surface, values)
    share = (time.perf_counter() - begin) / wall
    shown = words.format(mesh="MESH", map="MAP", clean="MAP").partition(" --to")[0]
    return Line(
        f"surfexp {shown}, {len(values):,} V",
        "a limit",
        f"≥ {100 * LEAST_SHARE:.0f} % mathematics",
        f"{wall:.3g} s, {memory / 2**30:.2f} GiB, {100 * share:.0f} % mathematics",
        share >= LEAST_SHARE,
        Cost(cpu, wall),
        None,
        "the mathematics is the call of the face on a surface that was read and judged before",
    )


def _command(words: list[str], folder: str) -> tuple[float, float]:
    """Processor seconds and peak bytes of one command, compiled code read from its cache."""
    done = subprocess.run(
        (sys.executable, "-I", "-c", WATCH, *COMMAND, *words), cwd=folder, capture_output=True, text=True, check=True
    )
    code, seconds, memory = done.stdout.split()
    if int(code) not in FINISHED:
        raise RuntimeError(f"surfexp {' '.join(words)} ended with {code}")
    return float(seconds), float(memory) * UNIT_OF_MEMORY
