"""Keys see the meaning of the code that a plugin reaches, through any number of modules, and nothing else."""

from __future__ import annotations

import ast
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from surfexp.lab.plan import code_digests, source_code
from surfexp.lab.plan.shown_text import without_shown_text
from surfexp.lab.registry.folders import package_folder, shipped_plugin_folders, studies_folder
from surfexp.lab.registry.loading import load_all

SHOWING = {"lab", "records", "report", "reproduction", "commands"}


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
    source_code.statements.cache_clear()
    source_code._parts.cache_clear()
    source_code.needed_by.cache_clear()
    for function in vars(code_digests).values():
        if hasattr(function, "cache_clear"):
            function.cache_clear()


def digest(file: Path) -> str:
    forget()
    return code_digests.code_digest(file)


def test_closure_reaches_through_modules_and_lists_outside_packages(package: Path) -> None:
    files, packages = code_digests.code_closure(package / "method.py")
    assert {file.name for file in files} == {"method.py", "helper.py", "deep.py", "__init__.py"}
    assert packages == {"numpy"}


def test_only_meaning_counts(package: Path) -> None:
    before = digest(package / "method.py")
    (package / "deep.py").write_text('"""New docstring."""\n# comment\ndef h(x):\n    """Doc."""\n    return x+1\n')
    (package / "unreached.py").write_text("y = 2\n")
    assert digest(package / "method.py") == before
    (package / "deep.py").write_text("def h(x):\n    return x + 2\n")
    assert digest(package / "method.py") != before


