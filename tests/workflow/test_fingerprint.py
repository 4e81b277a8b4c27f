"""Keys see the meaning of the code that a plugin reaches, through any number of modules, and nothing else."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from surfexp.workflow import fingerprint


@pytest.fixture
def package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    folder = tmp_path / f"thirdparty_{tmp_path.name}"
    folder.mkdir()
    (folder / "__init__.py").write_text("")
    (folder / "method.py").write_text(
        '"""Doc."""\nfrom . import helper\nimport numpy\n\ndef f(x):\n    return helper.g(x)\n'
    )
    (folder / "helper.py").write_text(f"from {folder.name}.deep import h\n\ndef g(x):\n    return h(x)\n")
    (folder / "deep.py").write_text("def h(x):\n    return x + 1\n")
    (folder / "unreached.py").write_text("y = 1\n")
    monkeypatch.syspath_prepend(tmp_path)
    forget()
    yield folder
    sys.modules.pop(folder.name, None)
    forget()


def forget() -> None:
    for function in vars(fingerprint).values():
        if hasattr(function, "cache_clear"):
            function.cache_clear()


def digest(file: Path) -> str:
    forget()
    return fingerprint.code_digest(file)


def test_closure_reaches_through_modules_and_lists_outside_packages(package: Path) -> None:
    files, packages = fingerprint.code_closure(package / "method.py")
    assert {file.name for file in files} == {"method.py", "helper.py", "deep.py", "__init__.py"}
    assert packages == {"numpy"}


def test_only_meaning_counts(package: Path) -> None:
    before = digest(package / "method.py")
    (package / "deep.py").write_text('"""New docstring."""\n# comment\ndef h(x):\n    """Doc."""\n    return x+1\n')
    (package / "unreached.py").write_text("y = 2\n")
    assert digest(package / "method.py") == before
    (package / "deep.py").write_text("def h(x):\n    return x + 2\n")
    assert digest(package / "method.py") != before


def test_the_framework_is_not_part_of_a_key() -> None:
    import surfexp.workflow.registry as registry

    plugins = registry.package_folder("surfexp.plugins")
    files, packages = fingerprint.code_closure(plugins / "operator" / "fem.py")
    names = {file.parent.name + "/" + file.name for file in files}
    assert "operators/fem.py" in names and "mesh/triangle_mesh.py" in names
    assert not any("workflow" in str(file) for file in files)
    assert {"numpy", "scipy"} <= packages
