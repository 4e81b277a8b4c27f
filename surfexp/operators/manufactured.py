"""Functions on spheres and tori whose gradient and Laplacian are known, and the errors of an operator on them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import diags_array

from surfexp.contract.arrays import Floats
from surfexp.linalg.ldlt import ldlt
from surfexp.mesh.curved_shapes import UP, Sphere, Torus
from surfexp.mesh.surface import Surface
from surfexp.operators.assembly import stiffness
from surfexp.operators.calculus import divergence, gradient
from surfexp.operators.surface_operator import SurfaceOperator


@dataclass(frozen=True, eq=False)
class Manufactured:
    """A function at the vertices with its exact surface gradient and Laplacian.

    Parameters
    ----------
    values : (n,) float64
    gradient : (n, 3) float64
        Tangent to the smooth surface.
    laplacian : (n,) float64
    """

    values: Floats
    gradient: Floats
    laplacian: Floats


def manufactured(surface: Surface) -> Manufactured:
    """Return x y z on a sphere about the origin, or sin u sin v on a torus of revolution about z.

    The angles u around the axis and v around the tube are those of the points; the harmonic polynomial x y z of degree 3
    has Laplacian -12 x y z / r^2.

    Raises
    ------
    ValueError
        If the surface is neither.
    """
    points = surface.mesh.vertices
    if isinstance(surface.shape, Sphere):
        x, y, z = points.T
        values, radius = x * y * z, surface.shape.radius
        ambient = np.stack([y * z, z * x, x * y], axis=1)
        tangent = ambient - 3.0 * values[:, None] * points / radius**2
        return Manufactured(values, tangent, -12.0 * values / radius**2)
    if isinstance(surface.shape, Torus) and surface.shape.axis == UP:
        return _on_torus(points, surface.shape)
    raise ValueError(
        f"{surface.name!r} is no sphere about the origin and no torus of revolution about z: take icosphere or torus"
    )


def _on_torus(points: Floats, torus: Torus) -> Manufactured:
    minor, rho = torus.minor_radius, np.hypot(points[:, 0], points[:, 1])
    u, v = np.arctan2(points[:, 1], points[:, 0]), np.arctan2(points[:, 2], rho - torus.major_radius)
    values, along_u, along_v = np.sin(u) * np.sin(v), np.cos(u) * np.sin(v), np.sin(u) * np.cos(v)
    east = np.stack([-np.sin(u), np.cos(u), np.zeros_like(u)], axis=1)
    north = np.stack([-np.sin(v) * np.cos(u), -np.sin(v) * np.sin(u), np.cos(v)], axis=1)
    tangent = (along_u / rho)[:, None] * east + (along_v / minor)[:, None] * north
    laplacian = -values / rho**2 - values / minor**2 - np.sin(v) * along_v / (rho * minor)
    return Manufactured(values, tangent, laplacian)


def operator_errors(operator: SurfaceOperator, exact: Manufactured) -> dict[str, float]:
    """Return the relative errors of gradient, divergence and Laplacian; those of W and W. where there is one.

    Returns
    -------
    dict
        gradient_error, divergence_error : in the L2 norm;
        laplacian_error, laplacian_error_max, laplacian_error_weak : of M^-1 Q f, (1.19), in the norms L2, L-infinity and H^-1.
    """
    mass, rows = operator.mass, operator.averaged_gradient
    if rows is not None:
        found = np.stack([row @ exact.values for row in rows], axis=1)
        gradient_error = _relative(mass, found - exact.gradient, exact.gradient)
        spread = sum(row @ exact.gradient[:, x] for x, row in enumerate(rows))
    elif operator.frames is not None:
        wanted = np.einsum("fax,fx->fa", operator.frames, exact.gradient[operator.faces].mean(axis=1))
        gradient_error = _relative(operator.areas, gradient(operator, exact.values) - wanted, wanted)
        spread = divergence(operator, wanted)
    else:
        raise ValueError(f"operator {operator.name!r} has no frames in space, its gradient cannot be compared")
    matrix = stiffness(operator)
    defect = -(matrix @ exact.values) / mass - exact.laplacian
    lifted = ldlt(matrix + diags_array(mass)).solve(mass[:, None] * np.stack([defect, exact.laplacian], axis=1))
    weak, size = (mass * defect) @ lifted[:, 0], (mass * exact.laplacian) @ lifted[:, 1]
    return {
        "gradient_error": gradient_error,
        "divergence_error": _relative(mass, spread - exact.laplacian, exact.laplacian),
        "laplacian_error": _relative(mass, defect, exact.laplacian),
        "laplacian_error_max": float(np.abs(defect).max() / np.abs(exact.laplacian).max()),
        "laplacian_error_weak": float(np.sqrt(weak / size)),
    }


def _relative(weights: Floats, error: Floats, size: Floats) -> float:
    squares = [weights @ (part**2).reshape(len(part), -1).sum(axis=1) for part in (error, size)]
    return float(np.sqrt(squares[0] / squares[1]))
