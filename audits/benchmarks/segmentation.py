"""Convex Chan-Vese with the loop over c1, c2 on a torus, against split Bregman as published."""

from __future__ import annotations

from functools import partial

import numpy as np

from audits.benchmarks.convex_problem import Excess, Recorded
from audits.benchmarks.line import Line, race
from audits.benchmarks.measurement import LONG, IterationClock, least_count, measure, median_cost
from audits.benchmarks.scenes import Scene, torus_scene
from surfexp.operators.fem import fem
from surfexp.operators.surface_operator import SurfaceOperator
from surfexp.operators.vertex_averaged import vertex_averaged
from surfexp.variational.fidelity import Fidelity
from surfexp.variational.models.convex_chan_vese import ConvexChanVese
from surfexp.variational.published.split_bregman import published_split_bregman
from surfexp.variational.solution import Solution
from surfexp.variational.solvers.primal_dual import primal_dual

ITERATIONS = (5, 10, 20, 40, 80, 160)
LABELS_SETTLED = 1e-4
CERTIFIED = 1e-4
TOLERANCES = tuple(10.0 ** (-k / 4) for k in range(17))


def warm_up() -> None:
    """Compile what the line uses."""
    scene = torus_scene(40)
    ConvexChanVese().run(scene.image, fem(scene.surface.mesh), primal_dual)
    _published(scene, 2)


def lines(quick: bool) -> list[Line]:
    """Return the line of the torus with 256 x 256 vertices."""
    scene = torus_scene(32 if quick else 256)
    operator = fem(scene.surface.mesh)
    count, theirs, times, settled = _until_labels_settle(scene, operator)
    runs = 3 if times[0] <= LONG else 1
    their_cost = median_cost([times, *(_published(scene, count)[1] for _ in range(runs - 1))])
    method = Recorded(partial(primal_dual, tolerance=CERTIFIED))
    certified, certified_cost = measure(lambda: ConvexChanVese().run(scene.image, operator, method), 1)
    assert method.problem is not None
    excess = Excess(method.problem, operator)
    reached = excess.of(theirs.values)
    tolerance = next(
        (value for value in TOLERANCES if excess.of(_ours(scene, operator, value).values) <= reached), CERTIFIED
    )
    ours, cost = measure(lambda: _ours(scene, operator, tolerance), runs)
    share, their_share = (
        operator.mass @ (_labels(solution) == _labels(certified)) / operator.mass.sum() for solution in (ours, theirs)
    )
    accuracy = (
        f"ours with tolerance {tolerance:.2g} of the model's own scale, the loosest that is no worse: excess of energy "
        f"{excess.scales(ours.values)}; rival {excess.scales(theirs.values)}; labels as of the certified result on "
        f"{share:.2%}, rival on {their_share:.2%}; ours certified to {CERTIFIED:g} of that scale takes "
        f"{certified_cost.cpu:.3g} s"
    )
    state = "settled" if settled else f"still changing after {count}, so its time is a lower bound"
    note = (
        f"{count} iterations an update, labels {state} (under {LABELS_SETTLED:g} of the area changes when they are "
        "doubled, least count by bisection); 1 Gauss-Seidel sweep an iteration; of ours all is counted, of the rival "
        "its iterations"
    )
    work = f"CCV with c-loop, {operator.vertex_count:,} V, both to the energy that the rival reaches"
    fair = certified.converged and excess.of(ours.values) <= reached
    rival = "split Bregman as published, to steady labels"
    return [race(work, rival, 10, cost, their_cost, accuracy, fair=fair, note=note)]


def _ours(scene: Scene, operator: SurfaceOperator, tolerance: float) -> Solution:
    return ConvexChanVese().run(scene.image, operator, partial(primal_dual, tolerance=tolerance))


def _labels(solution: Solution) -> np.ndarray:
    return np.asarray(solution.segmentation) > 0.5


def _until_labels_settle(scene: Scene, operator: SurfaceOperator) -> tuple[int, Solution, tuple[float, float], bool]:
    solution, times = _published(scene, ITERATIONS[0])
    for count in ITERATIONS:
        longer, longer_times = _published(scene, 2 * count)
        if _changed(solution, longer, operator) <= LABELS_SETTLED:
            least = least_count(
                lambda fewer, last=longer: _changed(_published(scene, fewer)[0], last, operator) <= LABELS_SETTLED,
                count // 2,
                count,
            )
            return least, *_published(scene, least), True
        solution, times = longer, longer_times
    return 2 * ITERATIONS[-1], solution, times, False


def _changed(solution: Solution, other: Solution, operator: SurfaceOperator) -> float:
    return float(operator.mass @ (_labels(solution) != _labels(other)) / operator.mass.sum())


def _published(scene: Scene, iterations: int) -> tuple[Solution, tuple[float, float]]:
    """Run the published alternation; audits are not timed."""
    clock = IterationClock()

    def method(fidelity: Fidelity, operator: SurfaceOperator, start: Solution | None = None) -> Solution:
        clock.start()
        options = {"tolerance": 0.0, "iteration_limit": iterations, "progress": clock.tick}
        return published_split_bregman(fidelity, operator, start, **options)  # type: ignore[arg-type]

    solution = ConvexChanVese().run(scene.image, vertex_averaged(scene.surface.mesh), method)
    return solution, (clock.cpu, clock.wall)
