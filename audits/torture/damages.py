"""Stored results that are damaged, lost, exchanged or of others: detected, named, and made again byte by byte."""

from __future__ import annotations

import random
import shutil
from collections.abc import Iterator
from pathlib import Path

from audits.torture.case import HUNG, REFUSED, REPAIRED, RIGHT, WRONG, Ended, clear
from audits.torture.laboratory import fresh, run, store_bytes, working_folder
from surfexp.lab.store.store import faults

COUNT, WHOLE_RUNS = 500, 16


def damages(seed: int = 0, count: int = COUNT, whole_runs: int = WHOLE_RUNS) -> Iterator[Ended]:
    """Damage results one at a time: all are looked for, some are repaired by a whole run."""
    rng = random.Random(seed)
    with working_folder() as folder:
        first = run(folder, "run", "experiment=small")
        if first.code != 0:
            yield Ended("damage", "a sound run", WRONG, first.error[-300:])
            return
        sound, intact = folder / "sound", store_bytes(folder / "results")
        shutil.copytree(folder / "results", sound)
        stages = [(place.parent.name, place.name) for place in sorted((sound / "store").glob("*/*"))]
        for number in range(count):
            results = folder / "results"
            name, touched = _damage(results, stages, rng)
            found = faults(results, stages, anew=True)
            # a record that is lost was never computed, which needs no words
            lines = [line for line in found.values() if line and clear(line)]
            if not found:
                yield Ended("damage", name, WRONG, "it was not seen")
            elif lines:
                yield Ended("damage", name, WRONG, f"the line {clear(lines[0])}")
            elif number < whole_runs:
                yield _repaired(folder, intact, name)
            else:
                yield Ended("damage", name, REFUSED, next(iter(found.values())))
            _restore(sound, results, touched)
        yield from _around_the_store(folder, sound, intact)


def _damage(results: Path, stages: list[tuple[str, str]], rng: random.Random) -> tuple[str, Path]:
    """Damage one result, and say how; the folder that was touched."""
    kind, key = rng.choice(stages)
    place = results / "store" / kind / key
    file = place / rng.choice(("record.json", "arrays.npz"))
    whole = file.read_bytes()
    how = rng.choice(("bit", "bit", "bit", "bit", "cut", "empty", "lost", "longer", "exchanged", "zeros"))
    if how == "bit":
        spoilt = bytearray(whole)
        spoilt[rng.randrange(len(whole))] ^= 1 << rng.randrange(8)
        file.write_bytes(bytes(spoilt))
    elif how == "lost":
        file.unlink()
    elif how == "exchanged":
        others = [other for other in stages if other != (kind, key)]
        other = results.joinpath("store", *rng.choice(others)) / file.name
        file.write_bytes(other.read_bytes())
        if file.name == "arrays.npz" and other.read_bytes() == whole:
            file.write_bytes(whole + b" ")
    else:
        changed = {
            "cut": whole[: rng.randrange(1, len(whole))],
            "empty": b"",
            "longer": whole + b"\n",
            "zeros": bytes(len(whole)),
        }
        file.write_bytes(changed[how])
    return f"{how}, {file.name}", place


def _restore(sound: Path, results: Path, touched: Path) -> None:
    shutil.rmtree(touched, ignore_errors=True)
    shutil.copytree(sound / touched.relative_to(results), touched)


def _repaired(folder: Path, intact: dict[str, str], name: str) -> Ended:
    done = run(folder, "run", "experiment=small")
    if done.code is None:
        return Ended("damage", name, HUNG, "the run did not end")
    if done.code != 0:
        return Ended("damage", name, WRONG, f"the next run ended with {done.code}: {done.error[-200:]}")
    if store_bytes(folder / "results") != intact:
        return Ended("damage", name, WRONG, "the store is another one after the next run")
    said = [line for line in done.error.splitlines() if "damaged" in line or "no record.json" in line]
    return Ended("damage", name, REPAIRED, said[0] if said else "computed again")


def _around_the_store(folder: Path, sound: Path, intact: dict[str, str]) -> Iterator[Ended]:
    """What is derived or remembered may be lost or spoilt altogether."""

    def events(results: Path) -> None:
        shutil.rmtree(results / "events", ignore_errors=True)
        for file in results.glob("store/*/*/event.json"):
            file.unlink()

    def memory(results: Path) -> None:
        (results / "cache" / "verified.json").write_text("[3")

    def database(results: Path) -> None:
        (results / "mlflow.db").write_bytes(b"SQLite format 3\0" + bytes(5000))

    def plans(results: Path) -> None:
        for file in (results / "plans").glob("*.json"):
            file.write_text("{")

    def page(results: Path) -> None:
        shutil.rmtree(results / "small")
        (results / "small").write_text("a file")
        (results / "small").unlink()

    for name, spoil in {
        "all events": events,
        "memory": memory,
        "database": database,
        "plans": plans,
        "page": page,
    }.items():
        results = fresh(sound, folder)
        spoil(results)
        done = run(folder, "run", "experiment=small")
        same = store_bytes(results) == intact
        good = done.code == 0 and same and (results / "small" / "report.html").exists()
        said = "" if good else f"exit {done.code}, store {'the same' if same else 'another'}: {done.error[-200:]}"
        yield Ended("damage", name, RIGHT if good else (HUNG if done.code is None else WRONG), said)
