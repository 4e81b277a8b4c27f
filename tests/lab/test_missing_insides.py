"""What is taken from inside of numba and Slurm's plugin may be gone in another version: everything works without it."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from surfexp.lab.running import stage_server
from surfexp.lab.running.numba_cache import INSIDE

CACHED = """
import os
os.environ["XDG_CACHE_HOME"] = {cache!r}
os.environ.pop("NUMBA_CACHE_DIR", None)
from surfexp.lab.running import compiled_code
compiled_code.use("state")
import sys
from numba.core import caching
original = caching.IndexDataCacheFile
{planted}
sys.path.insert(0, {folder!r})
import function
print(function.twice(1.5), sum(function.twice.stats.cache_hits.values()), *compiled_code.complaints(), sep="|")
"""
FUNCTION = "import numba\n\n@numba.njit(cache=True)\ndef twice(x):\n    return 2 * x\n"


def called(folder: Path, planted: str) -> list[str]:
    (folder / "function.py").write_text(FUNCTION)
    program = CACHED.format(cache=str(folder / "cache"), folder=str(folder), planted=planted)
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout.strip().split("|")


def test_code_is_checked_where_numba_can_be_looked_into(tmp_path: Path) -> None:
    assert called(tmp_path, "pass") == ["3.0", "0"] and called(tmp_path, "pass") == ["3.0", "1"]


@pytest.mark.parametrize("name", INSIDE)
def test_numba_keeps_its_files_itself_where_its_insides_are_others(tmp_path: Path, name: str) -> None:
    """The name is missing while our module looks for it, and numba has it again when it works."""
    planted = f"""
import surfexp.lab.running
kept = original.__dict__[{name!r}]
del original.{name}
import surfexp.lab.running.numba_cache
original.{name} = kept
assert caching.IndexDataCacheFile is original
"""
    for hits in ("0", "1"):
        value, found, complaint = called(tmp_path, planted)
        assert (value, found) == ("3.0", hits) and "keeps compiled code in its own way" in complaint


@pytest.mark.parametrize("module", ["numba.core.caching", "numba.core.compiler_lock", "numba.core.sigutils"])
def test_a_warm_process_does_without_what_it_cannot_recall(monkeypatch: pytest.MonkeyPatch, module: str) -> None:
    monkeypatch.delitem(sys.modules, "surfexp.lab.running.recall", raising=False)
    monkeypatch.setitem(sys.modules, module, None)
    recall = stage_server.recalled()
    assert isinstance(recall, stage_server.Forgetful)
    recall.tell()
    recall.learn()


def test_slurms_plugin_is_taken_as_it_is_where_it_has_other_insides(monkeypatch: pytest.MonkeyPatch) -> None:
    """A run that needs no cluster runs, and one on a cluster has the executor of the plugin."""
    from snakemake_interface_executor_plugins.registry import ExecutorPluginRegistry

    from surfexp.lab.running.snakemake import register

    monkeypatch.setitem(sys.modules, "surfexp.lab.running.slurm", None)
    monkeypatch.delattr("surfexp.lab.running.slurm", raising=False)
    registry = ExecutorPluginRegistry()
    monkeypatch.setattr(registry, "plugins", dict(registry.plugins))
    before = registry.plugins.get("slurm")
    register(registry)
    assert registry.plugins.get("slurm") is before and "surfexp" in registry.plugins
