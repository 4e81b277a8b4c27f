"""Where plugins and configurations lie: beside the package, in its studies, in installed packages, in the working folder."""

from __future__ import annotations

import importlib.util
from functools import cache
from importlib.metadata import EntryPoint, entry_points
from pathlib import Path

STUDIES = "surfexp_studies"


def package_folder(name: str) -> Path:
    """Folder of one of the packages that ship beside the code: `surfexp.plugins`, `surfexp.conf`."""
    return folders_of(name)[0]


def folders_of(name: str) -> list[Path]:
    """Folders of a package, several of a namespace package; none where it is a module or is not there."""
    specification = importlib.util.find_spec(name)
    places = specification.submodule_search_locations if specification else None
    return [Path(place).resolve() for place in places or ()]


@cache
def studies_folder() -> Path | None:
    """Folder of the studies that ship beside the code, one folder a study; None where they were left out."""
    return next((folder for folder in folders_of(STUDIES) if folder.is_dir()), None)


@cache
def entry_points_of_plugins() -> tuple[EntryPoint, ...]:
    """Where installed packages bring plugins: to find out reads what every installed distribution says of itself."""
    return tuple(entry_points(group="surfexp.plugins"))


def installed_packages() -> list[str]:
    """Names of the installed packages that bring plugins: those of the entry points `surfexp.plugins`."""
    return sorted({point.module.split(".")[0] for point in entry_points_of_plugins()})


def installed_sources() -> list[Path]:
    """Every Python file of the installed packages that bring plugins, and of modules that do so by themselves."""
    names = installed_packages()
    of_packages = (sorted(folder.rglob("*.py")) for name in names for folder in folders_of(name))
    return [*(file for files in of_packages for file in files), *filter(None, map(_file_of, names))]


def module_of(file: Path) -> str:
    """Name by which Python imports a file of an installed package that brings plugins; "" for any other file."""
    for name in installed_packages():
        for folder in folders_of(name):
            if file.is_relative_to(folder):
                parts = (name, *file.relative_to(folder).with_suffix("").parts)
                return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)
        if file == _file_of(name):
            return name
    return ""


def _file_of(name: str) -> Path | None:
    """File of a module that is no package."""
    specification = importlib.util.find_spec(name)
    if specification is None or specification.submodule_search_locations or not specification.origin:
        return None
    return Path(specification.origin).resolve()


def package_configurations() -> list[Path]:
    """The folders `conf` of installed packages that bring plugins."""
    folders = [folder / "conf" for name in installed_packages() for folder in folders_of(name)]
    return [folder for folder in folders if folder.is_dir()]


def configurations(config_dir: Path | None = None) -> list[Path]:
    """All folders of configuration files: of the package, of plugin packages, of the working folder, of `--config-dir`."""
    return [
        package_folder("surfexp.conf"),
        *package_configurations(),
        Path("conf"),
        *([config_dir] if config_dir else []),
    ]


def shipped_plugin_folders() -> list[Path]:
    """The folders of plugins that ship beside the code: the package's own, and one of each study that brings plugins."""
    studies = studies_folder()
    return [package_folder("surfexp.plugins"), *(sorted(studies.glob("*/plugins")) if studies else ())]


def shipped_sources() -> list[Path]:
    """Every Python file that ships beside the plugins: those of the package and of its studies."""
    package, studies = Path(__file__).resolve().parents[2], studies_folder()
    return sorted(file for folder in (package, studies) if folder for file in folder.rglob("*.py"))


def plugin_files(working_folder: Path) -> list[Path]:
    """Plugin files of the package, of its studies, and of `plugins/` in a working folder, one folder a kind."""
    folders = dict.fromkeys((*shipped_plugin_folders(), (working_folder / "plugins").resolve()))
    files = (file for folder in folders for file in sorted(folder.glob("*/*.py")))
    return [file for file in files if file.name != "__init__.py"]


def sources(working_folder: Path) -> list[Path]:
    """Every file that plugins are made of: their own, those of the package and of its studies, and of packages with plugins."""
    return [*plugin_files(working_folder), *shipped_sources(), *installed_sources()]


def experiments(config_dir: Path | None = None) -> dict[str, Path]:
    """Experiment name to YAML file, of all folders of configuration files."""
    folders = configurations(config_dir)
    return {file.stem: file for folder in folders for file in sorted((folder / "experiment").glob("*.yaml"))}
