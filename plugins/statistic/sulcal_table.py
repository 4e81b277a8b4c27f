"""Lengths of sulci of one's own surfaces."""

import numpy as np
from pydantic import Field

from surfexp.embedding.length_table import length_columns
from surfexp.embedding.population import Side
from surfexp.embedding.population_study import SIDES
from surfexp.embedding.sulcal_measurement import DEFAULT, TRUE, measure_sulci
from surfexp.embedding.sulcal_template import make_template
from surfexp.mesh.surface import Surface
from surfexp.metric import Metric
from surfexp.statistics.labels import classes_of, groups_of
from surfexp.statistics.statistic import Statistic
from surfexp.workflow.registry import Options, register
from surfexp.workflow.stage import report_progress

FREESURFER = {"lh": "left", "rh": "right"}


class SulcalTable(Options):
    """What is measured."""

    regions: int = Field(3, ge=1, le=100, description="sulcal regions that are measured, longest extent first")


METRICS = {
    "subjects": Metric("number of subjects"),
    "found, {estimator}": Metric("share of lengths that could be measured", better="higher"),
    "difference, sulcus {number}, {estimator}": Metric("mean of left less right over their mean"),
}


@register("statistic", "sulcal_table", metrics=METRICS)
def sulcal_table_statistic(options: SulcalTable, *, template: Surface, surfaces: dict[str, Surface]) -> Statistic:
    """Lengths of sulci by every estimator for each subject and side, surfaces labelled "left @ NAME" and "right @ NAME"."""
    labels = tuple(surfaces)
    sides = [FREESURFER.get(name, name) for name in classes_of(labels)]
    place = dict(zip(zip(groups_of(labels), sides, strict=True), labels, strict=True))
    subjects = sorted(set(groups_of(labels)))
    if set(place) != {(subject, side) for subject in subjects for side in SIDES} or len(place) != len(labels):
        raise ValueError(
            f"surfaces are {', '.join(labels)}; take one 'left @ NAME' (or lh) and one 'right @ NAME' (or rh) each"
        )
    study = make_template(template, options.regions)
    table: dict[str, dict[Side, list[np.ndarray]]] = {}
    for done, (subject, side) in enumerate(sorted(place), 1):
        label = place[subject, side]
        for name, values in measure_sulci(study, surfaces[label]).items():
            if name != TRUE:
                table.setdefault(name, {"left": [], "right": []})["left" if side == "left" else "right"].append(values)
        report_progress(done, 1.0 - done / len(place))
    lengths = {name: {side: np.array(rows) for side, rows in parts.items()} for name, parts in table.items()}
    rows, columns = length_columns(lengths, range(len(subjects)), subjects)
    metrics = {f"found, {name}": float(np.isfinite(columns[name]).mean()) for name in lengths}
    for k in range(options.regions):
        for name in (DEFAULT, "own region, line with ends"):
            left, right = (lengths[name][side][:, k] for side in SIDES)
            shares = 2.0 * (left - right) / (left + right)
            if np.isfinite(shares).any():
                metrics[f"difference, sulcus {k + 1}, {name}"] = float(np.nanmean(shares))
    regions = ", ".join(str(number + 1) for number in study.measured)
    notes = (
        f"Sulci 1 to {options.regions} are the regions {regions} of the template, whose regions count from the largest.",
    )
    return Statistic("sulcal lengths", columns, rows, {"subjects": float(len(subjects)), **metrics}, notes)
