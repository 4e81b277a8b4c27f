"""Sulcal regions of synthetic subjects named by a template, figure 6.7."""

from collections.abc import Sequence
from typing import Annotated

import numpy as np
from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.lab.running.stage import report_progress
from surfexp.mesh.surface import Surface
from surfexp.statistics.statistic import Statistic
from surfexp.studies.sulci.population import synthetic_subject
from surfexp.studies.sulci.population_study import name_regions
from surfexp.studies.sulci.sulcal_template import make_template

METRICS = {
    "regions": Metric("mean number of sulcal regions"),
    "majority, n = {n}": Metric("share of sulcal area named right by majority vote", better="higher"),
    "published rule, n = {n}": Metric("share of sulcal area named right by the published rule", better="higher"),
    "distance, n = {n}": Metric("mean spectral distance to the template"),
    "majority, ZoomOut": Metric(
        "share of sulcal area named right by majority vote of the refined map", better="higher"
    ),
}


@register("statistic", "sulci_names", metrics=METRICS, defaults_of=(synthetic_subject, name_regions))
def sulci_names_statistic(
    template: Surface,
    *,
    subjects: Annotated[int, Field(ge=1, le=2000, description="subjects, two hemispheres each")] = 6,
    sizes: Annotated[Sequence[int], Field(description="numbers n of eigenfunctions")],
    strain: Annotated[float, Field(ge=0, le=0.3, description="root mean square strain of the random deformations")],
    remeshed: Annotated[bool, Field(description="each subject with vertices of its own")],
    seed: Annotated[int, Field(ge=0, description="seed of the population")],
) -> Statistic:
    """Share of sulcal area named right, by the published rule, by majority vote, and by majority vote of ZoomOut."""
    study = make_template(template, 1)
    scores: list[dict[str, float]] = []
    for subject in range(subjects):
        for side in ("left", "right"):
            target = synthetic_subject(template, subject, side, strain, remeshed=remeshed, seed=seed)
            scores.append(name_regions(study, target, tuple(sizes)))
        report_progress(subject + 1, 1.0 - (subject + 1) / subjects)
    metrics = {name: float(np.mean([score[name] for score in scores])) for name in scores[0]}
    columns = {"n": np.array(sizes, float)}
    for rule in ("majority", "published rule", "distance"):
        columns[rule] = np.array([metrics[f"{rule}, n = {n}"] for n in sizes])
    notes = (f"{2 * subjects} synthetic hemispheres, deformed copies of {template.name}, strain {strain:g}.",)
    return Statistic(f"sulcal regions named right, strain {strain:g}", columns, metrics=metrics, notes=notes)
