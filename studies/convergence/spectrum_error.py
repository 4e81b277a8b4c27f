"""Errors of computed spectra against exact ones, and their order under refinement."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from surfexp.contract.member import Member, levels_of
from surfexp.linalg.convergence_order import convergence_order
from surfexp.mesh.flat_shapes import FlatTorus
from surfexp.mesh.surface import Surface
from surfexp.spectrum.eigensystem import EigenSystem
from surfexp.statistics.statistic import Statistic


def spectrum_error(surface: Surface, system: EigenSystem, low: int = 8, high: int = 24) -> Statistic:
    """Compare eigenvalues with those of the smooth sphere, disk, rectangle or flat torus that the mesh stands for.

    Parameters
    ----------
    surface : Surface
    system : EigenSystem
    low, high : int
        Errors are the largest relative ones of the first `low` and `high` values that are not 0.

    Returns
    -------
    Statistic
        Columns mode, value, exact, error. Metrics error_low, error_high, edge_length, degrees_of_freedom, and
        below_exact, the number of values under the exact ones by more than 1e-9, which (3.25) says is 0.

    Raises
    ------
    ValueError
        If fewer values were computed, or the exact ones are unknown.
    """
    shape = surface.shape
    if shape is None:
        raise ValueError(
            f"the smooth shape of {surface.name!r} is unknown, so are its eigenvalues: take a generated one"
        )
    exact = shape.spectrum(len(system.values), system.boundary)
    if isinstance(shape, FlatTorus) and abs(system.area - shape.area) > 1e-9 * shape.area:
        raise ValueError(
            f"the spectrum is of a surface of area {system.area:.3g}, not {shape.area:.3g}: take operator=periodic"
        )
    moving = exact > 1e-9 * exact[-1]
    if moving.sum() < max(low, high):
        raise ValueError(f"{int(moving.sum())} values above 0 were computed, {max(low, high)} are asked for")
    found, known = system.values[moving], exact[moving]
    errors = found / known - 1.0
    metrics = {
        "error_low": float(np.abs(errors[:low]).max()),
        "error_high": float(np.abs(errors[:high]).max()),
        "below_exact": float((errors < -1e-9).sum()),
        "edge_length": system.metrics["edge_length"],
        "degrees_of_freedom": system.metrics["degrees_of_freedom"],
        "complete": float(system.complete),
    }
    columns = {"mode": np.arange(1.0, len(found) + 1.0), "value": found, "exact": known, "error": np.abs(errors)}
    return Statistic(f"spectrum of the {surface.name}", columns, metrics=metrics)


def convergence_orders(errors: Mapping[Member, Statistic], metric: str = "error_high") -> Statistic:
    """Fit the order of an error in the edge length, a line for each method.

    Parameters
    ----------
    errors : mapping of Member to Statistic
        The class of a member is its method, and its level the refinement; all methods on the same levels.
    metric : str

    Returns
    -------
    Statistic
        Rows are the levels. Columns: edge_length, and each method's errors. Metrics: "order METHOD", "finest METHOD".

    Raises
    ------
    ValueError
        If a member has no level, or methods have different ones.
    """
    lines: dict[str, dict[float, Statistic]] = {}
    for level, (member, found) in zip(levels_of(errors), errors.items(), strict=True):
        lines.setdefault(member.class_name, {})[level] = found
    levels = [tuple(members) for members in lines.values()]
    if len(set(levels)) != 1 or len(levels[0]) < 2:
        raise ValueError(f"methods have the levels {levels}: at least two, the same for all, are needed")
    first = next(iter(lines.values()))
    sizes = np.array([found.metrics["edge_length"] for found in first.values()])
    columns, metrics = {"edge_length": sizes}, {}
    for line, members in lines.items():
        columns[line] = np.array([found.metrics[metric] for found in members.values()])
        metrics[f"order {line}"] = convergence_order(sizes, columns[line])
        metrics[f"finest {line}"] = float(columns[line][np.argmin(sizes)])
    return Statistic(next(iter(first.values())).name, columns, tuple(f"{level:g}" for level in levels[0]), metrics)
