"""`surfexp fingerprint`: the spectra of many structures as one CSV."""

from __future__ import annotations

import sys
import time
from pathlib import Path

import click

from surfexp.commands.certificate import Inputs, write_certificate
from surfexp.commands.click_command import shown
from surfexp.commands.given_maps import both_of
from surfexp.commands.surface_results import NOT_CERTIFIED
from surfexp.commands.terminal import echo

SPOKEN_EVERY = 30.0


@click.command(**shown("fingerprint", "$SUBJECTS_DIR -k 50 --to table.csv", "left.ply right.ply --to table.csv"))
@click.argument("sources", nargs=-1, required=True, type=click.Path())
@click.option("-k", "count", default=50, help="number of eigenvalues, ev0 = 0 among them")
@click.option("--tolerance", default=1e-8, help="largest relative residual")
@click.option("--strict", is_flag=True, help="leave defective meshes out instead of repairing them")
@click.option("--to", "target", type=click.Path(path_type=Path), required=True, help="the table, .csv")
def fingerprint(sources: tuple[str, ...], count: int, tolerance: float, strict: bool, target: Path) -> int:
    """Write area, volume and lowest eigenvalues of many surfaces as a table.

    SOURCES are files, LEFT+RIGHT, a folder, a SUBJECTS_DIR or BIDS derivatives. Each hemisphere has a column of its own.

    Of FreeSurfer subjects surf/?h.white, surf/?h.pial and the structures of mri/aseg.mgz are taken.

    The layout is BrainPrint's, a column a structure, with the rows residual, complete and repairs below.
    """
    from surfexp.io.replacing import check_writable
    from surfexp.mesh.given_numbers import whole_number
    from surfexp.tasks.fingerprint_sources import structures
    from surfexp.tasks.fingerprints import fingerprint as task

    if target.suffix != ".csv":
        raise ValueError(f"{target} has an unknown format, choose .csv")
    check_writable(target)
    count = whole_number(count, "count", 1)
    given = [file for source in sources for file in _files(source)]
    known = structures(given)
    # hashed before they are read, each once
    files = Inputs(*(source if isinstance(source, Path) else source.file for source in known.values()))
    files.refuse_to_overwrite(target)
    started = time.monotonic()
    table = task(given, count, repair=not strict, tolerance=tolerance, progress=_Clock())
    if sys.stderr.isatty():
        echo("\r\x1b[K", nl=False, err=True)
    for note in table.notes:
        echo(note, err=True)
    if not table.columns:
        raise ValueError(f"none of {len(table.refused)} surfaces can be read: nothing is written")
    table.save(target)
    taken = [source for name, source in known.items() if name not in table.refused]
    used = {str(source if isinstance(source, Path) else source.file) for source in taken}
    facts = {
        "complete": all(table.complete.values()),
        "residual": max(table.residuals.values()),
        "structures": len(table.columns),
        "left_out": table.refused,
        "seconds": time.monotonic() - started,
    }
    options = {"k": count, "tolerance": tolerance, "repair": not strict}
    inputs = {file: digest for file, digest in files.items() if file in used}
    proof = write_certificate(target, "fingerprint", options, inputs, facts, table.notes)
    said = f"{len(table.columns)} structures, {len(table.refused)} left out, residual {facts['residual']:.1e}"
    echo(f"{target}: {said} (certificate: {proof.name})")
    return 0 if facts["complete"] else NOT_CERTIFIED


def _files(source: str) -> list[str]:
    """LEFT+RIGHT as two files, anything else as it is."""
    both = source if Path(source).exists() else both_of(source)
    return [both] if isinstance(both, str) else list(both.values())


class _Clock:
    """Says how far it is, with elapsed and remaining time: on one line of a terminal, else every half minute."""

    def __init__(self) -> None:
        self.started = self.spoken = time.monotonic()

    def __call__(self, name: str, done: int, total: int) -> None:
        now = time.monotonic()
        elapsed = now - self.started
        rest = f", {elapsed / done * (total - done):.0f} s left" if done else ""
        line = f"{done}/{total} {name}: {elapsed:.0f} s{rest}"
        if sys.stderr.isatty():
            echo(f"\r{line} \x1b[K", nl=False, err=True)
        elif now - self.spoken > SPOKEN_EVERY:
            self.spoken = now
            echo(line, err=True)
