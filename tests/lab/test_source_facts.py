"""What is remembered of source files follows from their bytes; a lost or damaged memory costs time and nothing else."""

from __future__ import annotations

from pathlib import Path

import pytest

from surfexp.lab import user_cache
from surfexp.lab.plan import code_digests, source_code, source_facts
from surfexp.lab.plan.source_facts import SourceFacts
from surfexp.lab.registry.folders import package_folder
from surfexp.lab.user_cache import Memory


@pytest.fixture
def memory(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.setattr(source_facts, "_memory", Memory("source_facts"))
    monkeypatch.setattr(code_digests, "package_version", lambda module: "1")  # to find it out takes seconds
    return tmp_path / "surfexp" / "memory" / "source_facts.json"


def forget(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(source_facts, "_memory", Memory("source_facts"))
    for function in (*vars(code_digests).values(), *vars(source_facts).values(), *vars(source_code).values()):
        if hasattr(function, "cache_clear"):
            function.cache_clear()


def digests() -> list[str]:
    file = package_folder("surfexp.plugins") / "surface" / "disk.py"
    return [code_digests.code_digest(file), code_digests.code_digest(file, "disk")]


def test_digests_from_memory_are_those_from_the_files(memory: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    forget(monkeypatch)
    before = digests()
    source_facts._memory.save()
    assert memory.exists()
    monkeypatch.setattr(source_code, "statements", None)  # nothing is parsed again
    forget(monkeypatch)
    assert digests() == before


@pytest.mark.parametrize("content", ["{", "[1]"])
def test_a_damaged_memory_is_an_empty_one(memory: Path, monkeypatch: pytest.MonkeyPatch, content: str) -> None:
    forget(monkeypatch)
    before = digests()
    source_facts._memory.save()
    memory.write_text(content)
    forget(monkeypatch)
    assert digests() == before


def test_a_changed_file_has_other_facts(memory: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = tmp_path / "method.py"
    found: list[SourceFacts] = []
    for text in ("import numpy\nx = 1\n", "# comment\nimport numpy\nx = 1\n", "import scipy\nx = 1\n"):
        file.write_text(text)
        forget(monkeypatch)
        found.append(source_facts.source_facts(file))
    assert found[0] == found[1] and found[2].imports == {"scipy"} and found[2].meaning != found[0].meaning


def test_a_memory_that_others_can_write_is_not_read(memory: Path) -> None:
    one = Memory("source_facts")
    one.put("key", 1)
    one.save()
    assert Memory("source_facts").get("key") == 1
    memory.parent.chmod(0o777)
    assert Memory("source_facts").get("key") is None and user_cache.fault(memory.parent)


def test_two_processes_keep_what_both_have_found(memory: Path) -> None:
    first, second = Memory("source_facts"), Memory("source_facts")
    assert first.get("a") is second.get("b") is None
    first.put("a", 1)
    second.put("b", 2)
    first.save()
    second.save()
    assert [Memory("source_facts").get(key) for key in "ab"] == [1, 2]
