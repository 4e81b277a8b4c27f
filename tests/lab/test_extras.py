"""What is declared is imported, what is imported is declared, and the core works without the extras."""

from __future__ import annotations

import ast
import os
import re
import subprocess
import sys
import tomllib
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from surfexp import extras

ROOT = Path(__file__).resolve().parent.parent.parent
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
MODULES = {
    "scikit-learn": "sklearn",
    "resvg-py": "resvg_py",
    "snakemake-executor-plugin-slurm": "snakemake_executor_plugin_slurm",
} | {package: module for module, (package, _) in extras.EXTRAS.items()}
# loaded by Hydra and by Snakemake, which find them by the name that stands in these files
FOUND_BY_NAME = {
    "hydra-optuna-sweeper": ("docs/guide.md", "hydra/sweeper=optuna"),
    "snakemake-executor-plugin-slurm": ("profiles/slurm/config.yaml", "executor: slurm"),
}
TOOLS = ("dev", "bench", "reliability", "site", "print", "all")


def name_of(requirement: str) -> str:
    return re.split(r"[^\w.-]", requirement)[0]


@cache
def declared(group: str) -> frozenset[str]:
    """Packages of the core ("") or of an extra, those of the extras that it contains included."""
    lines = PROJECT["optional-dependencies"][group] if group else PROJECT["dependencies"]
    packages = {name_of(line) for line in lines} - {"surfexp"}
    for line in lines:
        inner = re.fullmatch(r"surfexp\[(.*)\]", line)
        packages |= {name for extra in (inner.group(1).split(",") if inner else ()) for name in declared(extra)}
    return frozenset(packages)


def imports(file: Path) -> set[tuple[str, bool]]:
    """Top-level outside modules that a file imports, asks for by name or runs, and whether as soon as it is imported."""
    tree = ast.parse(file.read_bytes())
    lazy = {id(node) for part in ast.walk(tree) if isinstance(part, ast.FunctionDef) for node in ast.walk(part)}
    typed = {
        id(node)
        for part in ast.walk(tree)
        if isinstance(part, ast.If) and "TYPE_CHECKING" in ast.dump(part.test)
        for node in ast.walk(part)
    }
    names: set[tuple[str, bool]] = set()
    for node in ast.walk(tree):
        found: list[str] = []
        if isinstance(node, ast.Import):
            found = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom) and not node.level:
            found = [node.module or ""]
        elif isinstance(node, ast.Call) and node.args:
            called = getattr(node.func, "id", getattr(node.func, "attr", ""))
            if called in ("find_spec", "import_module") and isinstance(node.args[0], ast.Constant):
                found = [node.args[0].value]
            elif called == "require_installed":
                found = [argument.value for argument in node.args[1:] if isinstance(argument, ast.Constant)]
        elif isinstance(node, ast.List):
            texts = [getattr(item, "value", None) for item in node.elts]
            found = [str(texts[texts.index("-m") + 1])] if "-m" in texts[:-1] else []
            found = [name for name in found if not name.startswith("-")]  # a list of options, no command
        eager = id(node) not in lazy and id(node) not in typed
        names |= {(name.split(".")[0], eager) for name in found}
    known = sys.stdlib_module_names | {"surfexp", "hydra_plugins"}
    return {(name, eager) for name, eager in names if name not in known and not name.startswith("surfexp_")}


def allowed_at_once(file: Path) -> frozenset[str]:
    """Packages that a file may import as soon as it is imported, by the package where it stands."""
    folder = file.relative_to(ROOT).parts[1] if file.is_relative_to(ROOT / "surfexp") else "plugins"
    if folder in ("lab", "records", "report", "reproduction", "commands", "plugins"):
        return declared("") | declared("lab")
    return declared("") | (declared("figures") if folder in ("figures", "drawings") else frozenset())


SOURCES = [
    file
    for folder in ("surfexp", "plugins", "studies")
    for file in (ROOT / folder).rglob("*.py")
    if "tests" not in file.relative_to(ROOT).parts
]
PICTURES = {"surfexp/tasks/pictures.py", "surfexp/variational/images/pictures.py"}


def test_every_import_is_declared_where_it_is_needed() -> None:
    packages = {module: package for package, module in MODULES.items()}
    everywhere = declared("") | declared("all") | declared("print")
    for file in SOURCES:
        here = file.relative_to(ROOT).as_posix()
        at_once = allowed_at_once(file) | (declared("figures") if here in PICTURES else frozenset())
        for module, eager in imports(file):
            package = packages.get(module, module)
            assert package in everywhere, f"{here} imports {module}, which pyproject.toml does not declare"
            assert not eager or package in at_once, f"{here} imports {module} at once, which is no part of its package"


def test_every_declared_package_is_imported() -> None:
    imported = {module for file in SOURCES for module, _ in imports(file)}
    for package in declared("") | declared("all"):
        if package in FOUND_BY_NAME:
            file, word = FOUND_BY_NAME[package]
            assert word in (ROOT / file).read_text(), package
        else:
            assert MODULES.get(package, package) in imported, f"nothing imports {package}"


