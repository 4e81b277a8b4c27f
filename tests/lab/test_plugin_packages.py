"""An installed package of plugins: its configurations, its code and its experiments are seen as those of the working folder."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from surfexp.commands import arguments
from surfexp.lab.composition.hydra_plugins import ConfigurationFolders
from surfexp.lab.plan import remembered_plans
from surfexp.lab.plan.plan import Plan
from surfexp.lab.plan.resolution import make_plan
from surfexp.lab.registry import folders, loading, registry
from surfexp.lab.running import stage
from surfexp.lab.store import store
from surfexp.lab.store.kinds import KINDS

EXPERIMENT = "# @package _global_\nexperiment: of_a_package\ntarget: surface\nsurface: icosphere\n"


def install(place: Path, name: str, entry: str) -> None:
    """Write what pip leaves of a distribution with an entry point."""
    facts = place / f"{name}-1.0.dist-info"
    facts.mkdir()
    (facts / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: 1.0\n")
    (facts / "entry_points.txt").write_text(f"[surfexp.plugins]\n{name} = {entry}\n")


@pytest.fixture
def site(tmp_path: Path, working_folder: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A folder of installed packages, and a working folder beside it."""
    place = tmp_path / "site"
    place.mkdir()
    (tmp_path / "work").mkdir()
    monkeypatch.chdir(tmp_path / "work")
    monkeypatch.syspath_prepend(place)
    folders.entry_points_of_plugins.cache_clear()
    yield place
    folders.entry_points_of_plugins.cache_clear()


@pytest.fixture
def package(site: Path) -> Path:
    folder = site / "of_others"
    (folder / "conf" / "experiment").mkdir(parents=True)
    (folder / "conf" / "surface").mkdir()
    (folder / "__init__.py").write_text("raise RuntimeError('nothing is imported to find configurations')\n")
    (folder / "method.py").write_text("")
    (folder / "conf" / "experiment" / "of_a_package.yaml").write_text(EXPERIMENT)
    (folder / "conf" / "surface" / "of_a_preset.yaml").write_text("name: icosphere\nlevels: 2\n")
    install(site, "of_others", "of_others.method")
    return folder


def test_the_configurations_of_a_package_are_found_in_one_place(package: Path) -> None:
    from hydra._internal.config_search_path_impl import ConfigSearchPathImpl

    assert folders.experiments()["of_a_package"] == package / "conf" / "experiment" / "of_a_package.yaml"
    assert "of_a_preset" in arguments._presets("surface", None)
    path = ConfigSearchPathImpl()
    ConfigurationFolders().manipulate_search_path(path)
    assert [element.path for element in path.get_path()] == [f"file://{package / 'conf'}"]


def test_an_edited_configuration_of_a_package_is_planned_again(package: Path) -> None:
    asked = ["experiment=of_a_package"]
    before = remembered_plans.place(asked)
    assert before == remembered_plans.place(asked)
    file = package / "conf" / "experiment" / "of_a_package.yaml"
    file.write_text(EXPERIMENT + "title: Another\n")
    assert remembered_plans.place(asked) != before


def test_plugins_of_one_module_without_a_package_are_sources(site: Path) -> None:
    (site / "alone.py").write_text("")
    install(site, "alone", "alone")
    assert folders.installed_sources() == [site / "alone.py"] and not folders.package_configurations()


HEIGHTS = '''"""A kind of its own and a method, by relative imports."""

from dataclasses import dataclass

import numpy as np

from surfexp.lab.registry.registry import register
from surfexp.lab.store.kinds import stage_kind

from .numerics import factor


@dataclass(frozen=True, eq=False)
class Height:
    values: np.ndarray


stage_kind("height_of_{name}", Height)


@register("height_of_{name}", "scaled")
def scaled(count: int = 3) -> Height:
    """Multiples of a factor."""
    return Height(factor() * np.arange(float(count)))
'''


@pytest.fixture
def method(site: Path) -> Path:
    """A plugin of a package that imports relatively, under a name of each test's own."""
    name = f"of_{site.parent.name}"
    folder = site / name
    folder.mkdir()
    (folder / "__init__.py").write_text("")
    (folder / "numerics.py").write_text("def factor():\n    return 2.0\n")
    (folder / "method.py").write_text(HEIGHTS.format(name=name))
    install(site, name, f"{name}.method")
    return folder / "method.py"


def planned(method: Path) -> tuple[Plan, Path, str]:
    registry.load_file(method)
    plan = make_plan([{"target": f"height_of_{method.parent.name}", f"height_of_{method.parent.name}": "scaled"}])
    return plan, plan.write(Path("results")), plan.leaves[0].key


def test_a_plugin_that_imports_relatively_is_a_module_of_its_package(method: Path) -> None:
    plan, path, key = planned(method)
    assert stage.run_stage(path, key) == 0
    kind = KINDS[plan.nodes[key].kind]
    assert kind.path == f"{method.parent.name}.method:Height"
    assert store.load(Path("results"), kind.name, key).values.tolist() == [0.0, 2.0, 4.0]


def test_a_module_that_is_edited_beside_a_plugin_gives_no_result_under_the_old_key(method: Path) -> None:
    _, path, key = planned(method)
    (method.parent / "numerics.py").write_text("def factor():\n    return 3.0\n")
    assert stage.run_stage(path, key) == 1


def test_a_module_that_is_named_and_is_not_there_is_broken_and_the_rest_works(
    site: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(loading, "BROKEN", {})
    (site / "ends.py").write_text("raise SystemExit\n")
    install(site, "ends", "ends")
    install(site, "gone", "gone")
    for name, load in loading.loaders(site).items():
        if name in ("ends", "gone"):
            loading.guarded(name, load)
    assert set(loading.BROKEN) == {Path("ends"), Path("gone")}
    assert "plugin module gone does not exist" in loading.BROKEN[Path("gone")]