@pytest.mark.parametrize(
    ("origin", "seen"), [(None, True), ('{"dir_info": {"editable": true}}', True), ('{"dir_info": {}}', False)]
)
def test_sources_count_of_what_changes_under_one_version(package: Path, origin: str | None, seen: bool) -> None:
    """A folder on the path without a version, and a package installed editable; not one whose version tells what it is."""
    if origin is not None:
        facts = package.parent / f"{package.name}-1.0.dist-info"
        facts.mkdir()
        (facts / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {package.name}\nVersion: 1.0\n")
        (facts / "direct_url.json").write_text(origin)
    plugin = package.parent / "plugins" / "mine.py"
    plugin.parent.mkdir()
    plugin.write_text(f"from {package.name} import helper\n\ndef f(x):\n    return helper.g(x)\n")
    before = digest(plugin)
    assert code_digests.code_closure(plugin)[1] == {package.name}
    (package / "deep.py").write_text("def h(x):\n    return x + 2\n")
    assert (digest(plugin) != before) == seen


def test_the_framework_is_not_part_of_a_key() -> None:

    plugins = package_folder("surfexp.plugins")
    files, packages = code_digests.code_closure(plugins / "operator" / "fem.py")
    names = {file.parent.name + "/" + file.name for file in files}
    assert "operators/fem.py" in names and "mesh/triangle_mesh.py" in names
    folders = {
        file.relative_to(code_digests.PACKAGE).parts[0] for file in files if file.is_relative_to(code_digests.PACKAGE)
    }
    assert not folders & (SHOWING | {"tasks"})
    assert {"numpy", "scipy"} <= packages


def test_nothing_that_shows_results_is_part_of_any_key() -> None:
    from surfexp.lab.registry import registry

    load_all(Path("/nonexistent"))
    shown = {code_digests.PACKAGE / folder for folder in SHOWING}
    assert all(folder.is_dir() for folder in shown)
    for plugin in registry.PLUGINS.values():
        if {*shipped_plugin_folders()} & {*plugin.file.parents}:
            files, _ = code_digests.code_closure(plugin.file)
            assert not {file for file in files for folder in shown if file.is_relative_to(folder)}, plugin.name
            assert not {code_digests.PACKAGE / "__init__.py", code_digests.PACKAGE / "face.py"} & files, plugin.name


def test_imports_for_type_checkers_do_not_count(package: Path) -> None:
    method = package / "method.py"
    method.write_text(
        "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    from . import unreached\nelse:\n    from . import deep\n"
    )
    forget()
    assert {file.name for file in code_digests.code_closure(method)[0]} == {"method.py", "deep.py", "__init__.py"}


@pytest.mark.parametrize(
    ("code", "reached", "unreached"),
    [
        ("import surfexp as sx\n\ndef f(x):\n    return sx.denoise(x)\n", "denoising.py", "signature_transformers.py"),
        ("import surfexp\n\ndef f(x):\n    return surfexp.denoise(x)\n", "denoising.py", "signature_transformers.py"),
        (
            "from surfexp import denoise\n\ndef f(x):\n    return denoise(x)\n",
            "denoising.py",
            "signature_transformers.py",
        ),
        ("def f(x):\n    import surfexp as sx\n    return getattr(sx, x)\n", "signature_transformers.py", ""),
    ],
)
def test_what_a_plugin_takes_from_the_face_counts(package: Path, code: str, reached: str, unreached: str) -> None:
    method = package / "method.py"
    method.write_text(code)
    forget()
    names = {file.name for file in code_digests.code_closure(method, "f")[0]}
    assert reached in names and unreached not in names


PAIR = '''"""Two methods of one file."""
from __future__ import annotations
import numpy as np
import {package}.effect
from .left import left
from .right import right as of_the_right

SCALE = 2.0
OTHER = 3.0
TABLE = dict(scale=1)


def helper(x: Shared) -> float:
    return SCALE * x


class Shared:
    size = 1


def other_helper(x):
    return OTHER * x


@register("solver", "first")
def first(options: Shared):
    return left(np.ones(3)) + helper(1)


@register("solver", "second")
def second(options: Shared):
    return of_the_right(other_helper(1))
'''


@pytest.fixture
def pair(package: Path) -> Path:
    """A file of two plugins; the first reaches `left`, `helper`, `SCALE` and `Shared`, the second `right` and `other_helper`."""
    for name in ("left", "right", "effect"):
        (package / f"{name}.py").write_text(f"def {name}(x):\n    return x\n")
    (package / "pair.py").write_text(PAIR.format(package=package.name))
    return package / "pair.py"


def digests(file: Path) -> tuple[str, str]:
    forget()
    return code_digests.code_digest(file, "first"), code_digests.code_digest(file, "second")


@pytest.mark.parametrize(
    ("file", "old", "new", "changed"),
    [
        ("pair", "np.ones(3)", "np.ones(4)", (True, False)),
        ("pair", "other_helper(1)", "other_helper(2)", (False, True)),
        ("pair", '("solver", "second")', '("solver", "second", metrics=OTHER)', (False, True)),
        ("pair", "return SCALE * x", "return SCALE + x", (True, False)),
        ("pair", "SCALE = 2.0", "SCALE = 2.5", (True, False)),
        ("pair", "OTHER = 3.0", "OTHER = 3.5", (False, True)),
        ("pair", "size = 1", "size = 2", (True, True)),
        ("pair", "dict(scale=1)", "dict(scale=2)", (True, True)),
        ("pair", "import right as of_the_right", "import left as of_the_right", (False, True)),
        ("pair", '"""Two methods of one file."""', '"""Said otherwise."""', (False, False)),
        ("left", "return x", "return -x", (True, False)),
        ("right", "return x", "return -x", (False, True)),
        ("effect", "return x", "return -x", (True, True)),
    ],
)
def test_an_edit_counts_for_the_function_that_it_reaches(
    pair: Path, file: str, old: str, new: str, changed: tuple[bool, bool]
) -> None:
    before = digests(pair)
    edited = pair.with_name(f"{file}.py")
    text = edited.read_text()
    assert old in text
    edited.write_text(text.replace(old, new))
    assert tuple(a != b for a, b in zip(before, digests(pair), strict=True)) == changed


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("return of_the_right(other_helper(1))", "return globals()['left'](1)"),
        ("return of_the_right(other_helper(1))", "return importlib.import_module(options.name)"),
        ("import numpy as np", "import numpy as np\nfrom math import *"),
        ("from .right import", "from .again import"),
        ("def second(options", "def second(x):\n    return 1\n\n\ndef second(options"),
        ("import numpy as np", "import numpy as np\nHANDLERS = []"),
    ],
)
def test_where_it_cannot_be_told_the_whole_file_counts(pair: Path, old: str, new: str) -> None:
    (pair.parent / "again.py").write_text("from .pair import first as right\n")
    text = PAIR.format(package=pair.parent.name).replace(old, new)
    if "HANDLERS" in new:
        text = text.replace('@register("solver", "first")', '@HANDLERS.append\n@register("solver", "first")')
    pair.write_text(text)
    before = digests(pair)[1]
    pair.write_text(text.replace("np.ones(3)", "np.ones(4)"))
    assert digests(pair)[1] != before


