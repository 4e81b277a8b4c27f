"""Left and right lengths of sulci in a synthetic population, table 6.1 and figure 6.8."""

import numpy as np
from pydantic import Field

from surfexp.embedding.paired_tests import false_positive_rate, paired_tests, power_by_subjects
from surfexp.embedding.population_study import ESTIMATORS, make_template, measure_population
from surfexp.mesh.surface import Surface
from surfexp.statistics.statistic import Statistic
from surfexp.workflow.registry import Options, register
from surfexp.workflow.stage import report_progress


class SulcalAsymmetry(Options):
    """The population and what is planted in it."""

    subjects: int = Field(20, ge=3, le=2000, description="subjects, two hemispheres each")
    regions: int = Field(3, ge=1, le=20, description="sulcal regions that are measured, longest extent first")
    asymmetry: float = Field(0.06, ge=0, le=0.3, description="planted: share by which the first region is longer left")
    strain: float = Field(0.03, ge=0, le=0.3, description="root mean square strain of the random deformations")
    draws: int = Field(200, ge=10, le=100000, description="random exchanges of sides, and samples for the power")
    seed: int = Field(0, ge=0, description="seed of the population")


@register("statistic", "sulcal_asymmetry")
def sulcal_asymmetry_statistic(options: SulcalAsymmetry, *, template: Surface) -> Statistic:
    """Paired tests of sulcal lengths left and right, by estimator, against the difference that was planted."""
    study = make_template(template, options.regions)
    table = measure_population(
        study, options.subjects, options.strain, options.asymmetry, 0, options.seed, report_progress
    )
    rows, columns, metrics = [], {}, {}
    for estimator in ESTIMATORS:
        lengths = table[estimator]
        sides = (
            {f"region {k + 1}, {estimator}": lengths[side][:, k] for k in range(options.regions)}
            for side in ("left", "right")
        )
        tests = paired_tests(*sides)
        rows += list(tests.names)
        for name, values in vars(tests).items():
            if name != "names":
                columns.setdefault(name, []).extend(values)
        differences = lengths["left"] - lengths["right"]
        rates = [
            false_positive_rate(differences[:, k], options.draws, seed=options.seed) for k in range(options.regions)
        ]
        metrics |= {
            f"difference, {estimator}": float(tests.difference[0]),
            f"effect, {estimator}": float(tests.effect[0]),
            f"p, {estimator}": float(tests.p_t_holm[0]),
            f"p Wilcoxon, {estimator}": float(tests.p_wilcoxon_holm[0]),
            f"least p elsewhere, {estimator}": float(tests.p_t_holm[1:].min()) if options.regions > 1 else 1.0,
            f"false positives, {estimator}": float(np.mean(rates)),
        }
        for size in (5, 10, 20):
            power = power_by_subjects(differences[:, 0], [size], options.draws, seed=options.seed)[0]
            metrics[f"power of {size}, {estimator}"] = float(power)
    finite = {name: np.nan_to_num(np.array(values), posinf=1e9, neginf=-1e9) for name, values in columns.items()}
    notes = (
        f"Synthetic population: {options.subjects} deformed copies of {template.name}, the right side mirrored, remeshed, "
        f"strain {options.strain:g}, planted {100 * options.asymmetry:g} % in region 1.",
    )
    return Statistic("sulcal lengths, left and right", finite, tuple(rows), metrics, notes)
