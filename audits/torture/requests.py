"""Command lines and experiment files with a mistake: exit code 2 and one line that names the thing."""

from __future__ import annotations

import os
import random
import sys
import tempfile
from collections.abc import Iterator
from functools import partial
from pathlib import Path

from audits.torture.case import REFUSED, RIGHT, WRONG, Ended, clear, in_a_child
from audits.torture.laboratory import EXPERIMENT, working_folder
from surfexp.commands.all_commands import COMMANDS
from surfexp.commands.command_line import main
from surfexp.lab.registry.catalogue import catalogue

COUNT, SECONDS = 200, 60.0
VALUES = (
    "nan",
    "-1",
    "1e999",
    "x",
    "[1,2]",
    "{a: 1}",
    "",
    "true",
    "null",
    "''",
    "1" * 400,
    "${oops}",
    "\u00fc",
    "0x",
    "1;2",
)
KEYS = (
    "surface",
    "image",
    "model",
    "operator",
    "solver",
    "figures",
    "grid",
    "title",
    "target",
    "claims",
    "datasets",
    "columns",
)
SPOILT = (
    "3", "[]", "{}", "null", "'no such'", "[1, [2, [3]]]", "{name: 3}", "{name: [a]}", "{dataset: nothing}",
    "!!python/object:os.system x",
    "*unknown", "{a: &x [*x]}", "2020-01-01", "'${oc.env:HOME}'", "{name: icosphere, levels: x}", "\tx",
)  # fmt: skip


def requests(seed: int = 0, count: int = COUNT) -> Iterator[Ended]:
    """Run `count` command lines and as many experiment files."""
    rng = random.Random(seed)
    with working_folder() as folder:
        os.chdir(folder)
        known = catalogue(folder)
        lines = [*_of_options(known, rng), *_of_commands(folder)]
        for arguments in rng.sample(lines, min(count, len(lines))):
            yield in_a_child("request", " ".join(arguments)[:120], partial(_asked, arguments), SECONDS, 2**31)
        for number, text in zip(range(count), _files(rng), strict=False):
            file = folder / "conf" / "experiment" / "spoilt.yaml"
            file.write_text(text)
            work = partial(_asked, ["plan", "experiment=spoilt"])
            yield in_a_child("experiment file", f"{number}", work, SECONDS, 2**31)
        os.chdir(Path(__file__).parent)


def _asked(arguments: list[str]) -> tuple[str, str]:
    """Exit code and what is said on standard error, in this process."""
    with tempfile.TemporaryFile("w+") as stream:
        sys.stderr = stream
        os.dup2(stream.fileno(), 2)
        code = main(arguments)
        sys.stderr.flush()
        stream.seek(0)
        said = stream.read().strip()
    if code == 0:
        return RIGHT, said[:300]
    if code != 2:
        return WRONG, f"exit {code}: {said[:300]}"
    line = "\n".join(text for text in said.splitlines() if not text.startswith("warning:"))
    wrong = clear(line)
    return (WRONG, f"the line {wrong}") if wrong else (REFUSED, line)


def _of_options(known: object, rng: random.Random) -> list[list[str]]:
    """Every option of every plugin with a value that it may not have, and misspelt."""
    lines = []
    for (kind, name), plugin in known.plugins.items():  # type: ignore[attr-defined]
        if kind in ("figure", "statistic"):
            continue
        for option in plugin.options:
            first = option[0]
            swapped = first[1:2] + first[:1] + first[2:]
            key = swapped if rng.random() < 0.3 else first
            lines.append(["plan", f"{kind}={name}", f"{kind}.{key}={rng.choice(VALUES)}"])
    return lines


def _of_commands(folder: Path) -> list[list[str]]:
    """Every command without arguments that it needs, with a flag that it lacks, on files that are not there."""
    quiet = [name for name in COMMANDS if name not in ("run", "plan", "ui", "view", "doctor", "fetch", "clean", "new")]
    lines = [
        [name, *rest]
        for name in quiet
        for rest in ((), ("--nothing",), ("no/such/file",), ("no.ply", "--to", "no.zzz"))
    ]
    lines += [[name[::-1]] for name in COMMANDS]
    lines += [
        ["run", text]
        for text in ("results=/proc/none", "=", "a=b=c", "experiment=", "+x=1", "~surface", "hydra.run.dir=/x")
    ]
    lines += [
        ["run", f"experiment={name}"] for name in ("../x", "a b", "small,nothing", "Small", "x" * 300, "$(id)", "-")
    ]
    return lines


def _files(rng: random.Random) -> Iterator[str]:
    """The quick experiment with one key spoilt, doubled, misspelt or removed, and texts that are none."""
    yield from (
        "",
        "3",
        "[1, 2]",
        "\x00",
        "a: [",
        "\tx: 1",
        "a: &a [*a]\nb: *a",
        "- x\n",
        "experiment: small\nexperiment: other\n",
    )
    bomb = "a0: &a0 [x, x]\n" + "".join(f"a{k}: &a{k} [{', '.join([f'*a{k - 1}'] * 9)}]\n" for k in range(1, 9))
    yield EXPERIMENT + bomb
    rows = EXPERIMENT.splitlines()
    while True:
        place = rng.randrange(1, len(rows))
        key = rows[place].split(":")[0]
        how = rng.choice(("value", "value", "value", "misspelt", "twice", "gone", "new"))
        changed = {
            "value": [f"{key}: {rng.choice(SPOILT)}"],
            "misspelt": [rows[place].replace(key, key[1:2] + key[:1] + key[2:], 1)],
            "twice": [rows[place], rows[place]],
            "gone": [],
            "new": [rows[place], f"{rng.choice(KEYS)}x: {rng.choice(SPOILT)}"],
        }[how]
        yield "\n".join([*rows[:place], *changed, *rows[place + 1 :]]) + "\n"
