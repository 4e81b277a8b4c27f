"""The table of faults in spectra, statistics, skeletons and spectral distances."""

from __future__ import annotations

from audits.mutation.fault import Fault

DISK = "tests/spectrum/test_heat.py::test_disk"
SPHERE = "tests/spectrum/test_heat.py::test_sphere"
COUNTS = "tests/spectrum/test_nodal.py::test_counts_and_labels_equal_scipy"
BUMP = "tests/spectrum/test_nodal.py::test_a_bump_below_the_peak_threshold_is_no_domain"
MISSED = "tests/spectrum/test_eigensolver.py::test_a_planted_gap_is_caught"
INERTIA = "tests/linalg/test_ldlt.py::test_inertia_equals_dense_counts_at_random_shifts_on_a_clustered_spectrum"
SOLVES = "tests/linalg/test_ldlt.py::test_any_symmetric_pattern_solves_and_counts"
RESTARTED = "tests/spectrum/test_eigensolver.py::test_a_pair_that_lanczos_lost_is_found_by_starting_again"
SOUP = "tests/operators/test_assembly.py::test_any_soup_is_the_sum_of_its_triplets"
PLANE = "tests/statistics/test_embeddings.py::test_points_of_the_plane_are_recovered"
PEOPLE = "tests/statistics/test_classifiers.py::test_nobody_is_judged_by_their_own_other_side"
FRONT = "tests/skeleton/test_flux.py::test_fast_marching_converges_to_arcs_on_the_sphere"
CONTRACTION = "tests/skeleton/test_reeb_graph.py::test_the_sampled_graph_is_a_contraction_of_the_exact_one"
STOPPED = "tests/embedding/test_sign_search.py::test_a_stopped_search_says_so_and_its_bound_holds"
ENUMERATION = "tests/embedding/test_sign_search.py::test_branch_and_bound_equals_enumeration"
SHIFTED = "tests/embedding/test_distances.py::test_wasserstein_of_a_shift_and_of_sorted_numbers"
HOLM = "tests/embedding/test_paired_tests.py::test_holm_corrects_each_kind_of_p_by_itself"
INTERVAL = "tests/embedding/test_paired_tests.py::test_the_interval_of_the_effect_ends_at_zero_where_p_is_five_percent"
WELCH = "studies/skeletons/tests/test_width_test.py::test_welch_by_hand"

GEOMETRY_FAULTS = (
    Fault(
        "signed ranks corrected with the p of t",
        "surfexp/statistics/paired_tests.py",
        "p_w, holm[1],",
        "p_w, holm[0],",
        (HOLM,),
    ),
    Fault(
        "interval of the effect over the root of n - 1",
        "surfexp/statistics/paired_tests.py",
        "/ np.sqrt(count)",
        "/ np.sqrt(count - 1)",
        (INTERVAL,),
    ),
    Fault(
        "Welch's variance over n",
        "studies/skeletons/positionwise_comparison.py",
        "second.var(axis=0, ddof=1)",
        "second.var(axis=0, ddof=0)",
        (WELCH,),
    ),
    Fault(
        "boundary term of the heat trace twice as large",
        "surfexp/spectrum/heat_trace.py",
        "boundary_length / (8.0 * np.sqrt",
        "boundary_length / (4.0 * np.sqrt",
        (DISK,),
    ),
    Fault(
        "constant of the heat trace without pi, as published",
        "surfexp/spectrum/heat_trace.py",
        "return euler_characteristic / 6.0",
        "return euler_characteristic / (6.0 * np.pi)",
        (SPHERE,),
    ),
    Fault(
        "pieces of one sign that meet stay apart",
        "surfexp/spectrum/nodal_domains.py",
        "                    parent[other] = own",
        "                    parent[other] = other",
        (COUNTS,),
    ),
    Fault(
        "a piece that has grown keeps its first peak",
        "surfexp/spectrum/nodal_domains.py",
        "            top[own] = max(top[own], height)",
        "            top[own] = max(top[own], 0.0)",
        (COUNTS, BUMP),
    ),
    Fault(
        "a slice is complete though pairs are missing",
        "surfexp/spectrum/spectrum_slice.py",
        "complete = len(values) == expected and",
        "complete = len(values) <= expected and",
        (MISSED,),
    ),
    Fault(
        "inertia counts positive pivots as negative",
        "surfexp/linalg/ldlt.py",
        "(self._pivots < 0",
        "(self._pivots > 0",
        (INERTIA,),
    ),
    Fault(
        "double centring with the other sign",
        "surfexp/statistics/multidimensional_scaling.py",
        "eigh(-0.5 * centring",
        "eigh(0.5 * centring",
        (PLANE,),
    ),
    Fault(
        "training on the person who is judged",
        "surfexp/statistics/classifiers.py",
        "np.flatnonzero(owners != owner)",
        "np.flatnonzero(owners >= 0)",
        (PEOPLE,),
    ),
    Fault(
        "fronts that only follow edges",
        "surfexp/skeleton/fast_marching.py",
        "return min(along, distance[u] + t)",
        "return along",
        (FRONT,),
    ),
    Fault(
        "saddles that join two contours are no nodes",
        "surfexp/skeleton/exact_reeb_graph.py",
        "lowest_arc >= 0 and not several:",
        "lowest_arc >= 0:",
        (CONTRACTION,),
    ),
    Fault(
        "a stopped search claims its value as the bound",
        "surfexp/embedding/sign_search.py",
        "lower = float(min(bounds))",
        "lower = value",
        (STOPPED,),
    ),
    Fault(
        "branches closed that could still be better",
        "surfexp/embedding/sign_search.py",
        "            if depth + 1 < n and found < value:",
        "            if depth + 1 < n and found < 0.9 * value:",
        (ENUMERATION,),
    ),
    Fault(
        "transport of squared distances",
        "surfexp/embedding/wasserstein.py",
        "ot.emd2(*weights, cdist(first, second))",
        "ot.emd2(*weights, cdist(first, second) ** 2)",
        (SHIFTED,),
    ),
    Fault(
        "one row too few of those that are not four together",
        "surfexp/linalg/ldlt_solve.py",
        "    for t in range(fours, len(below)):\n        a = load(x, below[t])\n        for j in range(width):",
        "    for t in range(fours + 1, len(below)):\n        a = load(x, below[t])\n        for j in range(width):",
        (SOLVES,),
    ),
    Fault(
        "a front's last eight columns keep their products",
        "surfexp/linalg/ldlt_front.py",
        "        for part in range(i // LANES + 1):",
        "        for part in range(i // LANES):",
        (INERTIA,),
    ),
    Fault(
        "a search that starts again solves at the edge",
        "surfexp/spectrum/spectrum_slice.py",
        "        if attempt:",
        "        if attempt > RESTARTS:",
        (RESTARTED,),
    ),
    Fault(
        "element matrices are added transposed",
        "surfexp/operators/assembly_pattern.py",
        "slots[face, a, b] = row[1]",
        "slots[face, b, a] = row[1]",
        (SOUP,),
    ),
)
