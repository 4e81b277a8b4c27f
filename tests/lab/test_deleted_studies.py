"""A study is one folder: without it, and the experiments that need its plugins, everything else works."""

from __future__ import annotations

import json
import os
import random
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
import yaml

ROOT = Path(__file__).resolve().parents[2]
STUDIES = sorted(file.parent.name for file in (ROOT / "studies").glob("*/__init__.py"))
# a process of its own: the copy is the package there; plugins and configurations lie in it as in a wheel
PROGRAM = """
import json, sys
from pathlib import Path
from surfexp.lab.composition.launch import launch
from surfexp.lab.registry import registry
from surfexp.lab.registry.folders import STUDIES, experiments, studies_folder
from surfexp.lab.registry.loading import load_all

root, names = Path(sys.argv[1]), sys.argv[2:]
assert studies_folder() == root / STUDIES
load_all(root)
assert all(method.file.is_relative_to(root) for method in registry.PLUGINS.values())
assert set(names) <= {name for name, file in experiments().items() if file.is_relative_to(root)}
planned = {}
for name in names:
    try:
        launch([f"experiment={name}"], lambda plan: planned.update({name: len(plan.nodes)}))
    except Exception as error:
        planned[name] = str(error)
broken = {str(file): text for file, text in registry.BROKEN.items()}
print(json.dumps([sorted(map("/".join, registry.PLUGINS)), broken, planned]))
"""


def own_plugins(study: str) -> set[str]:
    """Names that a study's plugins are called by in an experiment."""
    text = "".join(file.read_text() for file in (ROOT / "studies" / study / "plugins").rglob("*.py"))
    return set(re.findall(r'\bregister\(\s*"\w+",\s*"(\w+)"', text))


def copied_without(deleted: list[str], folder: Path) -> list[str]:
    """Copy what ships without some studies; return the names of the experiments that are left."""
    ignored = shutil.ignore_patterns("__pycache__")
    shutil.copytree(ROOT / "surfexp", folder / "surfexp", ignore=ignored)
    shutil.copytree(ROOT / "studies", folder / "surfexp_studies", ignore=ignored)
    for part in ("plugins", "conf", "profiles"):
        shutil.copytree(ROOT / part, folder / "surfexp" / part, ignore=ignored)
    for study in deleted:
        shutil.rmtree(folder / "surfexp_studies" / study)
    gone = set().union(*map(own_plugins, deleted))
    files = sorted((folder / "surfexp/conf/experiment").glob("*.yaml"))
    for file in files:
        if gone & words_of(yaml.safe_load(file.read_text())):
            file.unlink()
    return [file.stem for file in files if file.exists()]


def words_of(part: object) -> set[str]:
    """All keys and texts of an experiment."""
    if isinstance(part, dict):
        return set(map(str, part)).union(*map(words_of, part.values()))
    return set().union(*map(words_of, part)) if isinstance(part, list) else {str(part)}


def planned_without(
    deleted: list[str], chosen: int, folder: Path
) -> tuple[set[str], dict[str, str], dict[str, object]]:
    """Plugins that are left, files that are broken, and how many stages a number of experiments have."""
    names = copied_without(deleted, folder)
    assert len(names) > 30
    names = random.Random(len(deleted)).sample(names, min(chosen, len(names)))
    done = subprocess.run(
        [sys.executable, "-c", PROGRAM, str(folder), *names],
        cwd=folder,
        capture_output=True,
        text=True,
        env={**os.environ, "PYTHONPATH": str(folder)},
    )
    assert done.returncode == 0, done.stderr
    left, broken, planned = json.loads(done.stdout.splitlines()[-1])
    assert set(planned) == set(names)
    return set(left), broken, planned


def check(deleted: list[str], chosen: int, folder: Path) -> None:
    left, broken, planned = planned_without(deleted, chosen, folder)
    gone = set().union(*map(own_plugins, deleted))
    assert not broken and gone and not gone & {name.partition("/")[2] for name in left}
    assert [told for told in planned.items() if not isinstance(told[1], int)] == []


def test_three_studies_can_be_deleted(tmp_path: Path) -> None:
    with_plugins = [study for study in STUDIES if own_plugins(study)]
    check(random.Random(3).sample(with_plugins, min(3, len(with_plugins))), 5, tmp_path)


@pytest.mark.slow
@pytest.mark.parametrize("study", [[name] for name in STUDIES] + [STUDIES], ids="-".join)
def test_each_study_and_all_of_them_can_be_deleted(study: list[str], tmp_path: Path) -> None:
    if any(map(own_plugins, study)):
        check(study, 100, tmp_path)
