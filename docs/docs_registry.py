"""Pages of all plugins, experiments and studies, made from the registry and from their files."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from surfexp.commands.catalogue import HEADINGS, OTHERS, START
from surfexp.lab.experiment.experiment_files import methods_named, read_experiment
from surfexp.lab.registry.catalogue import Catalogue, open_catalogue
from surfexp.lab.registry.described import Described
from surfexp.lab.registry.folders import experiments
from surfexp.lab.registry.registry import plugin

ROOT = Path(__file__).parent.parent
SPECIAL = str.maketrans({"<": "&lt;", "$": r"\$", "*": r"\*", "[": r"\[", "|": r"\|", "~": r"\~"})


def write_registry(folder: Path) -> None:
    """Write `plugins/`, `experiments/` and `studies/` below a folder."""
    known = open_catalogue(ROOT)
    documents = {name: read_experiment(name) for name in sorted(experiments())}
    named = {name: methods_named(document, known.kinds) for name, document in documents.items()}
    _write_plugins(known, named, folder / "plugins")
    _write_experiments(documents, named, known, folder / "experiments")
    _write_studies(folder / "studies")


def _write_plugins(known: Catalogue, named: Mapping[str, Mapping[str, Iterable[str]]], folder: Path) -> None:
    users: dict[tuple[str, str], list[str]] = defaultdict(list)
    for experiment, methods in named.items():
        for kind, names in methods.items():
            for name in names:
                users[kind, name].append(experiment)
    kinds = [kind for kind in known.kinds if known.names(kind)]
    rows = [
        f"| [{kind}]({kind}.md) | {len(known.names(kind))} | {', '.join(sorted(known.names(kind)))} |" for kind in kinds
    ]
    head = (
        f"# Plugins\n\nAll {len(known.plugins)} plugins by kind, with their inputs, options, metrics and the experiments that "
        "use them. `surfexp info KIND/NAME` prints the same. [](../../extending.md) tells how to write one.\n"
    )
    _write(folder / "index.md", head, "| kind | count | plugins |\n|---|---|---|", *rows, _toctree(kinds))
    for kind in kinds:
        certified = (
            " Its results say whether they converged, and with which certificate." if kind in known.certified else ""
        )
        parts = [f"# {kind.replace('_', ' ').capitalize()} plugins\n\n{len(known.names(kind))} plugins.{certified}\n"]
        for name in sorted(known.names(kind)):
            parts.append(_plugin(known.plugins[kind, name], users[kind, name]))
        _write(folder / f"{kind}.md", *parts)


def _plugin(one: Described, users: list[str]) -> str:
    lines = [f"(plugin-{one.kind}-{one.name})=", f"## {one.name}", "", _plain(one.summary), ""]
    for role, (kind, shape) in one.inputs.items():
        only = f", of {', '.join(one.accepts[kind])}" if kind in one.accepts else ""
        lines.append(f"- input `{role}`: {kind}{'' if shape == 'one' else f' ({shape})'}{only}")
    lines.append("")
    if one.options:
        lines += ["| option | default | values | meaning |", "|---|---|---|---|"]
        lines += [f"| `{o}` | {_code(d)} | {_code(v)} | {_plain(meaning)} |" for o, d, v, meaning in one.options]
        lines.append("")
    if metrics := plugin(one.kind, one.name).metrics:
        lines += ["| metric | unit | better | meaning |", "|---|---|---|---|"]
        lines += [
            f"| {_plain(name.replace('_', ' '))} | {_plain(m.unit)} | {m.better} | {_plain(m.meaning)} |"
            for name, m in metrics.items()
        ]
        lines.append("")
    links = [f"[{name}](../experiments/{name}.md)" for name in users]
    if links:
        lines.append(f"Used by {', '.join(links)}.")
    return "\n".join([*lines, ""])


def _write_experiments(
    documents: Mapping[str, Any], named: Mapping[str, Mapping[str, Iterable[str]]], known: Catalogue, folder: Path
) -> None:
    groups: dict[str, list[tuple[int, str]]] = {heading: [] for heading in (START, *HEADINGS.values(), OTHERS)}
    for name, document in documents.items():
        chapter, place = document.get("chapter") or (0, 0)
        heading = START if "start" in document else HEADINGS.get(chapter, OTHERS)
        groups[heading].append((document.get("start", place), name))
        _write(folder / f"{name}.md", _experiment(name, document, named[name], known))
    parts = [f"# All experiments\n\n{len(documents)} experiments; `surfexp run experiment=NAME` computes one.\n"]
    for heading, members in groups.items():
        if members:
            parts += [f"\n## {heading}\n", "| experiment | question |", "|---|---|"]
            parts += [f"| [{n}]({n}.md) | {_plain(str(documents[n].get('title', '')))} |" for _, n in sorted(members)]
    _write(folder / "index.md", *parts, _toctree(sorted(documents)))


def _experiment(name: str, document: Mapping[str, Any], methods: Mapping[str, Iterable[str]], known: Catalogue) -> str:
    lines = [f"# {name}", "", f"**{_plain(str(document.get('title', name)))}**", ""]
    lines += [_plain(str(document.get("description", "")).strip()), ""]
    lines += [
        f"```console\n$ surfexp run experiment={name}\n$ surfexp info {name}\n```",
        "",
        "| stage | plugins |",
        "|---|---|",
    ]
    for kind, names in methods.items():
        shown = (f"[{n}](#plugin-{kind}-{n})" if (kind, n) in known.plugins else n for n in names)
        lines.append(f"| {kind} | {', '.join(shown)} |")
    lines.append("")
    if claims := document.get("claims") or []:
        lines += ["## Claims", ""]
        lines += [f"- {_plain(str(claim.get('claim', '')))}" for claim in claims if isinstance(claim, Mapping)]
    if chapter := document.get("chapter"):
        lines += ["", f"Its verdicts: [chapter {chapter[0]}](../../reproduction/chapter_{chapter[0]}.md)."]
    return "\n".join([*lines, ""])


def _write_studies(folder: Path) -> None:
    names = sorted(file.parent.name for file in ROOT.glob("studies/*/README.md"))
    rows = []
    for name in names:
        text = (ROOT / "studies" / name / "README.md").read_text(encoding="utf-8")
        title = text.partition("\n")[0].removeprefix("# ")
        rows.append(f"| [{name.replace('_', ' ')}]({name}.md) | {_plain(title)} |")
        _write(folder / f"{name}.md", _study(name, text))
    head = "# Studies\n\nQuestions with experiments and plugins of their own, each in its folder of `studies`.\n"
    _write(folder / "index.md", head, "| study | question |\n|---|---|", *rows, _toctree(names))


def _study(name: str, text: str) -> str:
    """The page of a study: its text, and its programs as they are."""
    text = text.replace("](../../docs/", "](../../")
    text = re.sub(r"\]\(\.\./\.\./examples/(\w+)\.py\)", r"](../examples/\1)", text)
    text = re.sub(r"\[([^\]]*)\]\(examples/[^)]*\)", r"`\1`", text)
    programs = sorted((ROOT / "studies" / name / "examples").glob("*.py"))
    shown = [
        f"```{{literalinclude}} ../../../studies/{name}/examples/{file.name}\n:language: python\n:caption: {file.name}\n```\n"
        for file in programs
    ]
    return "\n".join([text, *(["## Programs\n", *shown] if shown else [])])


def _toctree(names: Iterable[str]) -> str:
    return "\n".join(["", "```{toctree}", ":hidden:", "", *names, "```", ""])


def _plain(text: str) -> str:
    return " ".join(text.split()).translate(SPECIAL)


def _code(text: str) -> str:
    return f"`{' '.join(text.split())}`".replace("|", r"\|")


def _write(file: Path, *parts: str) -> None:
    file.parent.mkdir(parents=True, exist_ok=True)
    text = "\n".join(parts)
    if not file.exists() or file.read_text(encoding="utf-8") != text:  # unchanged pages are not read again
        file.write_text(text, encoding="utf-8")
