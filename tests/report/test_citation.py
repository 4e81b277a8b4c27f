"""What to cite: entries that BibTeX can read, of plugins that exist, and for each experiment the right ones."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from surfexp.commands import cite
from surfexp.commands.command_line import main
from surfexp.lab.experiment.experiment_files import methods_named
from surfexp.lab.registry import registry
from surfexp.lab.registry.folders import experiments
from surfexp.lab.registry.loading import load_all
from surfexp.report.citation import ALWAYS, bibliography, cited, references

NEEDED = {
    "article": {"author", "title", "journal", "year"},
    "book": {"author", "title", "publisher", "year"},
    "inproceedings": {"author", "title", "booktitle", "year"},
    "phdthesis": {"author", "title", "school", "year"},
    "misc": {"author", "title", "howpublished", "year"},
    "software": {"author", "title", "version"},
}


def entries(text: str) -> dict[str, tuple[str, dict[str, str]]]:
    """Type and fields by key, by a reader of its own: braces must balance, keys be new."""
    found: dict[str, tuple[str, dict[str, str]]] = {}
    for kind, key, body in re.findall(r"^@(\w+)\{([\w]+),\n(.*?)^\}$", text, re.MULTILINE | re.DOTALL):
        fields = dict(re.findall(r"^  (\w+) = \{(.*?)\},$", body, re.MULTILINE | re.DOTALL))
        assert key not in found and body.count("{") == body.count("}"), key
        found[key] = (kind, fields)
    return found


def test_every_reference_is_complete_and_its_plugins_exist() -> None:
    load_all(Path("/nonexistent"))
    known = {f"{kind}/{name}" for kind, name in registry.PLUGINS} | {ALWAYS}
    for reference in references():
        ((key, (kind, fields)),) = entries(reference.bibtex).items()
        assert key == reference.key and fields.keys() >= NEEDED[kind], key
        assert key.endswith(fields["year"]) or kind == "misc"
        assert set(reference.used_by) <= known, (key, set(reference.used_by) - known)
        assert re.fullmatch(r"10\.\d{4,}/\S+", fields.get("doi", "10.1000/x")), key


def test_methods_bring_their_sources_and_no_others() -> None:
    keys = [reference.key for reference in cited(["solver/primal_dual", "model/rof"])]
    assert keys == ["lai_2010", "rudin_osher_fatemi_1992", "chambolle_pock_2011"]
    found = entries(bibliography([], "1.2"))
    assert list(found) == ["surfexp", "lai_2010"] and found["surfexp"][1]["version"] == "1.2"


@pytest.mark.parametrize("experiment", sorted(experiments()))
def test_an_experiment_that_never_ran_is_cited_by_what_its_file_names(experiment: str, tmp_path: Path) -> None:
    used = cite.plugins_of(experiment, tmp_path)
    known = {f"{kind}/{name}" for kind, name in registry.PLUGINS} or load_all(Path("/nonexistent")) or set()
    known = known or {f"{kind}/{name}" for kind, name in registry.PLUGINS}
    assert used and set(used) <= known


def test_methods_are_found_wherever_a_file_names_them() -> None:
    document = {
        "surface": "cup",
        "datasets": {"solvers": [{"solver": {"name": "newton", "tolerance": 1e-9}}, {"solver": ["fista", 3]}]},
        "variants": [{"solver": {"name": "newton"}, "figures": [{"name": "denoising"}, "sweep"]}],
        "title": "solver",
    }
    found = methods_named(document, ["surface", "solver", "figure"])
    assert found == {"surface": ["cup"], "solver": ["newton", "fista"], "figure": ["denoising", "sweep"]}


def test_the_command_prints_bibtex_and_names_the_nearest_experiment(
    working_folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["cite", "rof_cup", "isospectral_drums"]) == 0
    found = entries(capsys.readouterr().out)
    assert {"rudin_osher_fatemi_1992", "goldstein_osher_2009", "gordon_webb_wolpert_1992"} <= found.keys()
    assert "melzi_2019" not in found
    assert main(["cite", "rof_cups"]) == 2
    assert "did you mean 'rof_cup'?" in capsys.readouterr().err


def test_facts_of_an_experiment(working_folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["info", "rof_cup"]) == 0
    text = capsys.readouterr().out
    assert text.startswith("rof_cup: Denoising an image on a cup") and "none in results" in text
    assert "primal_dual, split_bregman" in text and "surfexp run experiment=rof_cup" in text
    folder = working_folder / "results" / "rof_cup"
    folder.mkdir(parents=True)
    summary = (
        '{"date": "2026-01-01 10:00", "rows": 7, "failed": 0, "limited": 2, "seconds": 300, "verdicts": {"holds": 3}}'
    )
    (folder / "summary.json").write_text(summary)
    assert main(["info", "rof_cup"]) == 0
    text = " ".join(capsys.readouterr().out.split())
    assert "2026-01-01 10:00: 7 rows, 2 not converged, 5 min" in text and "verdicts 3 holds" in text
    (folder / "summary.json").write_text('{"verdicts": 3}')
    assert main(["info", "rof_cup"]) == 0
    assert "none in results" in capsys.readouterr().out
    assert main(["info", "rof_cups"]) == 2
