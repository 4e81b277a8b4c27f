"""Faults are planted where results are decided, in shares of size, and hide behind no compiled code."""

from __future__ import annotations

import ast
import dataclasses
import subprocess
import sys
from pathlib import Path

import pytest

from audits.mutation import claims, claims_page
from audits.mutation.change import Change, source_of
from audits.mutation.geometry_faults import GEOMETRY_FAULTS
from audits.mutation.import_graph import distances, imported_files, numeric_tests
from audits.mutation.operator_faults import OPERATOR_FAULTS
from audits.mutation.places import changes
from audits.mutation.record import explanations, page
from audits.mutation.sample import numerics, sample
from audits.mutation.selection import selected
from audits.mutation.stale_functions import stale_functions
from audits.mutation.variational_faults import VARIATIONAL_FAULTS

ROOT = Path(__file__).resolve().parents[2]
MODULE = b'''"""Text with 1 + 2."""
LIMIT: int = 7


def least(a: "tuple[1, 2]", b: int = 3) -> int:
    """Return 1 < 2."""
    if a < b and not b:
        raise ValueError(f"{a + 4} is over {LIMIT - 5}")
    b += -a
    values[a, b] = f(a, b)
    return min(a, zip(a, b, strict=True))
'''


def texts(source: bytes) -> set[tuple[str, str]]:
    return {(change.kind, change.new.decode()) for change in changes("x.py", source)}


def test_every_kind_of_fault_is_found_and_nothing_in_prose() -> None:
    found = texts(MODULE)
    assert ("constant", "8") in found and ("constant", "6") in found  # the limit
    assert ("constant", "4") in found and ("constant", "2") in found  # the default
    assert (
        ("comparison", " <= ") in found and ("comparison", " > ") in found and ("comparison", " or not ") not in found
    )
    assert ("comparison", " or ") in found and ("comparison", "not (a < b and not b)") in found
    assert ("sign", "b") in found and ("sign", "a") in found and ("operator", " -= ") in found
    assert ("index", "b, a") in found and ("arguments", "b, a") in found and ("function", "max") in found
    assert ("dropped statement", "pass") in found and ("constant", "False") not in found
    lines = {change.start for change in changes("x.py", MODULE)}
    assert all(MODULE.index(b'"""\nLIMIT') < start for start in lines)
    message = MODULE.index(b"ValueError"), MODULE.index(b"    b += -a")
    assert not any(message[0] <= start < message[1] for start in lines)
    annotation = MODULE.index(b'"tuple'), MODULE.index(b", b: int")
    assert not any(annotation[0] <= start < annotation[1] for start in lines)


def test_every_fault_of_the_numerics_is_a_program_that_differs() -> None:
    for path in numerics()[::25]:
        source = source_of(path)
        tree = ast.dump(ast.parse(source))
        for change in changes(path.relative_to(ROOT).as_posix(), source)[::5]:
            assert ast.dump(ast.parse(change.mutated)) != tree, (change.path, change.texts)


@pytest.mark.slow
def test_a_sample_repeats_and_gives_each_file_its_share() -> None:
    drawn = sample(300, 3)
    assert [change.identity for change in drawn] == [change.identity for change in sample(300, 3)]
    assert drawn != sample(300, 4) and len({change.identity for change in drawn}) == 300
    lines = {
        path.relative_to(ROOT).as_posix(): len(
            {change.line for change in changes(path.relative_to(ROOT).as_posix(), source_of(path))}
        )
        for path in numerics()
    }
    total = sum(lines.values())
    for path, count in lines.items():
        assert abs(sum(change.path == path for change in drawn) - 300 * count / total) < 1.0 + 1e-9
    with pytest.raises(ValueError, match="there is room for 1 to"):
        sample(10**6, 0)


def first(path: str, text: bytes, new: bytes) -> Change:
    start = source_of(ROOT / path).index(text)
    return Change(path, start, start + len(text), new, "planted")


@pytest.mark.slow
def test_callers_of_a_compiled_function_are_compiled_afresh_and_those_of_a_plain_one_not() -> None:
    compiled = first("surfexp/operators/fem.py", b"0.5 * twice_area", b"twice_area")
    stale = stale_functions(compiled)
    assert stale and {module for module, _ in stale} == {"surfexp.operators.fem"}
    plain = first("studies/skeletons/positionwise_comparison.py", b"ddof=1", b"ddof=0")
    assert stale_functions(plain) == frozenset()
    heap = first("surfexp/skeleton/fast_marching.py", b"(i - 1) // 2", b"i // 2")
    assert {name for _, name in stale_functions(heap)} == {"_rise", "_march"}


