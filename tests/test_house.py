"""How the house is built: no circle of files, no import upward, no package that nobody listed."""

from __future__ import annotations

import ast
import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import networkx as nx
import pytest

ROOT = Path(__file__).resolve().parent.parent
PACKAGES_OF_THE_LABORATORY = sorted(file.parent.name for file in (ROOT / "surfexp/lab").glob("*/__init__.py"))


def module_of(file: Path) -> str:
    parts = file.relative_to(ROOT).with_suffix("").parts
    parts = (parts[0].replace("studies", "surfexp_studies"), *parts[1:])
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def executed(node: ast.AST) -> Iterator[ast.AST]:
    """All nodes below one, but those that only type checkers read."""
    for child in ast.iter_child_nodes(node):
        if not (isinstance(child, ast.If) and "TYPE_CHECKING" in ast.dump(child.test)):
            yield child
            yield from executed(child)


def imports_of_files(files: dict[str, str]) -> nx.DiGraph:
    """Which module imports which, wherever in a file; `files` are sources by module."""
    graph = nx.DiGraph()
    for module, source in files.items():
        for node in executed(ast.parse(source)):
            named: list[str] = []
            if isinstance(node, ast.ImportFrom):
                above = module.split(".")[: -node.level] if node.level else []
                base = ".".join([*above, *([node.module] if node.module else [])])
                named = [name if (name := f"{base}.{item.name}") in files else base for item in node.names]
            elif isinstance(node, ast.Import):
                named = [item.name for item in node.names]
            # the package itself imports only when a name of its face is asked for
            graph.add_edges_from((module, name) for name in named if name in files and name != "surfexp")
    return graph


def circles(files: dict[str, str]) -> list[list[str]]:
    return [sorted(part) for part in nx.strongly_connected_components(imports_of_files(files)) if len(part) > 1]


def sources() -> dict[str, str]:
    files = (file for folder in ("surfexp", "studies") for file in (ROOT / folder).rglob("*.py"))
    return {module_of(file): file.read_text() for file in files}


def test_no_files_import_each_other_in_a_circle() -> None:
    assert circles(sources()) == []


def test_a_planted_circle_is_seen() -> None:
    files = sources()
    files["surfexp.mesh.triangle_mesh"] += "\ndef late() -> None:\n    from surfexp.mesh.surface import Surface\n"
    assert any("surfexp.mesh.triangle_mesh" in part for part in circles(files))


@pytest.fixture(scope="module")
def linted_with_planted_imports(tmp_path_factory: pytest.TempPathFactory) -> str:
    """What the import contracts say where a file of `mesh` imports each package of the laboratory, beside an unlisted package."""
    folder = tmp_path_factory.mktemp("house")
    for part, package in (("surfexp", "surfexp"), ("studies", "surfexp_studies")):
        shutil.copytree(ROOT / part, folder / package, ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copy(ROOT / "pyproject.toml", folder)
    with (folder / "surfexp/mesh/noise.py").open("a") as noise:
        noise.writelines(f"import surfexp.lab.{package}\n" for package in PACKAGES_OF_THE_LABORATORY)
        noise.write("import surfexp_studies.planted.code\n")
    for name, imported in (("planted", "pathlib"), ("nosy", "surfexp_studies.planted.code")):
        (folder / "surfexp_studies" / name).mkdir()
        (folder / "surfexp_studies" / name / "__init__.py").write_text(f'"""A study called {name}."""\n')
        (folder / "surfexp_studies" / name / "code.py").write_text(f"import {imported}\n")
    (folder / "surfexp/attic").mkdir()
    (folder / "surfexp/attic/__init__.py").write_text('"""A package that nobody listed."""\n')
    command = [
        sys.executable,
        "-c",
        "import sys; from importlinter.cli import lint_imports_command as c; sys.exit(c())",
    ]
    done = subprocess.run(
        [*command, "--no-cache"],
        cwd=folder,
        capture_output=True,
        text=True,
        env={**os.environ, "PYTHONPATH": str(folder)},
    )
    assert done.returncode != 0, done.stdout
    return done.stdout + done.stderr


@pytest.mark.parametrize("package", PACKAGES_OF_THE_LABORATORY)
def test_the_numerics_may_import_no_package_of_the_laboratory(package: str, linted_with_planted_imports: str) -> None:
    assert f"surfexp.mesh.noise -> surfexp.lab.{package}" in linted_with_planted_imports


def test_the_library_may_import_no_study(linted_with_planted_imports: str) -> None:
    assert "surfexp.mesh.noise -> surfexp_studies.planted.code" in linted_with_planted_imports


def test_a_study_may_import_no_other(linted_with_planted_imports: str) -> None:
    assert "surfexp_studies.nosy.code -> surfexp_studies.planted.code" in linted_with_planted_imports


def test_a_package_that_is_not_listed_is_refused(linted_with_planted_imports: str) -> None:
    assert "attic" in linted_with_planted_imports


@pytest.mark.parametrize(
    "module",
    ["linalg/ldlt", "linalg/block_lanczos", "skeleton/fast_marching", "io/ply", "io/vtk", "figures/rasterizer"],
)
def test_what_a_library_might_do_says_why_it_is_written_by_hand(module: str) -> None:
    reason = (ast.get_docstring(ast.parse((ROOT / "surfexp" / f"{module}.py").read_text())) or "").partition(
        "\nBy hand: "
    )[2]
    assert len(reason) > 80
