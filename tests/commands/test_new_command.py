"""What `surfexp new` writes works at once: its tests pass, and it is as the formatter would have it."""

from __future__ import annotations

import shlex
import subprocess
import sys
from pathlib import Path

import pytest

from surfexp.commands.command_line import main
from surfexp.lab.registry import registry
from surfexp.lab.registry.loading import load_all
from surfexp.lab.store.kinds import KINDS

ROOT = Path(__file__).resolve().parents[2]
OWN = sorted(name for name, kind in KINDS.items() if kind.path.startswith("surfexp."))


def called(*arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, "-m", *arguments], capture_output=True, text=True)


@pytest.mark.parametrize("name", ["prox", "a_method_of_a_rather_long_name"])
def test_whatever_is_new_is_formatted(working_folder: Path, name: str, capsys: pytest.CaptureFixture[str]) -> None:
    for kind in [*OWN, "kind"]:
        assert main(["new", kind, name]) == 0
    said = capsys.readouterr().out
    assert said.count("written: ") == 2 * (len(OWN) + 1) == 2 * said.count("test it: python -m pytest tests/")
    for length in ("88", "120"):
        done = called("ruff", "format", "--isolated", "--check", "--diff", "--line-length", length, "plugins", "tests")
        assert done.returncode == 0, done.stderr + done.stdout
    first_party = 'lint.isort.known-first-party=["surfexp"]'  # as in a checkout
    lint = called("ruff", "check", "--config", str(ROOT / "pyproject.toml"), "--config", first_party, ".")
    assert lint.returncode == 0, lint.stdout


LIKE = {
    "operator": "fem",
    "signature": "shape_dna",
    "distance": "mean_hausdorff",
    "classifier": "nearest_neighbour",
    "figure": "denoising",
}


@pytest.mark.slow
@pytest.mark.parametrize("kind", sorted(LIKE))
def test_a_scaffold_takes_what_a_shipped_method_takes(
    working_folder: Path, kind: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["new", kind, "of_mine"]) == 0
    registry.load_file(working_folder / "plugins" / kind / "of_mine.py")
    load_all(Path("nowhere"))
    shipped, written = registry.plugin(kind, LIKE[kind]), registry.plugin(kind, "of_mine")
    assert written.inputs.items() <= shipped.inputs.items() and written.inputs
    line = next(line for line in capsys.readouterr().out.splitlines() if line.startswith("try it:"))
    assert main(["plan", *shlex.split(line)[4:]]) == 0


@pytest.mark.slow
@pytest.mark.parametrize("kind", sorted(LIKE))
def test_the_test_of_a_scaffold_passes(working_folder: Path, kind: str) -> None:
    main(["new", kind, "tested"])
    done = called("pytest", "-q", "tests")
    assert done.returncode == 0, done.stdout


@pytest.mark.timeout(3600)  # for what never ends: numba compiles for a minute on a machine that is idle
def test_the_tests_of_a_new_solver_and_a_new_kind_pass(working_folder: Path) -> None:
    main(["new", "solver", "my_method"])
    main(["new", "kind", "thickness"])
    # one that is wrong beside them fails its test: its dual field leaves the unit ball
    main(["new", "solver", "my_mistake"])
    plugin = Path("plugins/solver/my_mistake.py")
    text = plugin.read_text()
    assert "keepdims=True)" in text
    plugin.write_text(text.replace("keepdims=True)", "keepdims=True) / 1.5"))
    done = called("pytest", "-q", "tests")
    failed = {line.split()[1] for line in done.stdout.splitlines() if line.startswith("FAILED")}
    assert "tests/test_solver_my_mistake.py::test_its_certificate_holds" in failed, done.stdout
    assert all("my_mistake" in name for name in failed) and " passed" in done.stdout, done.stdout


@pytest.mark.parametrize(
    ("kind", "name", "said"),
    [
        ("kind", "solver", "surfexp: stage kind 'solver' exists: surfexp.variational"),
        ("solver", "newton", "surfexp: solver/newton exists"),
        ("kinds", "x", "did you mean 'kind'"),
    ],
)
def test_names_that_are_taken_are_refused(
    working_folder: Path, capsys: pytest.CaptureFixture[str], kind: str, name: str, said: str
) -> None:
    assert main(["new", kind, name]) == 2
    assert said in capsys.readouterr().err
