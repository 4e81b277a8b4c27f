"""What `import surfexp` offers: lazy, documented, with examples that run."""

from __future__ import annotations

import doctest
import inspect
import subprocess
import sys

import numpy as np
import pytest

import surfexp as sx

FUNCTIONS = [name for name in sx.__all__ if inspect.isfunction(getattr(sx, name))]
CLASSES = [name for name in sx.__all__ if inspect.isclass(getattr(sx, name))]
HEAVY = ("mlflow", "snakemake", "hydra", "numba", "scipy", "matplotlib", "nibabel", "sklearn", "numpy")


def test_import_loads_nothing_heavy() -> None:
    code = f"import sys, surfexp; print([name for name in {HEAVY} if name in sys.modules])"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert run.stdout.strip() == "[]"


def test_tasks_never_load_the_workflow() -> None:
    code = "import sys, surfexp as sx\nfor name in sx.__all__: getattr(sx, name)\n"
    code += "print([n for n in ('mlflow', 'snakemake', 'hydra', 'surfexp.lab.plan', 'surfexp.lab.registry') if n in sys.modules])"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert run.stdout.strip() == "[]"


@pytest.mark.parametrize("name", FUNCTIONS)
def test_every_function_has_complete_numpydoc(name: str) -> None:
    function = getattr(sx, name)
    text = inspect.getdoc(function) or ""
    signature = inspect.signature(function)
    assert all(part in text for part in ("Parameters\n---", "Raises\n---") if signature.parameters), name
    for parameter in signature.parameters:
        assert parameter in text, f"{name}: {parameter} is not described"
    assert signature.return_annotation in ("None", None) or "Returns\n---" in text


@pytest.mark.parametrize("name", FUNCTIONS + CLASSES)
def test_examples_run(name: str, working_folder) -> None:
    offered = getattr(sx, name)
    runner = doctest.DocTestRunner(optionflags=doctest.NORMALIZE_WHITESPACE | doctest.ELLIPSIS)
    (test,) = doctest.DocTestFinder(recurse=False).find(offered, name, globs={"np": np})
    assert test.examples and runner.run(test).failed == 0


def test_unknown_names_are_refused() -> None:
    with pytest.raises(AttributeError, match="nosuch"):
        sx.nosuch  # noqa: B018
    assert set(sx.__all__) <= set(dir(sx))
