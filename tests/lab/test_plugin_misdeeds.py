"""Whatever a plugin file does when it is imported, it is named and everything else works."""

from __future__ import annotations

import importlib
import time
from pathlib import Path

import pytest

from surfexp.lab.errors import UserError
from surfexp.lab.registry import catalogue as plugins
from surfexp.lab.registry import contained, registry
from surfexp.lab.registry.contained import contained_description
from surfexp.lab.registry.folders import sources
from surfexp.lab.registry.imported import imported_from_elsewhere

GOOD = '''"""A plugin that works."""

from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.surface import Surface
from surfexp.lab.registry.registry import register


@register("surface", "well")
def well() -> Surface:
    """A sphere."""
    return icosphere(2)
'''
MISDEEDS = {
    "exits": ("import os\nos._exit(0)", "ends the process with exit status 0"),
    "exits_with_3": ("import os\nos._exit(3)", "ends the process with exit status 3"),
    "is_killed": ("import os, signal\nos.kill(os.getpid(), signal.SIGKILL)", "ended by signal 9 (SIGKILL)"),
    "crashes": ("import ctypes\nctypes.string_at(0)", "ended by signal 11 (SIGSEGV)"),
    "hangs": ("import threading\nthreading.Event().wait()", "takes longer than 30 s"),
    "loops": ("while True:\n    pass", "takes longer than 30 s"),
    "leaves": ("import sys\nsys.exit(0)", "line 2: 0"),
    "interrupts": ("raise KeyboardInterrupt", "ended by signal 2 (SIGINT)"),
    "eats_memory": ("x = bytearray(1 << 40)", "line 1"),
    "is_no_python": ("def f(:", "line 1"),
    "divides": ("1 / 0", "line 1: division by zero"),
    "closes_everything": ("import os\nos.closerange(0, 4096)", "ends the process"),
    "closes_everything_and_hangs": ("import os\nos.closerange(0, 4096)\nwhile True:\n    pass", "takes longer than"),
    "talks_for_ever": ("raise ValueError('no ' * 10_000)", "line 1: no no"),
    "talks_in_lines": ("raise ValueError('\\n' * 50 + 'at last')", "line 1: at last"),
    "has_a_number_for_a_name": (GOOD.replace('"well")', "3)"), "plugin surface/3: a name is a word"),
    "names_no_kind": (GOOD.replace('"surface", "well"', '"surfaec", "x"'), "did you mean 'surface'"),
}
HARMLESS = {
    "speaks": "print('x' * 10**6)",
    "writes_what_looks_like_an_answer": 'import sys\nsys.stdout.write(\'{"refused": "everything"}\\n\')\nsys.stdout.flush()',
    "starts_a_thread": "import threading, time\nthreading.Thread(target=time.sleep, args=(60,)).start()",
    "registers_at_exit": "import atexit, time\natexit.register(time.sleep, 60)",
    "starts_a_process": "import subprocess\nsubprocess.Popen(['sleep', '60'])",
    "ignores_signals": "import signal\nsignal.signal(signal.SIGTERM, signal.SIG_IGN)",
}


QUICK = ("exits", "is_killed", "leaves", "talks_for_ever", "talks_in_lines", "has_a_number_for_a_name")


@pytest.mark.timeout(1800)  # a process for each misdeed, of seconds on an idle machine
@pytest.mark.parametrize("names", [QUICK, pytest.param(tuple(MISDEEDS), marks=pytest.mark.slow)], ids=["quick", "all"])
def test_every_misdeed_is_named_and_the_rest_is_described(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, names: tuple[str, ...]
) -> None:
    folder = tmp_path / "plugins" / "surface"
    folder.mkdir(parents=True)
    (folder / "well.py").write_text(GOOD)
    for name, text in {**{name: MISDEEDS[name][0] for name in names}, **HARMLESS}.items():
        (folder / f"{name}.py").write_text(text + "\n")
    monkeypatch.setattr(contained, "SECONDS", 30.0)
    found = contained_description(tmp_path)
    assert {item["name"] for item in found["plugins"]} >= {"well", "icosphere"}
    said = {Path(file).stem: text for file, text in found["broken"].items()}
    assert set(said) == set(names)
    for name in names:
        assert MISDEEDS[name][1] in said[name] and "\n" not in said[name], said[name]
        assert len(said[name]) <= 300


def test_what_hangs_is_not_waited_for_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    kept: dict[str, object] = {}
    monkeypatch.setattr(plugins._memory, "put", lambda key, value: kept.update({key: value}))
    monkeypatch.setattr(plugins._memory, "get", kept.get)
    hanging = {"plugins": [], "kinds": [], "certified": [], "broken": {"a.py": "hangs"}, "contained": ["a.py"]}
    for state, kinds, remembered in (("one", ["a.py"], 1), ("two", [], 0)):
        kept.clear()
        monkeypatch.setattr(
            plugins, "contained_description", lambda folder, kinds=kinds: hanging | {"contained": kinds}
        )
        assert plugins.catalogue(tmp_path / state).broken == {"a.py": "hangs"}
        assert len(kept) == remembered


def test_a_process_that_describes_nothing_is_refused_at_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(contained.sys, "executable", "/bin/false")
    started = time.monotonic()
    with pytest.raises(
        UserError, match="plugins cannot be described: the process that loads them ends the process with exit"
    ):
        contained_description(tmp_path)
    assert time.monotonic() - started < 60


TWICE = (
    GOOD
    + """

@register("surface", "well")
def another() -> Surface:
    \"\"\"A coarser sphere.\"\"\"
    return icosphere(1)
"""
)


def test_two_plugins_of_one_name_in_one_file_are_refused_with_both_lines(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(registry, "PLUGINS", {})
    monkeypatch.setattr(registry, "_loaded", set())
    file = tmp_path / "well.py"
    file.write_text(TWICE)
    with pytest.raises(UserError, match=r"plugin surface/well is defined twice: .*, line 8 and .*, line 14$"):
        registry.load_file(file)


def test_a_file_that_is_executed_again_defines_nothing_twice(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(registry, "PLUGINS", {})
    for name in ("well.py", "well.py", "copy.py"):
        monkeypatch.setattr(registry, "_loaded", set())
        (tmp_path / name).write_text(GOOD)
        registry.load_file(tmp_path / name)
    (found,) = registry.PLUGINS.values()
    assert found.file == tmp_path / "well.py"


def test_a_catalogue_is_made_again_where_a_file_changed_that_plugins_import_from_elsewhere(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    kept: dict[str, object] = {}
    monkeypatch.setattr(plugins._memory, "put", lambda key, value: kept.update({key: value}))
    monkeypatch.setattr(plugins._memory, "get", kept.get)
    monkeypatch.syspath_prepend(tmp_path)
    helper = tmp_path / "helper_from_elsewhere.py"
    helper.write_text("LEVELS = 2\n")
    importlib.import_module(helper.stem)
    imported = imported_from_elsewhere(sources(tmp_path))
    assert str(helper) in imported and not any("site-packages" in file for file in imported)
    assert str(helper) not in imported_from_elsewhere([helper])
    description = {"plugins": [], "kinds": [], "certified": [], "broken": {}, "imported": imported}
    monkeypatch.setattr(plugins, "contained_description", lambda folder: description | {"contained": []})
    plugins.catalogue(tmp_path)
    plugins.remembered.cache_clear()
    assert plugins.remembered(tmp_path) is not None
    helper.write_text("LEVELS = 30\n")
    plugins.remembered.cache_clear()
    assert plugins.remembered(tmp_path) is None
