"""Left and right lengths of sulci in a synthetic population, table 6.1 and figure 6.8."""

from collections.abc import Sequence
from typing import Annotated

import numpy as np
from pydantic import Field

from surfexp.contract.metric import Metric
from surfexp.lab.registry.registry import register
from surfexp.lab.running.stage import report_progress
from surfexp.mesh.surface import Surface
from surfexp.statistics.statistic import Statistic
from surfexp.studies.sulci.asymmetry import asymmetry_study, measured, power_study
from surfexp.studies.sulci.fresh_populations import fresh_study
from surfexp.studies.sulci.length_table import chosen, length_columns, table_of
from surfexp.studies.sulci.population_study import Table, measure_population
from surfexp.studies.sulci.sulcal_template import make_template

Estimators = Annotated[
    Sequence[str], Field(description="estimators of length, such as 'carried ends'; none: all of the table")
]
Draws = Annotated[int, Field(ge=10, le=100000, description="random halves of the subjects, and samples for the power")]
Seed = Annotated[int, Field(ge=0, description="seed of exchanges and samples")]


SULCAL_POPULATION_METRICS = {
    "subjects": Metric("number of subjects"),
    "found, {estimator}": Metric("share of lengths that could be measured", better="higher"),
}


@register("statistic", "sulcal_population", metrics=SULCAL_POPULATION_METRICS, defaults_of=measure_population)
def sulcal_population_statistic(
    template: Surface,
    *,
    subjects: Annotated[int, Field(ge=1, le=2000, description="subjects of this block, two hemispheres each")] = 10,
    first: Annotated[int, Field(ge=0, le=1000000, description="number of the block's first subject")] = 0,
    regions: Annotated[
        int, Field(ge=1, le=20, description="sulcal regions that are measured, longest extent first")
    ] = 3,
    asymmetry: Annotated[
        float, Field(ge=0, le=0.3, description="planted: share by which the first region is longer left")
    ],
    strain: Annotated[float, Field(ge=0, le=0.3, description="root mean square strain of the random deformations")],
    lines: Annotated[bool, Field(description="measure the lines of regions too, or only geodesics between ends")],
    seed: Annotated[int, Field(ge=0, description="seed of the population")],
) -> Statistic:
    """Lengths of sulci by every estimator for each subject and side of a block of a synthetic population."""
    study, numbers = make_template(template, regions), range(first, first + subjects)
    table = measure_population(study, numbers, strain, asymmetry, 0, seed, report_progress, lines)
    rows, columns = length_columns(table, numbers)
    metrics = {f"found, {name}": float(np.isfinite(columns[name]).mean()) for name in table}
    notes = (
        f"Synthetic: deformed copies of {template.name}, the right side mirrored, remeshed, strain {strain:g}, "
        f"planted {100 * asymmetry:g} % in sulcus 1. Sides are 0 left, 1 right.",
    )
    return Statistic("sulcal lengths", columns, rows, {"subjects": float(subjects), **metrics}, notes)


SULCAL_ASYMMETRY_METRICS = {
    "difference, {estimator}": Metric("mean relative difference of the first sulcus between the sides"),
    "effect, {estimator}": Metric("effect size of the first sulcus"),
    "p, {estimator}": Metric("p of the first sulcus, paired t-test, corrected by Holm"),
    "p Wilcoxon, {estimator}": Metric("p of the first sulcus, Wilcoxon's test, corrected by Holm"),
    "least p elsewhere, {estimator}": Metric("least corrected p of the other sulci"),
    "found in halves, {estimator}": Metric("share of random halves of the subjects with a difference"),
    "length, {estimator}": Metric("mean length of the first sulcus", "mm"),
    "pairs, {estimator}": Metric("complete pairs of the first sulcus"),
    "published share of line": Metric("length of the published line over that with its ends"),
}


@register("statistic", "sulcal_asymmetry", metrics=SULCAL_ASYMMETRY_METRICS, defaults_of=asymmetry_study)
def sulcal_asymmetry_statistic(
    lengths: dict[str, Statistic], *, estimators: Estimators = (), draws: Draws, seed: Seed
) -> Statistic:
    """Paired tests of sulcal lengths left and right, by estimator and sulcus, corrected by Holm."""
    table, missing = measured(_chosen(estimators, lengths))
    rows, columns, metrics = asymmetry_study(table, draws, seed)
    return Statistic("sulcal lengths, left and right", columns, rows, metrics, _notes(lengths) + missing)


SULCAL_POWER_METRICS = {
    "{estimator}, {size}": Metric(
        "share of samples of that many subjects in which the first sulcus differs", better="higher"
    ),
}


@register("statistic", "sulcal_power", metrics=SULCAL_POWER_METRICS, defaults_of=power_study)
def sulcal_power_statistic(
    lengths: dict[str, Statistic],
    *,
    estimators: Estimators = (),
    draws: Draws,
    seed: Seed,
    sizes: Annotated[Sequence[int], Field(description="numbers of subjects")] = [5, 10, 15, 20, 30, 40],
) -> Statistic:
    """Share of samples of so many subjects in which the planted difference is found, by estimator."""
    table, missing = measured(_chosen(estimators, lengths), 1)
    columns = power_study(table, sizes, draws, seed)
    metrics = {f"{name}, {size}": float(columns[name][k]) for name in table for k, size in enumerate(sizes)}
    return Statistic("power to find the planted difference", columns, (), metrics, _notes(lengths) + missing)


SULCAL_FALSE_POSITIVES_METRICS = {
    "false positives, {estimator}, {size}": Metric("share of tests of fresh populations that find a difference"),
    "tests, {estimator}, {size}": Metric("number of tests"),
    "least p of all, {estimator}": Metric("least corrected p of all sulci over all subjects"),
    "largest difference, {estimator}": Metric("largest mean relative difference of a sulcus"),
    "all subjects, {estimator}": Metric("complete pairs over all subjects"),
}


@register("statistic", "sulcal_false_positives", metrics=SULCAL_FALSE_POSITIVES_METRICS)
def sulcal_false_positives_statistic(
    lengths: dict[str, Statistic],
    *,
    estimators: Estimators = (),
    sizes: Annotated[Sequence[int], Field(description="subjects of each population, none in two of one size")] = [
        5,
        10,
        40,
    ],
) -> Statistic:
    """Share of populations without a subject in common in which a t-test finds a difference at .05."""
    table, missing = measured(_chosen(estimators, lengths))
    columns, metrics = fresh_study(table, sizes)
    return Statistic("differences found in fresh populations", columns, (), metrics, _notes(lengths) + missing)


def _chosen(estimators: Sequence[str], lengths: dict[str, Statistic]) -> Table:
    return chosen(table_of(part.columns for part in lengths.values()), estimators)


def _notes(lengths: dict[str, Statistic]) -> tuple[str, ...]:
    return tuple(dict.fromkeys(note for part in lengths.values() for note in part.notes))
