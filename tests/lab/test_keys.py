"""A key holds what computes: shown text changes none, a constant changes exactly the plugins that reach it."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
SHOWN = {
    "a word of CSS": ("surfexp/contract/summary.py", "text-align:left", "text-align:center"),
    "how many digits are shown": ("surfexp/contract/summary.py", "{value:.4g}", "{value:.5g}"),
    "an install hint": ("surfexp/extras.py", "pip install 'surfexp[", "pip install --user 'surfexp["),
    "a metric's meaning": ("surfexp/embedding/distance.py", "the distance found", "the least distance found"),
    "a metric's good direction": (
        "surfexp/embedding/distance.py",
        'evaluations of the distance or a bound", better="lower"',
        'evaluations of the distance or a bound"',
    ),
    "a docstring": ("surfexp/mesh/triangle_mesh.py", '"""', '"""Said otherwise. '),
    "a comment": (
        "surfexp/operators/intrinsic_delaunay.py",
        "MOLLIFICATION = 1e-6",
        "MOLLIFICATION = 1e-6  # of a mean",
    ),
    "the text of an error": (
        "surfexp/embedding/distance.py",
        "one for each is needed",
        "and one for each has to be there",
    ),
    "a summary's title": ("surfexp/spectrum/eigensystem.py", "} eigenpairs", "} pairs"),
    "an option's description": ("plugins/surface/noisy.py", 'description="', 'description="said otherwise: '),
    "a page's template": ("surfexp/report/page.py", '"""', '"""Said otherwise. '),
    "a drawing of reports": ("surfexp/report/ranking/drawing.py", "def ", "def another() -> None: ...\n\n\ndef "),
    "the laboratory": (
        "surfexp/lab/plan/plan.py",
        "class Plan",
        "class Another: ...\n\n\n@dataclass(frozen=True)\nclass Plan",
    ),
}
COMPUTING = {
    "surfexp/operators/intrinsic_delaunay.py": ("MOLLIFICATION = 1e-6", "MOLLIFICATION = 2e-6"),
    "surfexp/spectrum/nodal_domains.py": ("= 0.5, 0.25, 2.0", "= 0.5, 0.25, 2.5"),
    "surfexp/spectrum/nodal_signature.py": ("1e-3 * smallest", "2e-3 * smallest"),
    "surfexp/skeleton/fast_marching.py": ("1e-14 * aa", "1e-13 * aa"),
    "surfexp/embedding/distance_methods.py": ("way > 0 else", "way > 1 else"),
    "surfexp/figures/typography.py": ("import numpy as np", "import numpy as np\nCONSTANT = 3"),
    "surfexp/contract/metric.py": ('".+"', '".*"'),
}
# a process of its own: the copy is the package there, and its plugins lie in it as in a wheel
PROGRAM = """
import json, os, sys
from pathlib import Path
root, edits = Path(sys.argv[1]), json.loads(sys.argv[2])
from surfexp.lab.plan import code_digests, source_code, source_facts
from surfexp.lab.registry import registry
from surfexp.lab.registry.loading import load_all
assert code_digests.PACKAGE == root / "surfexp", code_digests.PACKAGE
load_all(Path("/nonexistent"))
assert not registry.BROKEN, registry.BROKEN

def digests():
    for module in (code_digests, source_code, source_facts):
        for function in vars(module).values():
            if hasattr(function, "cache_clear"):
                function.cache_clear()
    return {f"{k}/{n}": code_digests.code_digest(p.file, p.function.__qualname__) for (k, n), p in registry.PLUGINS.items()}

def reaching(file):
    return sorted(
        f"{k}/{n}" for (k, n), p in registry.PLUGINS.items()
        if file in code_digests.code_closure(p.file, p.function.__qualname__)[0]
    )

before, answer = digests(), {}
for name, (file, old, new) in edits.items():
    path = root / (file if file.startswith("surfexp") else "surfexp/" + file)
    reached, text = reaching(path), path.read_text()
    assert old in text, (file, old)
    path.write_text(text.replace(old, new, 1))
    after = digests()
    answer[name] = [sorted(key for key in before if before[key] != after[key]), reached]
    path.write_text(text)
print(json.dumps(answer))
"""


@pytest.fixture(scope="module")
def changed(tmp_path_factory: pytest.TempPathFactory) -> dict[str, tuple[list[str], list[str]]]:
    """For each planted edit the plugins whose code has another digest, and those that reach the file."""
    root = tmp_path_factory.mktemp("edited")
    ignored = shutil.ignore_patterns("__pycache__")
    shutil.copytree(ROOT / "surfexp", root / "surfexp", ignore=ignored)
    shutil.copytree(ROOT / "studies", root / "surfexp_studies", ignore=ignored)
    for part in ("plugins", "conf", "profiles"):
        shutil.copytree(ROOT / part, root / "surfexp" / part, ignore=ignored)
    edits = SHOWN | {file: (file, *edit) for file, edit in COMPUTING.items()}
    done = subprocess.run(
        [sys.executable, "-c", PROGRAM, str(root), json.dumps(edits)],
        cwd=root,
        capture_output=True,
        text=True,
        env={**os.environ, "PYTHONPATH": str(root)},
    )
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


@pytest.mark.parametrize("edit", SHOWN)
def test_what_is_shown_is_in_no_key(edit: str, changed: dict[str, tuple[list[str], list[str]]]) -> None:
    assert changed[edit][0] == []


@pytest.mark.parametrize("file", COMPUTING)
def test_a_constant_is_in_the_keys_of_all_that_reach_it(
    file: str, changed: dict[str, tuple[list[str], list[str]]]
) -> None:
    assert changed[file][0] == changed[file][1] != []


def test_what_draws_figures_is_in_no_numeric_key(changed: dict[str, tuple[list[str], list[str]]]) -> None:
    assert {name.split("/")[0] for name in changed["surfexp/figures/typography.py"][0]} == {"figure"}


def test_a_constant_of_one_operator_is_in_no_key_of_another(changed: dict[str, tuple[list[str], list[str]]]) -> None:
    names = changed["surfexp/operators/intrinsic_delaunay.py"][0]
    assert "operator/intrinsic_delaunay" in names and "operator/fem" not in names
