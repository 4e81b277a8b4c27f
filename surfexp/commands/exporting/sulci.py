"""Named sulci of the surfaces of a table of sulcal lengths, as label files."""

from __future__ import annotations

import tempfile
from pathlib import Path

from surfexp.commands.exporting.names import slug
from surfexp.commands.exporting.writers import Place
from surfexp.lab.plan.plan import Node, Plan
from surfexp.lab.store import store

TABLE = ("statistic", "sulcal_table")


def write_sulci(plan: Plan, node: Node, results: Path, place: Place) -> None:
    """Write the sulci of each surface of a table as LABEL.label.gii, LABEL.annot and LABEL.vtk.

    Raises
    ------
    DamagedResult
        If the template or a surface is not finished, or damaged.
    """
    from surfexp.studies.sulci.sulcal_export import export_sulci
    from surfexp.studies.sulci.sulcal_measurement import name_sulci
    from surfexp.studies.sulci.sulcal_template import make_template

    template, surfaces = node.inputs["template"], node.inputs["surfaces"]
    assert isinstance(template, str) and isinstance(surfaces, dict)  # noqa: S101, narrows a type
    study = make_template(store.load(results, "surface", template), int(node.options["regions"]))
    for label, key in surfaces.items():
        surface = store.load(results, "surface", key)
        named = name_sulci(study, surface)
        with tempfile.TemporaryDirectory(dir=place.folder.staging) as folder:
            for file in export_sulci(folder, "sulci", surface, named, int(study.regions.max()) + 1):
                file.rename(place.file(file.name.removeprefix("sulci"), slug(label) or f"sulci-{key[:8]}"))