@pytest.mark.slow
def test_tests_are_chosen_by_imports_and_seconds() -> None:
    path = ROOT / "studies" / "skeletons" / "positionwise_comparison.py"
    near = ROOT / "studies" / "skeletons" / "tests" / "test_width_test.py"
    assert near in numeric_tests() and distances(near)[path] == 1
    examples = imported_files(ROOT / "tests" / "mesh" / "test_mesh_examples.py")
    assert ROOT / "docs" / "inside" / "painted_cup.py" in examples
    name = near.relative_to(ROOT).as_posix()
    seconds = {f"{name}::slow": 5.0, f"{name}::quick": 0.1, f"{name}::red": 0.1, f"{name}::hours": 3000.0}
    baseline = {name: {"seconds": seconds, "failed": [f"{name}::red: assert"]}}
    change = first("studies/skeletons/positionwise_comparison.py", b"ddof=1", b"ddof=0")
    assert list(selected(change, baseline, 30.0).seconds) == [f"{name}::quick", f"{name}::slow"]
    assert list(selected(change, baseline, 1.0).seconds) == [f"{name}::quick"]


def test_the_page_counts_each_fault_once() -> None:
    drawn = sample(20, 2)
    verdicts = ["killed"] * 14 + ["timed out", "crashed", "survived", "survived"]
    found = {
        change.identity: {"verdict": verdict, "cpu": 2.0} for change, verdict in zip(drawn, verdicts, strict=False)
    }
    text = page(drawn, found, 2, 30.0)
    assert "**16 of 18 killed, 88.9%; 2 survive, 0 more are explained.** 2 were not run; 2.0 processor" in text
    assert text.count("\n- line ") == 2
    rows = [row.split("|")[2:7] for row in text.split("| kind |")[0].splitlines() if row.startswith("| ")][1:]
    assert sum(int(row[0]) for row in rows) == 18


def test_each_explanation_belongs_to_a_line_that_stands_there() -> None:
    for path, old, new in explanations():
        lines = {" ".join(line.split()) for line in (ROOT / path).read_text(encoding="utf-8").splitlines()}
        whole = " ".join((ROOT / path).read_text(encoding="utf-8").split())
        assert old in lines or old in whole, f"{path}: {old!r} is not there"
        assert old != new


