"""The wheel alone runs from an empty folder, and a package of plugins installed beside it takes part."""

from __future__ import annotations

import csv
import io
import shutil
import subprocess
import sys
import venv
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent.parent

PLUGIN = '''"""A third party's surface."""

import numpy as np
from pydantic import Field

from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.workflow.registry import Options, register
from thirdparty_surfaces.outer import scaled


class Tetrahedron(Options):
    size: float = Field(1.0, gt=0, description="edge length of the cube around it")


@register("surface", "tetrahedron")
def tetrahedron(options: Tetrahedron) -> Surface:
    """A tetrahedron from a third party."""
    vertices = options.size * np.array([[0.0, 0, 0], [1, 1, 0], [1, 0, 1], [0, 1, 1]])
    mesh = TriangleMesh(vertices, np.array([[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]]))
    return Surface(mesh, "tetrahedron", metrics={"area": scaled(mesh.area)})
'''
INNER = """from numba import njit

@njit(cache=True)
def factor(x):
    return 1.0 * x
"""
OUTER = """from numba import njit
from thirdparty_surfaces.inner import factor

@njit(cache=True)
def scaled(x):
    return factor(x)
"""
PROJECT = """[build-system]
requires = ["setuptools"]
build-backend = "setuptools.build_meta"
[project]
name = "thirdparty-surfaces"
version = "1.0"
[project.entry-points."surfexp.plugins"]
tetrahedron = "thirdparty_surfaces.tetrahedron"
[tool.setuptools]
packages = ["thirdparty_surfaces", "thirdparty_surfaces.conf"]
[tool.setuptools.package-data]
"thirdparty_surfaces.conf" = ["**/*.yaml"]
"""
EXPERIMENT = """# @package _global_
experiment: third
title: A third party's experiment
target: surface
surface: tetrahedron
"""


def call(*command: str | Path, cwd: Path) -> str:
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True, cwd=cwd)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.mark.timeout(3600)  # for what never ends: some forty processes start here, and a busy machine delays each
def test_the_wheel_and_a_third_party_package_run_from_an_empty_folder(tmp_path: Path) -> None:
    source = tmp_path / "source"
    ignored = shutil.ignore_patterns(
        ".git", ".venv", "results", ".snakemake", "*.egg-info", "build", "__pycache__", ".*cache"
    )
    shutil.copytree(ROOT, source, ignore=ignored)
    (source / "results").mkdir()
    third = tmp_path / "third"
    (third / "thirdparty_surfaces" / "conf" / "experiment").mkdir(parents=True)
    (third / "pyproject.toml").write_text(PROJECT)
    (third / "thirdparty_surfaces" / "__init__.py").write_text("")
    (third / "thirdparty_surfaces" / "conf" / "__init__.py").write_text("")
    (third / "thirdparty_surfaces" / "conf" / "experiment" / "third.yaml").write_text(EXPERIMENT)
    (third / "thirdparty_surfaces" / "tetrahedron.py").write_text(PLUGIN)
    (third / "thirdparty_surfaces" / "inner.py").write_text(INNER)
    (third / "thirdparty_surfaces" / "outer.py").write_text(OUTER)
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
    assert "quickstart" in listed and "third" in listed
    assert "tetrahedron" in call(surfexp, "run", "--help", cwd=empty)
    assert "surface size" in call(surfexp, "run", "experiment=third", "surface.size=1,2", cwd=empty)
    # what ships is there and is found: the experiments plan, and a stage runs (solvers compile for a minute, so none)
    assert "configurations" in call(surfexp, "plan", "experiment=quickstart", cwd=empty)
    call(surfexp, "run", "experiment=third", "surface=icosphere", "surface.levels=2", "results=other", cwd=empty)
    assert (empty / "other" / "third" / "report.html").exists()

    # an edit in a compiled function that the plugin reaches through another module shows in the next run
    before = (empty / "results" / "third" / "metrics.csv").read_text()
    inner = site / "thirdparty_surfaces" / "inner.py"
    inner.write_text(INNER.replace("1.0 * x", "3.0 * x"))
    call(surfexp, "run", "experiment=third", "surface.size=1,2", cwd=empty)
    after = (empty / "results" / "third" / "metrics.csv").read_text()
    area = [[float(row["area"]) for row in csv.DictReader(io.StringIO(text))] for text in (before, after)]
    assert area[1] == pytest.approx([3.0 * value for value in area[0]])