@pytest.mark.parametrize(
    ("code", "counts"),
    [
        ("from surfexp.contract.metric import Metric\nx = Metric('one', bound=2)\n", False),
        ("from surfexp.contract import metric\nx = metric.Metric('one', bound=2)\n", False),
        ("import surfexp.contract.metric\nx = surfexp.contract.metric.Metric('one')\n", False),
        ("from surfexp.contract.metric import Metric\nx = Metric('some', bound='one')\n", True),
        ("class Metric:\n    def __init__(self, name): self.name = name\nx = Metric('one')\n", True),
        ("from geometry import Metric\nx = Metric('one')\n", True),
        ("from pydantic import Field\nx = Field(ge=0, description='one')\n", False),
        ("import pydantic as p\nx = p.Field(ge=0, title='one')\n", False),
        ("from physics import Field\nx = Field(title='one')\n", True),
        ("from .events import register\nx = register(exports='one')\n", True),
    ],
)
def test_descriptions_are_left_out_of_what_is_ours_alone(code: str, counts: bool) -> None:
    """A class of another's that is called Metric is code like any other."""
    one, other = (ast.dump(without_shown_text(ast.parse(code.replace("one", word)))) for word in ("one", "other"))
    assert (one != other) == counts


REGISTERED = """
from pydantic import Field
from surfexp.lab.registry.registry import register
from .left import left
from .right import right

METRICS = {{"a": 1}}
register("solver", "first", metrics=METRICS, options={{"n": Field(ge=0, description="a number")}})(left)
register("solver", "second", options={{"n": Field(ge=1)}})(right)
"""


@pytest.mark.parametrize(
    ("file", "old", "new", "changed"),
    [
        ("left", "return x", "return -x", (True, False)),
        ("right", "return x", "return -x", (False, True)),
        ("registered", "ge=0", "ge=2", (True, False)),
        ("registered", '"a": 1', '"a": 2', (True, False)),
        ("registered", "ge=1", "ge=2", (False, True)),
        ("registered", "a number", "another", (False, False)),
    ],
)
def test_a_registered_function_has_the_key_of_what_it_reaches(
    pair: Path, file: str, old: str, new: str, changed: tuple[bool, bool]
) -> None:
    registered = pair.with_name("registered.py")
    registered.write_text(REGISTERED.format())

    def both() -> list[str]:
        forget()
        return [code_digests.code_digest(registered, name) for name in ("left", "right")]

    before = both()
    assert registered not in code_digests.code_closure(registered, "left")[0]
    edited = pair.with_name(f"{file}.py")
    edited.write_text(edited.read_text().replace(old, new))
    assert tuple(a != b for a, b in zip(before, both(), strict=True)) == changed


def test_a_function_that_is_made_elsewhere_takes_its_whole_file(pair: Path) -> None:
    forget()
    assert code_digests.code_digest(pair, "maker.<locals>.made") != code_digests.code_digest(pair, "first")
    assert pair in code_digests.code_closure(pair, "maker.<locals>.made")[0]
    assert pair not in code_digests.code_closure(pair, "first")[0]


def test_what_a_study_imports_of_itself_is_part_of_its_keys() -> None:
    studies, followed = studies_folder(), 0
    assert studies is not None
    for file in studies.glob("*/*.py"):
        for node in ast.walk(ast.parse(file.read_text())):
            if isinstance(node, ast.ImportFrom) and node.level == 1 and node.module:
                assert file.with_name(f"{node.module}.py") in code_digests.code_closure(file)[0], file
                followed += 1
    assert followed


def test_every_plugin_of_the_package_is_told_apart() -> None:
    from surfexp.lab.registry import registry

    load_all(Path("/nonexistent"))
    shipped = {*shipped_plugin_folders()}
    own = [plugin for plugin in registry.PLUGINS.values() if shipped & {*plugin.file.parents}]
    assert len(own) > 100
    for plugin in own:
        assert source_code.needed_by(plugin.file, plugin.function.__qualname__) is not None, plugin.name
