"""What goes into a bundle: the plan with its paths made relative, code and inputs of the user, results and tables."""

from __future__ import annotations

import json
import shlex
import shutil
import sys
from collections.abc import Iterable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from surfexp.commands.bundling.opening import CODE, PLAN
from surfexp.commands.exporting.folder import ExportFolder
from surfexp.commands.exporting.selection import chosen_stages
from surfexp.commands.exporting.stages import Export
from surfexp.commands.init import template
from surfexp.commands.verdict_lines import verdicts_of
from surfexp.lab.errors import UserError
from surfexp.lab.plan.code_digests import code_closure
from surfexp.lab.plan.kinds_of_plans import OF_FILE
from surfexp.lab.plan.plan import Node, Plan
from surfexp.lab.registry.folders import experiments, shipped_plugin_folders
from surfexp.lab.registry.installed import distributions, package_version
from surfexp.lab.registry.option_files import file_named, with_file
from surfexp.lab.registry.registry import plugin
from surfexp.lab.store import store
from surfexp.lab.store.kinds import KINDS
from surfexp.records.origin import read_origin
from surfexp.records.table import Row, in_tables, rows_of, to_csv
from surfexp.report.citation import bibliography

PUBLISHED = "published"
README = "README.md"
ABOUT = """# {0}

An experiment of surfexp with its code, inputs, results and certificates. It was made by `{1}`.

- `surfexp rerun` with this bundle computes all of it again and compares.
- `plan.json`: every stage with its options. `plugins/`: code of the authors. `inputs/`: files, each below its hash.
- `published/`: tables, figures and results; beside each file in `published/files/` stands its certificate.
"""
# what every run goes through, whatever its stages import
TOOLS = ("surfexp", "numpy", "scipy", "numba", "snakemake", "hydra", "omegaconf", "pydantic", "mlflow")


def write_contents(plan: Plan, results: Path, folder: Path) -> dict[str, Any]:
    """Write all files of a bundle but its description; return what bundle.json says.

    Parameters
    ----------
    plan : Plan
        Of which every row and figure is finished.
    results : Path
    folder : Path
        Empty.

    Raises
    ------
    UserError
        If a result is missing or damaged, an input was changed since, or a plugin is neither installed nor below plugins/ here.
    """
    _check_finished(plan, results)
    bundled, rows = _portable(plan, folder), rows_of(plan, results.resolve())
    (folder / PLAN).write_text(bundled.text())
    _copy_results(plan, results, folder / PUBLISHED)
    origin = read_origin(results, plan)
    facts = {
        "experiment": plan.settings.experiment,
        "origin": origin,
        "versions": _versions(plan),
        "verdicts": [[item.claim.claim, item.verdict] for item in verdicts_of(plan, rows)],
    }
    _write_snakemake(plan, origin.get("command", ""), folder)
    _write_tables(plan, rows, results, folder / PUBLISHED)
    (folder / README).write_text(ABOUT.format(facts["experiment"], origin.get("command", "")), encoding="utf-8")
    (folder / "bundle.json").write_text(json.dumps(facts, indent=1, ensure_ascii=False), encoding="utf-8")
    return facts


def _check_finished(plan: Plan, results: Path) -> None:
    asked = dict.fromkeys(key for leaf in plan.leaves for key in (leaf.key, *leaf.figures))
    faults = store.faults(results, [(plan.nodes[key].kind, key) for key in asked], anew=True)
    if faults:
        key, fault = next(iter(faults.items()))
        node = plan.nodes[key]
        again = f"surfexp run experiment={plan.settings.experiment}"
        raise UserError(
            f"{len(faults)} of {len(asked)} results are missing, first {node.kind}/{node.plugin} {key[:8]}"
            f"{f' ({fault})' if fault else ''}: {again}"
        )


def _portable(plan: Plan, folder: Path) -> Plan:
    """The plan with paths inside the bundle, into which the files behind them are copied."""
    settings = plan.settings.model_copy(update={"results": "results", "cores": None, "profile": None})
    nodes = {key: _portable_node(node, folder) for key, node in plan.nodes.items()}
    for module in {KINDS[node.kind].path.partition(":")[0] for node in plan.nodes.values()}:
        if module.startswith(OF_FILE):  # a file that declares a kind
            _copy_code(Path(str(sys.modules[module].__file__)), folder)
    return Plan(settings, nodes, plan.leaves, plan.requested)


def _portable_node(node: Node, folder: Path) -> Node:
    options = node.options
    for option, digest in node.files.items():
        source = Path(file_named(node.options, option))
        place = f"inputs/{digest}/{source.name}"
        _copy_input(source, digest, folder / place)
        options = with_file(options, option, place)
    return replace(node, file=_copy_code(Path(node.file), folder), options=options)


