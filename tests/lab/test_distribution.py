"""The wheel alone runs from an empty folder, and a package of plugins installed beside it takes part."""

from __future__ import annotations

import csv
import io
import os
import shutil
import subprocess
import sys
import tomllib
import venv
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent.parent

PACKAGE = ROOT / "examples" / "plugin_package"


def call(*command: str | Path, cwd: Path) -> str:
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True, cwd=cwd)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def test_every_folder_of_code_and_every_file_beside_it_is_in_the_wheel() -> None:
    setup = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["setuptools"]
    package = ROOT / "surfexp"
    folders = {file.parent.relative_to(ROOT) for file in package.rglob("*.py")}
    mapped = {
        "surfexp.plugins",
        "surfexp.conf",
        "surfexp.profiles",
        "surfexp_studies",
        "snakemake_executor_plugin_surfexp",
    }
    code = {".".join(folder.parts) for folder in folders if "templates" not in folder.parts}
    assert set(setup["packages"]) == code | mapped
    kept = [
        file
        for name, patterns in setup["package-data"].items()
        for pattern in patterns
        for file in (package.joinpath(*name.split(".")[1:]) if name != "*" else package).rglob(pattern)
    ]
    beside = {file for file in package.rglob("*") if file.is_file() and "__pycache__" not in file.parts}
    beside = {file for file in beside if file.suffix != ".py"}
    assert beside <= set(kept), sorted(beside - set(kept))


@pytest.mark.slow
@pytest.mark.timeout(3600)  # for what never ends: some forty processes start here, and a busy machine delays each
def test_the_wheel_and_a_third_party_package_run_from_an_empty_folder(tmp_path: Path) -> None:
    source = tmp_path / "source"
    ignored = shutil.ignore_patterns(
        ".git", ".venv", "results", ".snakemake", "*.egg-info", "build", "__pycache__", ".*cache"
    )
    shutil.copytree(ROOT, source, ignore=ignored)
    (source / "results").mkdir()
    third = tmp_path / "third"
    shutil.copytree(PACKAGE, third, ignore=ignored)
    for folder in (source, third):
        call(
            sys.executable,
            "-m",
            "pip",
            "wheel",
            "-q",
            "--no-deps",
            "--no-build-isolation",
            "-w",
            tmp_path,
            ".",
            cwd=folder,
        )

    # a fresh environment that sees the dependencies of this one, but not this checkout
    venv.create(tmp_path / "env", with_pip=False)
    python = tmp_path / "env" / "bin" / "python"
    site = Path(call(python, "-c", "import sysconfig; print(sysconfig.get_path('purelib'))", cwd=tmp_path).strip())
    for entry in (entry for here in sys.path if Path(here).name == "site-packages" for entry in Path(here).iterdir()):
        if "surfexp" not in entry.name and not (site / entry.name).exists() and entry.suffix != ".pth":
            (site / entry.name).symlink_to(entry)
    install = [sys.executable, "-m", "pip", "--python", python, "install", "-q", "--no-deps", "--no-index"]
    call(*install, *tmp_path.glob("*.whl"), cwd=tmp_path)

    empty = tmp_path / "empty"
    empty.mkdir()
    surfexp = tmp_path / "env" / "bin" / "surfexp"
    where = call(python, "-c", "import surfexp; print(surfexp.__file__)", cwd=empty)
    assert str(tmp_path) in where and str(ROOT) not in where
    listed = call(surfexp, "list", "experiment", cwd=empty)
    assert "quickstart" in listed and "shape_distributions" in listed
    assert "shape_distribution" in call(surfexp, "run", "--help", cwd=empty)
    said = call(surfexp, "run", "experiment=sphere_distances", cwd=empty)
    assert "surface levels" in said and "holds" in said
    # what ships is there and is found: the experiments plan (solvers compile for a minute, so none runs)
    assert "configurations" in call(surfexp, "plan", "experiment=quickstart", cwd=empty)
    studies = site / "surfexp_studies"
    shipped, here = ({file.parent.name for file in top.glob("*/__init__.py")} for top in (studies, ROOT / "studies"))
    assert shipped == here
    assert list(studies.glob("*/plugins/*/*.py")) and list(studies.glob("*/README.md"))
    assert not list(studies.glob("*/tests")) and not list(studies.glob("*/examples"))
    assert "configurations" in call(surfexp, "plan", "experiment=isospectral_drums", cwd=empty)
    assert (empty / "results" / "sphere_distances" / "report.html").exists()

    # an edit in a compiled function that the plugin reaches through another module shows in the next run
    before = (empty / "results" / "sphere_distances" / "metrics.csv").read_text()
    sampling = site / "surfexp_shape_distributions" / "sampling.py"
    point = "(1.0 - root) * corners[0] + root * ((1.0 - t) * corners[1] + t * corners[2])"
    source_text = sampling.read_text()
    assert point in source_text
    sampling.write_text(source_text.replace(point, f"3.0 * ({point})"))
    call(surfexp, "run", "experiment=sphere_distances", cwd=empty)
    after = (empty / "results" / "sphere_distances" / "metrics.csv").read_text()
    median = [[float(row["median_distance"]) for row in csv.DictReader(io.StringIO(text))] for text in (before, after)]
    assert median[1] == pytest.approx([3.0 * value for value in median[0]], rel=1e-9)


def test_the_tests_of_the_package_pass(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", str(PACKAGE / "tests")]
    done = subprocess.run(
        command, capture_output=True, text=True, cwd=tmp_path, env={**os.environ, "PYTHONPATH": str(PACKAGE)}
    )
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.slow
def test_its_experiment_on_bodies_in_poses_ends_with_verdicts(tmp_path: Path) -> None:
    environment = {**os.environ, "PYTHONPATH": str(PACKAGE)}
    (tmp_path / "plugins" / "signature").mkdir(parents=True)
    shutil.copy(PACKAGE / "surfexp_shape_distributions" / "shape_distribution.py", tmp_path / "plugins" / "signature")
    (tmp_path / "conf").mkdir()
    shutil.copytree(PACKAGE / "surfexp_shape_distributions" / "conf" / "experiment", tmp_path / "conf" / "experiment")
    command = [sys.executable, "-P", "-m", "surfexp.commands.command_line", "run", "experiment=shape_distributions"]
    done = subprocess.run(command, capture_output=True, text=True, cwd=tmp_path, env=environment)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "The spectrum names every body in every pose" in done.stdout and "not computed" not in done.stdout
