"""A folder described and packed as a Workflow Run RO-Crate, by the library `rocrate`."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from datetime import datetime
from pathlib import Path
from typing import Any

from surfexp.commands.bundling.opening import CODE, PLAN
from surfexp.io.replacing import replacing

PROFILES = {
    "https://w3id.org/ro/wfrun/process/0.5": ("Process Run Crate", "0.5"),
    "https://w3id.org/ro/wfrun/workflow/0.5": ("Workflow Run Crate", "0.5"),
    "https://w3id.org/workflowhub/workflow-ro-crate/1.0": ("Workflow RO-Crate", "1.0"),
}
FORMATS = {
    ".json": "application/json",
    ".csv": "text/csv",
    ".parquet": "application/vnd.apache.parquet",
    ".py": "text/x-python",
    ".yaml": "application/yaml",
    ".png": "image/png",
    ".svg": "image/svg+xml",
    ".bib": "application/x-bibtex",
    ".npz": "application/zip",
    ".md": "text/markdown",
}
OTHER_FORMAT = "application/octet-stream"
WORKFLOW = "Snakefile"


def write_crate(folder: Path, target: Path, facts: Mapping[str, Any]) -> None:
    """Pack all files of a folder as one .zip, with their SHA-256, what was run, on what, and what came out.

    Parameters
    ----------
    folder : Path
        As `write_contents` left it.
    target : Path
        Whole or not written at all.
    facts : mapping
        Of bundle.json.
    """
    from rocrate.rocrate import ROCrate

    # of the crate itself: rocrate's default is of a later specification than the profiles
    crate: Any = ROCrate(version="1.1")
    name, origin = facts["experiment"], facts["origin"]
    date = datetime.fromisoformat(origin["date"]).astimezone().isoformat() if "date" in origin else ""
    crate.name = f"surfexp experiment {name}"
    crate.description = (
        f"The experiment {name} with its inputs, code, results and certificates; run again by surfexp rerun"
    )
    crate.license = "the authors of the experiment decide: see its inputs and code"
    if date:
        crate.datePublished = date
    files: dict[str, Any] = {}
    for file in sorted(path for path in folder.rglob("*") if path.is_file()):
        place = file.relative_to(folder).as_posix()
        known = {"sha256": hashlib.sha256(file.read_bytes()).hexdigest(), "contentSize": str(file.stat().st_size)}
        known["encodingFormat"] = FORMATS.get(file.suffix, OTHER_FORMAT)
        if place == WORKFLOW:
            known["encodingFormat"] = "text/x-snakemake"
            described = {"name": f"{name} by Snakemake", "version": facts["versions"]["surfexp"], **known}
            files[place] = crate.add_workflow(file, place, main=True, lang="snakemake", properties=described)
        else:
            files[place] = crate.add_file(file, place, properties={"name": place, **known})
    crate.root_dataset["conformsTo"] = [_thing(crate, at, *of) for at, of in PROFILES.items()]
    files["README.md"]["about"] = crate.root_dataset
    crate.mainEntity["softwareRequirements"] = [_tool(crate, *tool) for tool in facts["versions"].items()]
    action = crate.add_action(
        crate.mainEntity,
        identifier="#run",
        object=[files[place] for place in files if place.startswith(("inputs/", CODE)) or place == PLAN],
        result=[files[place] for place in files if place.startswith("published/")],
        properties={"name": f"run of {name}", "description": origin.get("command", "surfexp run")},
    )
    if date:
        action["endTime"] = date
    crate.root_dataset["mentions"] = [action]
    action["actionStatus"] = "http://schema.org/CompletedActionStatus"
    with replacing(target) as temporary:
        crate.write_zip(temporary)


def _thing(crate: Any, identifier: str, name: str, version: str) -> Any:
    from rocrate.model.contextentity import ContextEntity

    known = {"@type": "CreativeWork", "name": name, "version": version}
    return crate.add(ContextEntity(crate, identifier, properties=known))


def _tool(crate: Any, name: str, version: str) -> Any:
    from rocrate.model.softwareapplication import SoftwareApplication

    place = f"https://pypi.org/project/{name}/{version}/"
    known = {"name": name, "softwareVersion": version, "url": place}
    return crate.add(SoftwareApplication(crate, place, properties=known))
