"""`python -m audits.torture.fuzzing [TARGET ...] --runs N`: bytes guided by coverage into readers and the loader of experiments.

A target that answers with anything but a result or one clear line ends with 1 and keeps the bytes as `crash-...` in
`results/fuzzing/TARGET`. What increased the coverage is kept there too, and the next call begins with it.
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

from audits.torture import ROOT
from audits.torture.case import LONGEST_LINE, clear
from surfexp.lab.errors import UserError

FOLDER = ROOT / "results" / "fuzzing"
CORPUS = ROOT / "tests" / "corpus"
PAGE = ROOT / "docs" / "fuzzing.md"
SECONDS, MEGABYTES = 10, 2048
MEMORY = "/dev/shm"  # noqa: S108, below it only a folder with a random name is made
EXPERIMENT = "experiment.yaml"
HEAD = """# Fuzzing

Made by `python -m audits.torture.fuzzing`: libFuzzer (through atheris) changes small sound files guided by the coverage of
the readers and of the libraries below them. Each input must end in a result whose numbers have the promised shapes, or
in one clear line of at most 300 characters, within 10 seconds and 2 GB.

| reader | file | inputs | seconds | inputs kept for their coverage |
|---|---|---|---|---|
"""


def targets() -> dict[str, Callable[[Path], None]]:
    """Return for each name of a sound file what reads it; imported here, so that coverage is measured."""
    from audits.torture.sound_files import LABELS, MAPS, MESHES
    from surfexp.io.map_files import read_maps, read_mask, read_named_labels
    from surfexp.io.reading import read_mesh
    from surfexp.lab.experiment.yaml_files import check_variants, read_yaml

    def experiment(file: Path) -> None:
        check_variants(read_yaml(file))

    def mesh(file: Path) -> None:
        vertices, faces, scalars = read_mesh(file)
        assert vertices.shape[1:] == faces.shape[1:] == (3,)
        assert not len(faces) or 0 <= faces.min() <= faces.max() < len(vertices)
        assert all(len(values) == len(vertices) for values in scalars.values())

    def maps(file: Path) -> None:
        for values in read_maps(file, "left").values():
            assert values.ndim in (1, 2) and values.dtype == float

    def labels(file: Path) -> None:
        assert read_named_labels(file, "left").keys.ndim == 1

    def mask(file: Path) -> None:
        assert read_mask(file, 42).shape == (42,)

    by_name = [(MESHES, mesh), (MAPS, maps), (LABELS[:2], labels), (LABELS[2:], mask), ((EXPERIMENT,), experiment)]
    return {name: read for names, read in by_name for name in names}


def judged(read: Callable[[Path], None], file: Path) -> str:
    """Read a file; return what is wrong with the answer, empty for a result or a clear refusal."""
    try:
        read(file)
    except (ValueError, UserError) as error:
        # the folder of the file is no part of the line
        return clear(str(error).replace(f"{file.parent}/", ""))
    return ""


def fuzz(name: str, runs: str, seconds: str) -> None:
    """Give a reader so many inputs in this process, which ends with them."""
    import atheris

    with atheris.instrument_imports(include=["surfexp.io", "surfexp.lab.experiment.yaml_files", "nibabel", "yaml"]):
        read = targets()[name]
    folder = Path(tempfile.mkdtemp(dir=MEMORY if os.access(MEMORY, os.W_OK) else None))
    file = folder / name
    if name == "a.tri":
        from audits.torture.sound_files import write_sound_files

        (folder / "sound").mkdir()
        (folder / "a.vert").write_bytes(write_sound_files(folder / "sound")["a.vert"])

    def once(data: bytes) -> None:
        file.write_bytes(data)
        wrong = judged(read, file)
        if wrong:
            raise AssertionError(wrong[: 2 * LONGEST_LINE])

    place = FOLDER / name
    atheris.Setup(
        [
            sys.argv[0],
            f"-runs={runs}",
            f"-max_total_time={seconds}",
            f"-timeout={SECONDS}",
            f"-rss_limit_mb={MEGABYTES}",
            f"-max_len={2 * max(seed.stat().st_size for seed in (place / 'corpus').iterdir())}",
            f"-artifact_prefix={place}/",
            "-print_final_stats=1",
            str(place / "corpus"),
        ],
        once,
    )
    atheris.Fuzz()


def main() -> None:
    """Fuzz the targets one after the other, each in a process of its own; end with 1 where one answered wrongly."""
    if "--inside" in sys.argv:
        _, name, runs, seconds, _ = sys.argv
        fuzz(name, runs, seconds)
        return
    known = list(targets())
    parser = argparse.ArgumentParser(prog="fuzzing", description=__doc__.splitlines()[0])
    parser.add_argument("targets", nargs="*", metavar="TARGET", help=f"all by default: {', '.join(known)}")
    parser.add_argument("--runs", type=int, default=100_000, help="inputs for each (default 100,000)")
    parser.add_argument("--seconds", type=int, default=600, help="at most so long for each (default 600)")
    given = parser.parse_args()
    for unknown in set(given.targets) - set(known):
        parser.error(f"target {unknown!r} is unknown, choose from {', '.join(known)}")
    rows, failed = [], False
    for name in given.targets or known:
        row, good = _fuzz_in_a_process(name, given.runs, given.seconds)
        print(row, flush=True)
        rows.append(row)
        failed |= not good
    if not given.targets:
        total = sum(int(row.split("|")[3].replace(",", "")) for row in rows)
        PAGE.write_text(HEAD + "\n".join(rows) + f"\n\n{total:,} inputs in all.\n", encoding="utf-8")
    sys.exit(1 if failed else 0)


def _fuzz_in_a_process(name: str, runs: int, seconds: int) -> tuple[str, bool]:
    place = FOLDER / name
    _write_seeds(name, place / "corpus")
    begin = time.monotonic()
    command = [sys.executable, "-m", "audits.torture.fuzzing", name, f"{runs}", f"{seconds}", "--inside"]
    with (place / "log").open("w") as log:
        code = subprocess.run(command, cwd=ROOT, stdout=log, stderr=log, check=False).returncode
    said = (place / "log").read_text(errors="replace")
    done = re.findall(r"number_of_executed_units: (\d+)", said)
    if code:
        wrong = [line for line in said.splitlines() if "Error" in line or "ERROR" in line]
        print(f"{name}: exit {code}: {wrong[0][:300] if wrong else said[-300:]} ({place})", flush=True)
    count = int(done[-1]) if done else 0
    kept = sum(1 for _ in (place / "corpus").iterdir())
    kind = "wrong" if code else targets()[name].__name__
    return f"| {kind} | {name} | {count:,} | {time.monotonic() - begin:.0f} | {kept:,} |", code == 0


def _write_seeds(name: str, corpus: Path) -> None:
    """Begin with the sound file, and with the inputs that were found wrong once."""
    from audits.torture.laboratory import EXPERIMENT as SMALL
    from audits.torture.sound_files import write_sound_files

    corpus.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as text:
        sound = write_sound_files(Path(text))
    (corpus / "sound").write_bytes(SMALL.encode() if name == EXPERIMENT else sound[name])
    for file in sorted((CORPUS / name).glob("*")):
        shutil.copy(file, corpus / file.name)


if __name__ == "__main__":
    main()