def _copy_input(source: Path, digest: str, target: Path) -> None:
    from surfexp.lab.digests import file_digest

    file_digest.cache_clear()
    if not source.exists() or file_digest(source.resolve()) != digest:
        raise UserError(f"input {source} is not what it was when the results were made: run the experiment again")
    if target.exists():
        return
    target.parent.mkdir(parents=True, exist_ok=True)
    if source.is_dir():
        shutil.copytree(source, target)
    else:
        shutil.copyfile(source, target)


def _copy_code(file: Path, folder: Path) -> str:
    """Copy a plugin file of the working folder; return its place, "" for one that comes with an installed package."""
    own = (Path.cwd() / CODE).resolve()
    if any(shipped in file.parents for shipped in shipped_plugin_folders()) or own not in file.parents:
        return ""
    place = f"{CODE}{file.relative_to(own).as_posix()}"
    (folder / place).parent.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(file, folder / place)
    return place


def _copy_results(plan: Plan, results: Path, target: Path) -> None:
    """The stored results of the rows, with which a rerun compares its own."""
    for leaf in plan.leaves:
        kind = plan.nodes[leaf.key].kind
        place = store.result_folder(target, kind, leaf.key)
        place.mkdir(parents=True, exist_ok=True)
        for name in (store.RECORD, store.ARRAYS):
            shutil.copyfile(store.result_folder(results, kind, leaf.key) / name, place / name)


def _write_snakemake(plan: Plan, command: str, folder: Path) -> None:
    words = [word.partition("=") for word in shlex.split(command)[2:]]
    plain = {key: value for key, equals, value in words if equals and key[:1].isalpha() and key != "results"}
    lines = {"experiment": plan.settings.experiment} | (plain if len(plain) >= len(words) - 1 else {})
    (folder / "Snakefile").write_text(template("Snakefile"), encoding="utf-8")
    (folder / "config.yaml").write_text("".join(f"{key}: {json.dumps(value)}\n" for key, value in lines.items()))
    source = experiments().get(plan.settings.experiment)
    if source is not None:
        target = folder / "conf" / "experiment" / source.name
        target.parent.mkdir(parents=True)
        shutil.copyfile(source, target)


def _write_tables(plan: Plan, rows: list[Row], results: Path, target: Path) -> None:
    (target / "metrics.csv").write_text(to_csv(rows), encoding="utf-8")
    write_parquet(target / "metrics.parquet", rows)
    used = sorted({f"{node.kind}/{node.plugin}" for node in plan.nodes.values()})
    (target / "citations.bib").write_text(bibliography(used, package_version("surfexp")), encoding="utf-8")
    with ExportFolder(target / "files") as destination:
        export = Export(plan, results, destination)
        for _ in export.stages(chosen_stages(plan, "", False, ())):
            pass
        destination.publish(export.rows)


def write_parquet(path: Path, rows: Iterable[Row]) -> None:
    """Write the table of metrics.csv with typed columns: options as text, metrics and seconds as numbers.

    Parameters
    ----------
    path : Path
    rows : iterable of Row
    """
    import pyarrow
    from pyarrow import parquet

    rows = in_tables(list(rows))
    columns: dict[str, Any] = {
        "comparison": [str(row.leaf.settings["comparison"]) for row in rows],
        "leaf": [row.leaf.key for row in rows],
    }
    for name in dict.fromkeys(name for row in rows for name in row.parameters):
        values = [row.parameters.get(name) for row in rows]
        columns[name] = [None if value is None else str(value) for value in values]
    for name in dict.fromkeys(name for row in rows for name in row.metrics):
        columns[name] = pyarrow.array([row.metrics.get(name) for row in rows], pyarrow.float64())
    columns["seconds"] = pyarrow.array([row.seconds for row in rows], pyarrow.float64())
    columns["failure"] = [row.failure for row in rows]
    parquet.write_table(pyarrow.table(columns), path)


def _versions(plan: Plan) -> Mapping[str, str]:
    """Versions of what the code of a plan reaches, of the laboratory's tools, and of packages that bring a plugin."""
    packages = set(TOOLS)
    for node in plan.nodes.values():
        packages |= code_closure(Path(node.file), node.function)[1]
        packages.add(plugin(node.kind, node.plugin).function.__module__.partition(".")[0])
    names = {(*distributions(module), module)[0] for module in packages}
    known = {name: package_version(name) for name in sorted(names)}
    return {name: version for name, version in known.items() if version != "unknown"}