def test_the_table_of_extras_is_that_of_the_project() -> None:
    for module, (package, extra) in extras.EXTRAS.items():
        assert package in declared(extra), f"{module}: {package} is not in the extra {extra}"
    listed = {package for package, _ in extras.EXTRAS.values()}
    optional = declared("all") - declared("") - set(FOUND_BY_NAME)
    assert optional == listed
    groups = set(PROJECT["optional-dependencies"]) - set(TOOLS)
    assert declared("all") == frozenset().union(*map(declared, groups))


def test_the_lock_holds_what_development_needs() -> None:
    locked = set(re.findall(r"^([\w.-]+)==", (ROOT / "requirements.lock").read_text(), flags=re.MULTILINE))
    needed = {name.lower().replace("_", "-") for name in declared("") | declared("dev")}
    assert needed <= {name.lower().replace("_", "-") for name in locked}


WITHOUT_EXTRAS = """
import sys
class Absent:
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] in {absent!r}:
            raise ModuleNotFoundError(f"No module named {{name!r}}", name=name)
sys.meta_path.insert(0, Absent())
import importlib.util
find_spec = importlib.util.find_spec
def found(name, package=None):
    try:
        return find_spec(name, package)
    except ModuleNotFoundError:
        return None
importlib.util.find_spec = found
"""
COMMANDS = """
from pathlib import Path
import surfexp as sx
from surfexp.commands.command_line import main
import numpy as np
ball = sx.shape("ellipsoid", levels=2)
sx.write("ball.ply", ball); sx.write("other.ply", sx.shape("icosphere", levels=2))
np.savetxt("height.csv", ball.mesh.vertices[:, 2], header="height", comments="")
for line in (
    "modes ball.ply -k 6 --to modes.npz",
    "denoise ball.ply height.csv --noise 0.1 --to clean.shape.gii",
    "smooth ball.ply height.csv --width 0.3 --to smooth.mgh",
    "segment ball.ply height.csv --to parts.label.gii",
    "skeleton ball.ply height.csv --to skeleton.vtk",
    "distance ball.ply other.ply -n 3 --to map.npz",
    "align ball.ply other.ply -k 3 --to aligned.npz",
    "fingerprint ball.ply other.ply -k 4 --to table.csv",
    "geodesic ball.ply 0 --to distance.csv",
    "curvature ball.ply --to curvature.vtp",
    "convert ball.ply ball.vtk",
    "check ball.ply",
    "repair ball.ply --to sound.ply",
    "doctor",
):
    assert main(line.split()) == 0, line
Path("results/store").mkdir(parents=True)
for line in ("plot ball.ply --to ball.png", "run experiment=quickstart", "list", "table", "clean", "collect . --to x"):
    print(main(line.split()), line)
"""


def without_extras(code: str, folder: Path) -> subprocess.CompletedProcess[str]:
    absent = set(extras.EXTRAS) | {"scikit-image", "hydra_plugins"}
    program = WITHOUT_EXTRAS.format(absent=absent) + code
    environment: dict[str, Any] = {**os.environ, "OMP_NUM_THREADS": "1"}
    return subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, cwd=folder, env=environment)


def test_the_file_commands_need_no_extra(tmp_path: Path) -> None:
    done = without_extras(COMMANDS, tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr
    refused = [line for line in done.stderr.splitlines() if line.startswith("surfexp: ")]
    assert [line[:1] for line in done.stdout.splitlines()[-6:]] == ["2"] * 6
    assert len(refused) == 6
    assert "plot needs" in refused[0] and refused[0].endswith("pip install 'surfexp[figures]'")
    assert all(line.endswith("not installed: pip install 'surfexp[lab]'") for line in refused[1:]), refused


def test_python_names_say_in_one_line_what_to_install(tmp_path: Path) -> None:
    code = "\n".join(
        [
            "import surfexp as sx",
            "ball = sx.shape('icosphere', levels=1)",
            "for call in (lambda: sx.plot(ball), lambda: sx.load('quickstart'), lambda: sx.shape('fsaverage5')):",
            "    try:",
            "        call()",
            "    except ImportError as error:",
            "        print(error)",
        ]
    )
    done = without_extras(code, tmp_path)
    lines = done.stdout.splitlines()
    assert [re.findall(r"surfexp\[(\w+)\]", line) for line in lines] == [["figures"], ["lab"], ["anatomy"]], done.stderr


def test_a_package_that_runs_on_no_new_python_is_named_with_the_python_to_take(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "version_info", (3, 14, 0, "final", 0))
    line = extras.missing_line("surfexp run", ["pandas", "hydra"])
    assert "hydra-core, which runs on no Python from 3.14 on: take Python 3.13" in line and "pip install" not in line
    assert "pip install 'surfexp[lab]'" in extras.missing_line("surfexp run", ["pandas"])
    monkeypatch.setattr(sys, "version_info", (3, 13, 9, "final", 0))
    assert "pip install 'surfexp[lab]'" in extras.missing_line("surfexp run", ["hydra"])


def test_what_runs_on_no_new_python_is_not_installed_there() -> None:
    lines = [line for extra in PROJECT["optional-dependencies"].values() for line in extra]
    for module, (major, minor) in extras.TOO_NEW.items():
        package = extras.EXTRAS[module][0]
        marked = [line for line in lines if name_of(line) == package]
        assert marked and all(f"python_version < '{major}.{minor}'" in line for line in marked)
