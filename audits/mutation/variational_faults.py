"""The table of faults in variational methods."""

from __future__ import annotations

from audits.mutation.fault import Fault

LIMIT = "tests/variational/test_solvers.py::test_iteration_limit_is_said_and_the_result_is_certified"
RETURNED = "tests/variational/test_solvers.py::test_certificate_belongs_to_the_values_that_are_returned"
TRIANGLE = "tests/variational/test_exact_solutions.py::test_equilateral_triangle_shrinks_by_the_known_factor"
AGREE = "tests/variational/test_agreement.py::test_solvers_agree[fem-rof]"
REGIONS = "tests/variational/test_models.py::test_convex_chan_vese_finds_the_regions"
PROX = "tests/variational/test_proximal_maps.py::test_prox_is_the_minimiser"
BOUND = "tests/variational/test_proximal_maps.py::test_dual_value_is_a_lower_bound"
BALANCED = "tests/variational/test_generalised_variation.py::test_the_certificate_again_by_other_means"
BELOW = "tests/variational/test_generalised_variation.py::test_no_field_has_less_energy_than_the_bound_of_any_dual"
STRIP = "tests/variational/test_generalised_variation.py::test_an_exact_solution_and_its_rate"
COAREA = "tests/variational/test_level_sets.py::test_coarea_formula_is_exact"

