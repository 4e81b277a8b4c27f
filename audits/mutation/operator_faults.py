"""The table of faults in operators."""

from __future__ import annotations

from audits.mutation.fault import Fault

LIMIT = "tests/variational/test_solvers.py::test_iteration_limit_is_said_and_the_result_is_certified"
TRIANGLE = "tests/variational/test_exact_solutions.py::test_equilateral_triangle_shrinks_by_the_known_factor"
ADJOINT = "tests/operators/test_fem.py::test_divergence_is_the_negative_adjoint_of_the_gradient"
LIBIGL = "tests/operators/test_fem.py::test_libigl_agrees"
FIELDS = "tests/operators/test_crouzeix_raviart.py::test_linear_fields_of_a_plane_are_exact"

OPERATOR_FAULTS = (
    Fault(
        "derivative of a tangent field by conforming hat functions",
        "surfexp/operators/crouzeix_raviart.py",
        "slopes = -2.0 * operator.hat_gradients",
        "slopes = 2.0 * operator.hat_gradients",
        (FIELDS,),
    ),
    Fault(
        "adjoint with a wrong sign at one corner",
        "surfexp/operators/calculus.py",
        "            result[i, c] -= b + e",
        "            result[i, c] += b + e",
        (ADJOINT,),
    ),
    Fault(
        "divergence without its minus sign",
        "surfexp/operators/calculus.py",
        "return -load / operator.mass",
        "return load / operator.mass",
        (ADJOINT,),
    ),
    Fault(
        "area of the parallelogram in place of the triangle",
        "surfexp/operators/fem.py",
        "areas[f] = 0.5 * twice_area",
        "areas[f] = twice_area",
        (LIBIGL,),
    ),
    Fault(
        "lumped mass of half the ring area, not a third",
        "surfexp/operators/surface_operator.py",
        "np.repeat(self.areas / 3.0, 3)",
        "np.repeat(self.areas / 2.0, 3)",
        (f"{LIMIT}[primal_dual]", TRIANGLE),
    ),
    Fault(
        "consistent mass twice too large",
        "surfexp/operators/assembly.py",
        "share = areas[f] / 12.0",
        "share = areas[f] / 6.0",
        ("tests/operators/test_elements.py::test_order_one_equals_the_cotangent_matrices", LIBIGL),
    ),
    Fault(
        "averaged gradient not divided by three",
        "surfexp/operators/vertex_averaged.py",
        "1.0 / (3.0 * operator.mass)",
        "1.0 / operator.mass",
        ("tests/operators/test_vertex_averaged.py::test_agrees_with_the_formula_as_published",),
    ),
)
