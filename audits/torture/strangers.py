"""Results, plans and experiments that somebody sends: they are data, and nothing of theirs runs."""

from __future__ import annotations

import json
import os
import pickle
import re
import shutil
import sys
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

import numpy as np

from audits.torture.case import REFUSED, RIGHT, WRONG, Ended, in_a_child
from audits.torture.laboratory import EXPERIMENT, run, working_folder
from surfexp.commands.command_line import main

SECONDS = 120.0
MARKUP = "<script>document.title='ran'</script>"
EXPERIMENTS = {
    "callbacks": "hydra:\n  callbacks:\n    mine: {_target_: evil.run}\n",
    "handlers": "hydra:\n  job_logging:\n    handlers: {mine: {class: evil.run}}\n",
    "sweeper": "hydra:\n  sweeper: {_target_: evil.run}\n",
    "launcher": "hydra:\n  launcher: {_target_: evil.run}\n",
    "run folder": "hydra:\n  run: {dir: ../elsewhere}\n",
    "sweep folder": "hydra:\n  sweep: {dir: ../elsewhere}\n",
    "environment": "hydra:\n  job: {env_set: {PATH: here}}\n",
    "environment read": "title: ${oc.env:HOME}\n",
    "resolver": "title: ${oc.create:evil}\n",
    "Python tag": "title: !!python/object/apply:evil.run []\n",
    "instantiation": "surface: {_target_: evil.run}\n",
    "name with a path": "experiment: ../victim\n",
    "absolute name": "experiment: /tmp/victim\n",
    "name of a shell": "experiment: '$(touch ran)'\n",
    "results elsewhere": "results: ../elsewhere\n",
    "markup in the title": f'title: "{MARKUP}"\n',
    "markup in the comparison": f'comparison: "[bold]{MARKUP}[/b]"\n',
    "URL": "surface: {name: file, path: 'http://127.0.0.1:9/x.ply'}\n",
    "default list": "defaults:\n  - /etc/passwd\n",
    "search path": "hydra:\n  searchpath: [file:///tmp]\n",
}


def strangers(every: int = 1) -> Iterator[Ended]:
    """Open, plan, run and show what is sent, or one of so many of it."""
    with working_folder() as folder:
        run(folder, "run", "experiment=small")
        (folder / "evil.py").write_text("import pathlib\npathlib.Path('ran').touch()\ndef run(*a, **k):\n    pass\n")
        os.chdir(folder)
        sys.path.insert(0, str(folder))
        for name, text in list(EXPERIMENTS.items())[::every]:
            # a key that is given again takes the place of the first
            keys = {line.split(":")[0] for line in text.splitlines() if not line.startswith(" ")}
            rows = [row for row in EXPERIMENT.splitlines() if row.split(":")[0] not in keys]
            (folder / "conf" / "experiment" / "sent.yaml").write_text("\n".join(rows) + "\n" + text)
            before = _entries(folder)
            ended = in_a_child(
                "experiment of others", name, partial(_command, "plan", "experiment=sent"), SECONDS, 2**31
            )
            yield _checked(ended, folder, before)
        sound = folder / "sound"
        shutil.copytree(folder / "results", sound)
        for name, spoil in list(RESULTS.items())[::every]:
            shutil.rmtree(folder / "results")
            shutil.copytree(sound, folder / "results")
            spoil(folder / "results")
            before = _entries(folder)
            for command in (("table", "small"), ("report", "small"), ("export", "small", "--to", "exported")):
                shutil.rmtree(folder / "exported", ignore_errors=True)
                work = partial(_command, *command)
                ended = in_a_child("results of others", f"{name}, {command[0]}", work, SECONDS, 2**31)
                yield _checked(ended, folder, before | {"exported"})
        sys.path.remove(str(folder))
        os.chdir(Path(__file__).parent)


def _command(*arguments: str) -> tuple[str, str]:
    code = main(list(arguments))
    return (RIGHT, "") if code in (0, 3) else (REFUSED, f"exit {code}") if code in (1, 2) else (WRONG, f"exit {code}")


def _checked(ended: Ended, folder: Path, before: set[str]) -> Ended:
    """Nothing ran, nothing was written outside, no markup stands in a page as markup."""
    if (folder / "ran").exists():
        (folder / "ran").unlink()
        return Ended(ended.kind, ended.name, WRONG, "it ran code")
    stray = _entries(folder) - before - {".snakemake"}
    if stray or (folder.parent / "elsewhere").exists() or (folder.parent / "victim").exists():
        return Ended(ended.kind, ended.name, WRONG, f"left {sorted(stray)}")
    if any(MARKUP in page.read_text(errors="replace") for page in folder.glob("results/**/*.html")):
        return Ended(ended.kind, ended.name, WRONG, "its markup stands in a page")
    return ended


def _entries(folder: Path) -> set[str]:
    return {entry.name for entry in folder.iterdir()} - {"__pycache__"}


class _Evil:
    def __reduce__(self) -> tuple[Callable[..., int], tuple[str]]:
        return os.system, ("touch ran",)


def _pickled_arrays(results: Path) -> None:
    for file in results.glob("store/*/*/arrays.npz"):
        np.savez(file, evil=np.array([_Evil()], dtype=object))


def _compiled(results: Path) -> None:
    for name in ("cache/numba", "cache", "store"):
        (results / name).mkdir(exist_ok=True, parents=True)
        (results / name / "x.nbi").write_bytes(pickle.dumps(_Evil()))


def _foreign_class(results: Path) -> None:
    for file in results.glob("store/*/*/record.json"):
        record = json.loads(file.read_text())
        record["result"]["class"] = "evil:run"
        file.write_text(json.dumps(record))


def _plan_of_others(results: Path) -> None:
    evil = f'"file": "{results.parent}/evil.py"'
    for file in results.glob("plans/small-*.json"):
        file.write_text(re.sub(r'"file": ?"[^"]*"', evil, file.read_text()))


def _markup(results: Path) -> None:
    for file in results.glob("plans/small-*.json"):
        file.write_text(file.read_text().replace("Small & quick", MARKUP))
    (results / "small" / "summary.json").write_text(json.dumps({"title": MARKUP, "question": MARKUP}))
    for file in results.glob("small/origin/*.json"):
        file.write_text(json.dumps({"command": MARKUP, "date": MARKUP}))


def _links(results: Path) -> None:
    shutil.rmtree(results / "small" / "figures", ignore_errors=True)
    (results / "small" / "figures").symlink_to(results.parent / "conf")


def _formula(results: Path) -> None:
    for file in results.glob("plans/small-*.json"):
        file.write_text(file.read_text().replace("two_phase", "=cmd|' /C calc'!A0"))


def _deep(results: Path) -> None:
    for file in results.glob("plans/small-*.json"):
        file.write_text("[" * 100_000)


def _traversal(results: Path) -> None:
    for file in results.glob("plans/small-*.json"):
        file.write_text(re.sub(r'"experiment": ?"small"', '"experiment": "../victim"', file.read_text()))


RESULTS = {
    "pickled arrays": _pickled_arrays,
    "compiled code": _compiled,
    "a foreign class": _foreign_class,
    "a plan with other files": _plan_of_others,
    "markup": _markup,
    "links": _links,
    "formulas": _formula,
    "a deep plan": _deep,
    "a plan with a path": _traversal,
}