def test_what_a_fault_did_to_each_claim(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A claim is turned by a number, stopped by an error, untouched, or had no verdict; the best trial counts."""
    stated = [("drums", name) for name in ("equal", "steady", "fast", "empty", "late")]
    fault = claims.ClaimFault("drums", "surfexp/operators/fem.py", "0.5 * twice_area", "twice_area", "steady")
    before = {"equal": ["holds", "1"], "steady": ["holds", "2"], "fast": ["holds", "3"]}
    before |= {"empty": ["not computed", "–"]}
    after = {"equal": ["does not hold", "9"], "steady": ["holds", "5"], "fast": ["not computed", "–"]}
    trial = claims.Trial(fault, before, after)
    assert [trial.outcome(claim) for claim in before] == ["turned", "untouched", "stopped", "not computed"]
    timed = dataclasses.replace(
        trial, after={"fast": ["not computed", "–", "seconds of 2 kinds of machine do not compare: new, old"]}
    )
    assert timed.outcome("fast") == "untouched" and timed.outcome("steady") == "stopped"
    assert trial.named == "steady" and trial.of("late")[0] == "not computed"
    other = dataclasses.replace(fault, claim="", new="3.0 * twice_area")
    again = {"before": before, "after": before | {"fast": ["does not hold", "4"]}}
    monkeypatch.setattr(claims, "faults", lambda: [fault, other])
    known = {fault.identity: {"before": before, "after": after}, other.identity: again}
    monkeypatch.setattr(claims, "_recorded", lambda experiment: known)
    page_of_claims = tmp_path / "page.md"
    page_of_claims.write_text("", encoding="utf-8")
    monkeypatch.setattr(claims_page, "_stated", lambda: stated)
    monkeypatch.setattr(claims_page, "faults", lambda words=(): [fault, other] if "bells" not in words else [])
    monkeypatch.setattr(claims_page, "PAGE", page_of_claims)
    claims_page.write_page()
    text = page_of_claims.read_text(encoding="utf-8")
    assert "**Of 5 claims 2 turned, 0 stopped, 1 untouched, 1 not computed, 1 not run.**" in text
    assert "| drums | fast | surfexp/operators/fem.py: `0.5 * twice_area` → `3.0 * twice_area` | holds 3 |" in text
    assert "| drums | steady | 2 faults | holds 2 | holds 2 | untouched |" in text
    # without records, as on another machine, rows stay; what was not turned is asked for again, and better rows win
    monkeypatch.setattr(claims, "_recorded", lambda experiment: {})
    claims_page.write_page()
    assert page_of_claims.read_text(encoding="utf-8") == text
    assert claims_page.open_faults() == claims_page.open_faults(["drums"]) == [fault] and not claims_page.open_faults(
        ["bells"]
    )
    turned = {fault.identity: {"before": before, "after": after | {"steady": ["does not hold", "7 | 8"]}}}
    monkeypatch.setattr(claims, "_recorded", lambda experiment: turned)
    claims_page.write_page()
    assert "3 turned" in page_of_claims.read_text(encoding="utf-8") and claims_page.open_faults() == []
    elsewhere = dataclasses.replace(fault, experiment="bells")  # another experiment states a claim of the same words
    monkeypatch.setattr(claims_page, "faults", lambda words=(): [fault, elsewhere])
    assert claims_page.open_faults() == [elsewhere]
    assert claims_page.rows_of_page()["drums", "fast"][0] == "turned"  # by the earlier run, better than stopped


def test_tests_of_planted_faults_exist_and_are_quick() -> None:
    """Slow ones take no part, so that a fault would survive them all."""
    named = [
        test.partition("::")
        for fault in OPERATOR_FAULTS + VARIATIONAL_FAULTS + GEOMETRY_FAULTS
        for test in fault.tests
        if "::" in test
    ]
    assert named
    for file, _, name in named:
        functions = [
            node for node in ast.walk(ast.parse((ROOT / file).read_text())) if isinstance(node, ast.FunctionDef)
        ]
        (found,) = [node for node in functions if node.name == name.partition("[")[0]]
        assert "pytest.mark.slow" not in map(ast.unparse, found.decorator_list), name


@pytest.mark.slow
def test_planted_faults_are_seen_by_tests_in_memory() -> None:
    """A module named *_test.py, which pytest would import itself, and a compiled function among them."""
    command = [sys.executable, "-m", "audits.mutation", "planted", "Welch", "area of the parallelogram"]
    run = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stdout + run.stderr
    assert run.stdout.count("killed") == 2


def test_an_experiment_that_takes_too_long_says_nothing_of_its_claims(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def verdicts(experiment: str, fault: claims.ClaimFault | None) -> claims.Verdicts:
        if fault is not None and fault.new == "slow":
            raise subprocess.TimeoutExpired("surfexp", claims.LIMIT)
        return {"steady": ["holds", "1", ""]}

    faults = [claims.ClaimFault("drums", "surfexp/operators/fem.py", "sound", new) for new in ("slow", "other")]
    monkeypatch.setattr(claims, "RESULTS", tmp_path)
    monkeypatch.setattr(claims, "_verdicts", verdicts)
    (trial,) = claims.try_all(faults, 1)
    assert trial.fault.new == "other" and trial.outcome("steady") == "untouched"
    assert "drums: surfexp/operators/fem.py: not run, for it took more than" in capsys.readouterr().out


def test_verdicts_without_a_fault_are_those_of_the_page_where_its_keys_are_the_present_ones(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    fault = claims.ClaimFault("isospectral_drums", "surfexp/operators/fem.py", "sound", "other")
    monkeypatch.setattr(claims, "is_stale", lambda experiment, page: False)
    known = claims.reproduced_verdicts([fault])
    assert set(known["isospectral_drums"]) == {claim for name, claim in claims_page._stated() if name in known}
    monkeypatch.setattr(claims, "is_stale", lambda experiment, page: True)
    assert claims.reproduced_verdicts([fault]) == {}

    def verdicts(experiment: str, fault: claims.ClaimFault | None) -> claims.Verdicts:
        assert fault is not None, "what is on the page is not run again"
        return {}

    monkeypatch.setattr(claims, "RESULTS", tmp_path)
    monkeypatch.setattr(claims, "_verdicts", verdicts)
    (trial,) = claims.try_all([fault], 1, known)
    assert trial.before == known["isospectral_drums"] and trial.fault == fault
