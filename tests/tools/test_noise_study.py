"""The table of the study of noise: ratios to the best in hindsight, means over maps and seeds."""

from __future__ import annotations

from audits.benchmarks.noise_study import RULES, Filters, alarm_table, ratio_table
from audits.benchmarks.noisy_maps import smooth_field, standardised, with_noise
from audits.benchmarks.noisy_retest import Pair, distances
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh


def test_no_rule_is_better_than_the_best_in_hindsight() -> None:
    ball = icosphere(3)
    clean = standardised("first", "ball", ball, smooth_field(ball, 1))
    found = Filters(clean).errors("white", 0)
    assert set(found) == {*RULES, "best"}
    assert min(found.values()) == found["best"] < 0.5
    assert with_noise(clean, "white", 0).shape == clean.values.shape


def test_the_table_takes_means_over_maps_and_the_largest_of_a_map() -> None:
    def rows(*ratios: float) -> list[dict[str, float]]:
        return [dict.fromkeys(RULES, 2.0 * ratio) | {"best": 2.0} for ratio in ratios]

    noises = ("white", "outliers", "t3", "laplace", "varying", "smooth", "rounded", "none")
    cells = {(name, noise): rows(*ratios) for name, ratios in {"a": (1, 2), "b": (3, 3)}.items() for noise in noises}
    lines = ratio_table(cells).splitlines()
    assert lines[2].startswith("| white | 2.250 (3.00) |")
    # without noise no ratio exists
    assert lines[-1].startswith("| none | 4.500 (6.00) |")


def test_a_retest_shows_smooth_noise_that_the_test_alone_does_not() -> None:
    ball = icosphere(4)
    head = Surface(TriangleMesh(100.0 * ball.mesh.vertices, ball.mesh.faces), "head", "mm")
    clean = standardised("", "head", head, head.mesh.vertices[:, 2] > 0)
    noises = [4.0 * smooth_field(head, seed, width=3.0) for seed in range(3)]
    pair = Pair("head", head, clean.operator, *(clean.values + noise for noise in noises))
    assert pair.distance(pair.judge) == 0.0 and abs(pair.distance(pair.judge + 2.0) - 2.0) < 1e-12
    found = distances(pair)
    assert found["heat, hold-out"] >= 1.0 and found["level alone over both"] < 0.7
    assert found["default, noise from both"] < found["default"] <= found["nothing"]
    assert found["said by both: smooth"] == 1.0


def test_alarms_of_no_map_are_no_rows() -> None:
    assert len(alarm_table((), 0).splitlines()) == 2
