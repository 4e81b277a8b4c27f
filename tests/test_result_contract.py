"""What is not a finite real array of the documented shape is no result."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import pytest

from surfexp.contract.result_contract import check_result, documented_shapes
from surfexp.lab.store.kinds import KINDS
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.spectrum.eigensystem import EigenSystem
from surfexp.statistics.statistic import Statistic
from surfexp.variational.solution import Solution


@dataclass(frozen=True, eq=False)
class Table:
    """A table.

    Parameters
    ----------
    rows, columns : (r, 2), (c,) float64
    either : (r,) or (r, 3) float64
    starts : (r + 1,) int64
    """

    rows: Any
    columns: Any
    either: Any
    starts: Any = None
    gaps: Any = field(default=None, metadata={"nan": True})
    metrics: dict[str, Any] = field(default_factory=dict)


GOOD = Table(
    np.zeros((4, 2)), np.zeros(7), np.zeros((4, 3)), np.arange(5), np.array([np.nan, 1.0]), {"a": np.float64(1)}
)


def test_shapes_are_read_from_the_docstring() -> None:
    assert documented_shapes(Table) == {
        "rows": (("r", "2"),),
        "columns": (("c",),),
        "either": (("r",), ("r", "3")),
        "starts": (("r + 1",),),
    }
    check_result(GOOD, Table)
    check_result(replace(GOOD, either=np.zeros(4)), Table)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"rows": np.zeros((4, 3))}, r"rows has shape \(4, 3\), \(r, 2\) is promised"),
        ({"rows": np.zeros(4)}, r"rows has shape \(4,\)"),
        ({"either": np.zeros((5, 3))}, r"either has shape \(5, 3\), \(r\) or \(r, 3\) with r = 4 is promised"),
        ({"columns": np.array([0.0, np.nan])}, "columns has 1 of 2 values that are not finite"),
        ({"columns": np.array([np.inf, np.nan])}, "columns has 2 of 2"),
        ({"gaps": np.array([np.inf, np.nan])}, "gaps has 1 of 2"),
        ({"columns": np.array([1j])}, "columns holds complex128, real numbers are expected"),
        ({"columns": np.array([{}], dtype=object)}, "columns holds object"),
        ({"columns": np.array(["2020-01-01"], "datetime64[D]")}, r"columns holds datetime64\[D\]"),
        ({"columns": np.array([3], "timedelta64[s]")}, "columns holds timedelta64"),
        ({"columns": np.zeros(2, [("x", float)])}, "columns holds .*'x'"),
        ({"columns": {"a": (np.array(["b"]),)}}, r"columns\['a'\]\[0\] holds <U1"),
        ({"metrics": {"a": "1"}}, "metric 'a' is '1' .str., a real number is expected"),
        ({"metrics": {"a": 1j}}, "metric 'a' is 1j"),
        ({"metrics": {"a": np.array([1.0])}}, "metric 'a' is array"),
    ],
)
def test_what_is_not_promised_is_refused(change: dict[str, Any], message: str) -> None:
    with pytest.raises((TypeError, ValueError), match=message):
        check_result(replace(GOOD, **change), Table)


def test_arrays_inside_parts_of_a_result_count() -> None:
    surface = replace(icosphere(1), shape=None)
    check_result(surface, Surface)
    vertices = surface.mesh.vertices.copy()
    vertices[3, 1] = np.nan
    broken = object.__new__(TriangleMesh)
    object.__setattr__(broken, "vertices", vertices)
    object.__setattr__(broken, "faces", surface.mesh.faces)
    with pytest.raises(ValueError, match=r"mesh\.vertices has 1 of 126 values that are not finite"):
        check_result(replace(surface, mesh=broken), Surface)
    with pytest.raises(TypeError, match="returned Table, a plugin of this kind returns Surface"):
        check_result(GOOD, Surface)


def test_a_table_may_lack_values_and_has_no_infinite_ones() -> None:
    check_result(Statistic("lengths", {"left": np.array([1.0, np.nan])}), Statistic)
    with pytest.raises(ValueError, match=r"columns\['left'\] has 1 of 2 values that are not finite"):
        check_result(Statistic("lengths", {"left": np.array([np.inf, np.nan])}), Statistic)


def test_lengths_agree_within_one_result() -> None:
    with pytest.raises(ValueError, match=r"vectors has shape \(9, 4\), \(n, k\) with k = 3 is promised"):
        check_result(EigenSystem(np.zeros(3), np.zeros((9, 4)), np.zeros(3), 0.0, True), EigenSystem)
    with pytest.raises(ValueError, match=r"dual has shape \(5, 3\), \(m, 2\) or \(m, c, 2\) is promised"):
        check_result(Solution(np.zeros(4), 0.0, np.zeros((5, 3))), Solution)


@pytest.mark.parametrize("kind", [kind for kind in KINDS.values() if kind.stored], ids=lambda kind: kind.name)
def test_every_array_of_a_kind_has_a_documented_shape(kind: Any) -> None:
    arrays = {item.name for item in dataclasses.fields(kind.result) if "Floats" in str(item.type)}
    like_another, free = {"clean"}, {"parts"}
    assert arrays - like_another - free <= documented_shapes(kind.result).keys()
