"""An installed package of plugins: its configurations, its code and its experiments are seen as those of the working folder."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from surfexp.commands import arguments
from surfexp.lab.composition.launch import ConfigurationFolders
from surfexp.lab.plan import remembered_plans
from surfexp.lab.registry import folders

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
