"""Lengths of sulci of one's own surfaces."""

from typing import Annotated

import numpy as np
from pydantic import Field

from surfexp.contract.member import Member
from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.lab.running.stage import report_progress
from surfexp.mesh.surface import Surface
from surfexp.statistics.statistic import Statistic
from surfexp.studies.sulci.length_table import length_columns
from surfexp.studies.sulci.population import Side
from surfexp.studies.sulci.population_study import SIDES
from surfexp.studies.sulci.sulcal_measurement import DEFAULT, TRUE, measure_sulci
from surfexp.studies.sulci.sulcal_template import make_template

FREESURFER = {"lh": "left", "rh": "right"}


METRICS = {
    "subjects": Metric("number of subjects"),
    "found, {estimator}": Metric("share of lengths that could be measured", better="higher"),
    "difference, sulcus {number}, {estimator}": Metric("mean of left less right over their mean"),
}


@register("statistic", "sulcal_table", metrics=METRICS)
def sulcal_table_statistic(
    template: Surface,
    surfaces: dict[Member, Surface],
    *,
    regions: Annotated[
        int, Field(ge=1, le=100, description="sulcal regions that are measured, longest extent first")
    ] = 3,
) -> Statistic:
    """Lengths of sulci by every estimator for each subject (group) and side (class left or right)."""
    place = {(member.group, FREESURFER.get(member.class_name, member.class_name)): member for member in surfaces}
    subjects = sorted({member.group for member in surfaces})
    if set(place) != {(subject, side) for subject in subjects for side in SIDES} or len(place) != len(surfaces):
        known = ", ".join(f"{member.class_name} of {member.group}" for member in surfaces)
        raise ValueError(f"surfaces are {known}; take one of class left (or lh) and one of class right (or rh) a group")
    study = make_template(template, regions)
    table: dict[str, dict[Side, list[np.ndarray]]] = {}
    for done, (subject, side) in enumerate(sorted(place), 1):
        for name, values in measure_sulci(study, surfaces[place[subject, side]]).items():
            if name != TRUE:
                table.setdefault(name, {"left": [], "right": []})["left" if side == "left" else "right"].append(values)
        report_progress(done, 1.0 - done / len(place))
    lengths = {name: {side: np.array(rows) for side, rows in parts.items()} for name, parts in table.items()}
    rows, columns = length_columns(lengths, range(len(subjects)), subjects)
    metrics = {f"found, {name}": float(np.isfinite(columns[name]).mean()) for name in lengths}
    for k in range(regions):
        for name in (DEFAULT, "own region, line with ends"):
            left, right = (lengths[name][side][:, k] for side in SIDES)
            shares = 2.0 * (left - right) / (left + right)
            if np.isfinite(shares).any():
                metrics[f"difference, sulcus {k + 1}, {name}"] = float(np.nanmean(shares))
    found_regions = ", ".join(str(number + 1) for number in study.measured)
    notes = (
        f"Sulci 1 to {regions} are the regions {found_regions} of the template, whose regions count from the largest.",
    )
    return Statistic("sulcal lengths", columns, rows, {"subjects": float(len(subjects)), **metrics}, notes)