VARIATIONAL_FAULTS = (
    Fault(
        "dual field of total generalised variation left out of balance",
        "surfexp/variational/generalised_forms.py",
        "return np.asarray(dual - self._slope_forms @ move)",
        "return np.asarray(dual)",
        (BELOW,),
    ),
    Fault(
        "slopes of total generalised variation charged twice",
        "surfexp/variational/generalised_forms.py",
        "self.ratio * fields.derivative]",
        "2.0 * self.ratio * fields.derivative]",
        (BALANCED,),
    ),
    Fault(
        "penalty of the second part without its scale in the shortening",
        "surfexp/variational/solvers/generalised_splitting.py",
        "shortened(mixed, 1.0 / penalties[0], 1.0 / penalties[1])",
        "shortened(mixed, 1.0 / penalties[0], 1.0 / penalties[0])",
        (STRIP,),
    ),
    Fault(
        "fidelity without its factor 1/2",
        "surfexp/variational/separable_quadratic.py",
        "0.5 * weight[i] * difference * difference",
        "weight[i] * difference * difference",
        (f"{LIMIT}[primal_dual]",),
    ),
    Fault(
        "linear term with a wrong sign in the proximal map",
        "surfexp/variational/separable_quadratic.py",
        "step * (weight[i] * target[i] - slope[i])",
        "step * (weight[i] * target[i] + slope[i])",
        (PROX,),
    ),
    Fault(
        "dual energy at the wrong end of the box",
        "surfexp/variational/separable_quadratic.py",
        "lower if force > 0.0 else upper",
        "upper if force > 0.0 else lower",
        (BOUND,),
    ),
    Fault(
        "Chan-Vese in the box [-1, 1]",
        "surfexp/variational/separable_quadratic.py",
        "zero, zero, slope, 0.0, 1.0, trivial",
        "zero, zero, slope, -1.0, 1.0, trivial",
        (REGIONS,),
    ),
    Fault(
        "dual ascent downhill",
        "surfexp/variational/solvers/face_sweeps.py",
        "x, y = dual[f, c, 0] + ascent * x, dual[f, c, 1] + ascent * y",
        "x, y = dual[f, c, 0] - ascent * x, dual[f, c, 1] - ascent * y",
        (TRIANGLE,),
    ),
    Fault(
        "dual field outside the unit ball",
        "surfexp/variational/solvers/face_sweeps.py",
        "            dual[f, c, 0], dual[f, c, 1] = x, y\n            square += x * x + y * y\n"
        "        shrink = 1.0 / np.sqrt(max(square, 1.0))",
        "            dual[f, c, 0], dual[f, c, 1] = x, y\n            square += x * x + y * y\n"
        "        shrink = 1.0 / np.sqrt(max(square - 1e-6, 1.0))",
        (f"{LIMIT}[primal_dual]", RETURNED),
    ),
    Fault(
        "dual steps ten times too long",
        "surfexp/variational/solvers/face_sweeps.py",
        "steps[f] = 2.0 / (3.0 *",
        "steps[f] = 20.0 / (3.0 *",
        (TRIANGLE, REGIONS),
    ),
    Fault(
        "Bregman pull V - b without the last update of b",
        "surfexp/variational/solvers/face_sweeps.py",
        "areas[f] * (x - 2.0 * px), areas[f] * (y - 2.0 * py)",
        "areas[f] * (x - px), areas[f] * (y - py)",
        (TRIANGLE,),
    ),
    Fault(
        "certificate of the first iterate for all",
        "surfexp/variational/duality_gap.py",
        "certificate = certify(fidelity, operator, iterate.values, iterate.load)\n",
        "certificate = certificate if rows else certify(fidelity, operator, iterate.values, iterate.load)\n",
        (RETURNED,),
    ),
    Fault(
        "dual field of the first iterate kept by split Bregman",
        "surfexp/variational/solvers/split_bregman.py",
        "np.multiply(self.multiplier, self.penalty, out=self.dual)",
        "np.multiply(self.multiplier, self.penalty if iteration == 1 else 0.0, out=self.dual)",
        (f"{LIMIT}[split_bregman]", RETURNED),
    ),
    Fault(
        "FISTA certified by the load of its extrapolated field",
        "surfexp/variational/solvers/fista_dual.py",
        "own = adjoint_gradient(operator, dual)",
        "own = load",
        (f"{LIMIT}[fista_dual]",),
    ),
    Fault(
        "error bound without its factor 2",
        "surfexp/variational/duality_gap.py",
        "np.sqrt(2.0 * max(gap, 0.0) / mu)",
        "np.sqrt(max(gap, 0.0) / mu)",
        (f"{LIMIT}[primal_dual]",),
    ),
    Fault(
        "c1 and c2 swapped",
        "surfexp/variational/models/convex_chan_vese.py",
        "((c1 - image.values) ** 2 - (c2 - image.values) ** 2)",
        "((c2 - image.values) ** 2 - (c1 - image.values) ** 2)",
        (REGIONS,),
    ),
    Fault(
        "means not divided by the area",
        "surfexp/variational/models/convex_chan_vese.py",
        "integral / area if self.divide_by_area else integral",
        "integral",
        (REGIONS,),
    ),
    Fault(
        "c2 weighted by 1 + H(phi)",
        "surfexp/variational/models/chan_vese.py",
        "outside = self._operator.mass - inside",
        "outside = self._operator.mass + inside",
        ("tests/variational/test_models.py::test_nonconvex_chan_vese_records_the_energy_of_its_own_means",),
    ),
    Fault(
        "Newton's matrix with half the fidelity",
        "surfexp/variational/solvers/newton_system.py",
        "self._entries[pattern.diagonal] += self._weight",
        "self._entries[pattern.diagonal] += 0.5 * self._weight",
        ("tests/variational/test_newton_system.py",),
    ),
    Fault(
        "regions taken below the threshold",
        "surfexp/variational/labellings.py",
        "values > level, threshold",
        "values <= level, threshold",
        ("tests/variational/test_labellings.py",),
    ),
    Fault(
        "threshold of the greatest energy",
        "surfexp/variational/labellings.py",
        "best = int(np.argmin(energies))",
        "best = int(np.argmax(energies))",
        ("tests/variational/test_labellings.py",),
    ),
    Fault(
        "edge weights with the wrong edge",
        "surfexp/variational/labellings.py",
        "operator.faces[:, [1, 2, 2, 0, 0, 1]]",
        "operator.faces[:, [0, 1, 1, 2, 2, 0]]",
        ("tests/variational/test_labellings.py",),
    ),
    Fault(
        "variance not divided by the area",
        "surfexp/variational/models/convex_chan_vese.py",
        "(image.values - mean) ** 2) / area",
        "(image.values - mean) ** 2)",
        ("tests/variational/test_segmentation.py::test_the_weight_scales_as_one_over_a_length_and_two_units",),
    ),
    Fault(
        "the solver's field returned whatever its energy",
        "surfexp/variational/models/convex_chan_vese.py",
        "solution.energy <= best.energy",
        "solution.energy > best.energy",
        ("tests/variational/test_segmentation.py",),
    ),
    Fault(
        "period counted from the first update",
        "surfexp/variational/mean_updates.py",
        "len(distances) - near[-1]",
        "near[-1] + 1",
        ("tests/variational/test_segmentation.py",),
    ),
    Fault(
        "perimeter of half the length",
        "surfexp/variational/level_sets.py",
        "longest = 2.0 * areas[f]",
        "longest = areas[f]",
        (COAREA,),
    ),
    Fault(
        "weight = mu sigma h without h",
        "surfexp/variational/models/rof.py",
        "return weight / (image.noise * operator.edge_length)",
        "return weight / image.noise",
        ("tests/variational/test_models.py::test_rof_lowers_the_error", "tests/variational/test_invariance.py"),
    ),
    Fault(
        "shrinkage by twice the radius",
        "surfexp/variational/published/vector_pair.py",
        "1.0 - radius / np.maximum(lengths, radius)",
        "1.0 - 2.0 * radius / np.maximum(lengths, 2.0 * radius)",
        (AGREE,),
    ),
)
