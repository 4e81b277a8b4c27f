"""The examples of what `import surfexp` offers print what they promise, and import nothing else of surfexp."""

from __future__ import annotations

import ast
import re
import runpy
from pathlib import Path

import numpy as np
import pandas
import pytest

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
TABLE = (EXAMPLES / "README.md").read_text(encoding="utf-8")
NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e-?\d+)?")


@pytest.fixture
def printed(request: pytest.FixtureRequest, working_folder: Path, capsys: pytest.CaptureFixture[str]) -> list[str]:
    """Lines of the example that the test is named after."""
    runpy.run_path(str(EXAMPLES / f"{request.function.__name__.removeprefix('test_')}.py"))
    return capsys.readouterr().out.splitlines()


def numbers(lines: list[str]) -> list[float]:
    return [float(number) for number in NUMBER.findall("\n".join(lines))]


@pytest.mark.parametrize("path", sorted(EXAMPLES.glob("*.py")), ids=lambda path: path.stem)
def test_every_example_asks_a_question_of_the_face_alone(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    tree = ast.parse(text)
    # prose between cells, as the gallery shows it
    assert re.search(r"(?m)^# %%\n# [A-Z`]", text)
    question = ast.get_docstring(tree) or ""
    assert "?" in question and "\n" not in question and f"| [{path.name}]({path.name}) | {question} |" in TABLE
    modules = [alias.name for node in ast.walk(tree) if isinstance(node, ast.Import) for alias in node.names]
    modules += [str(node.module) for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)]
    assert [module for module in modules if module.startswith("surfexp")] == ["surfexp"]


def test_certified_spectrum(printed: list[str]) -> None:
    assert re.match(r"1\d\d eigenvalues below 1\d\d\.", printed[0]) and printed[0].endswith("True")
    assert printed[1].startswith("300 eigenvalues below 340.69") and printed[1].endswith("True")


@pytest.mark.slow
def test_choose_a_filter(printed: list[str]) -> None:
    step, slope = printed
    assert "variation" in step and "heat" in slope
    assert all(float(line.split("error ")[1].split()[0]) < 0.2 for line in printed)


def test_classify_with_scikit_learn(printed: list[str]) -> None:
    share, bodies = numbers(printed)
    assert share == 100 and bodies == 15


def test_denoise_a_cortex(printed: list[str]) -> None:
    known, vertices, noise, before, after, gap = numbers(printed)
    assert known < vertices == 10242 and noise == pytest.approx(0.5, rel=0.1) and gap <= 1e-3
    assert before == pytest.approx(0.5, abs=0.02) and after < 0.6 * before
    assert Path("thickness.shape.gii").stat().st_size > 0


def test_denoise_an_image(printed: list[str]) -> None:
    error, gap = numbers(printed)
    assert error <= 12.0 and 0.0 <= gap <= 1e-4


def test_eigsh_in_place_of_scipy(printed: list[str]) -> None:
    count, error, largest, orthogonality = numbers(printed)
    assert count == 9 and error < 0.02 * largest and orthogonality < 1e-10


def test_embed_shapes(printed: list[str]) -> None:
    places = [line.split(":")[1] for line in printed[:-1]]
    assert places[0] == places[1] and places[2] == places[3] and places[0] != places[2]
    assert float(printed[-1].split()[-1]) < 0.2


def test_fingerprints_of_a_folder(printed: list[str]) -> None:
    table = pandas.read_csv("bodies.csv", index_col=0)
    assert list(table.columns) == ["ball", "cigar", "pancake"] and table.loc["ev0"].eq(0).all()
    assert table.loc["area", "ball"] == pytest.approx(12.566, rel=0.01)
    assert [line.split()[0] for line in printed] == ["area", *table.columns]


def test_gauss_bonnet(printed: list[str]) -> None:
    (line,) = printed
    assert "fsaverage5 white, left" in line and "total curvature 4.000000 pi" in line


@pytest.mark.slow
def test_gyri_and_sulci(printed: list[str]) -> None:
    regions, sign, boundary, gap = numbers(printed)
    assert 100 > regions > sign > 50 and boundary > 0 and gap <= 1e-3
    assert Path("gyri.label.gii").stat().st_size > 0


def test_map_between_bodies(printed: list[str]) -> None:
    distance, share = numbers(printed)
    assert distance < 1e-5 and share == 100 and "proved least: True" in printed[0]


def test_mesh_repair(printed: list[str]) -> None:
    words = "\n".join(printed)
    assert "1 non-manifold edges" in words and "genus 0, 643 vertices, area error 0.0e+00" in words


def test_noise_on_a_reeb_graph(printed: list[str]) -> None:
    rows = [numbers([line]) for line in printed]
    assert all(0 < lower <= upper <= largest for largest, lower, upper in rows[:-1])
    assert rows[-1] == pytest.approx([0.6, 0.6], abs=0.01) and Path("noise_on_a_reeb_graph.png").exists()


def test_part_of_a_plate(printed: list[str]) -> None:
    free, exactly, held, exactly_held, known, vertices = numbers(printed)
    assert free == pytest.approx(exactly, rel=0.005) and held == pytest.approx(exactly_held, rel=0.01)
    assert (known, vertices) == (31 * 41, 61 * 41) and all(line.endswith("True") for line in printed[:2])


@pytest.mark.slow
def test_proved_signs(printed: list[str]) -> None:
    assert printed[0] == "distance 0.1311, no signs give less than 0.1311: True"
    assert int(printed[1].split()[2]) < 200


def test_reeb_graph_of_a_patch(printed: list[str]) -> None:
    nodes, arcs, loops, farthest = numbers(printed)
    assert loops == 0 and arcs == nodes - 1 and printed[0].endswith("a chain: True") and farthest > 2.0
    assert Path("patch.graphml").exists() and Path("patch.vtk").exists()


def test_segment_an_image(printed: list[str]) -> None:
    dice, boundary, circle = numbers(printed)
    assert 0.98 <= dice <= 1.0 and 5.5 <= boundary <= 6.4 and circle == 5.76


def test_smooth_and_plot(printed: list[str]) -> None:
    before, after, change, *_ = numbers([printed[0].replace(" / mm", "")])
    assert 0 < after < before and change < 1e-9
    assert 10_000 < Path("smoothed_curvature.png").stat().st_size < 1_000_000


def test_thirty_shapes(printed: list[str]) -> None:
    places, (own, bodies) = [numbers([line]) for line in printed[:3]], numbers(printed[3:])
    assert own == bodies == 30 and len({tuple(place) for place in places}) == 3


def test_window_of_the_spectrum(printed: list[str]) -> None:
    found, counted, least, largest, residual = numbers(printed)
    assert found == counted > 0 and 20 <= least <= largest <= 30 and residual <= 1e-8
    assert printed[0].endswith("True")


def test_spectrum_of_a_solid(printed: list[str]) -> None:
    rows = np.array([numbers([line]) for line in printed[:7]])
    assert (rows[:, 0] <= rows[:, 2]).all() and (rows[:, 2] < rows[:, 1]).all()
    assert 3.9 < numbers(printed[7:8])[0] < 4.1
    small, large = printed[8].split(",")
    assert numbers([small]) == numbers([large])


def test_a_page_that_proves_itself(printed: list[str]) -> None:
    assert [line.partition(":")[0] for line in printed] == ["modes.html", "step.html"]
    assert all(0.2 < float(line.split()[1]) < 1.0 for line in printed)


@pytest.mark.slow
def test_where_groups_differ(printed: list[str]) -> None:
    *regions, last = printed
    held, beyond = numbers([last])
    assert regions and all(numbers([line])[-1] <= 0.05 for line in regions)
    assert held > 60 and beyond < 20 and Path("where_groups_differ.png").exists()


@pytest.mark.slow
def test_do_two_maps_correlate(printed: list[str]) -> None:
    r, low, high, p, observations = numbers(printed[:1])
    assert low < r < high < 0 and p < 0.01 and 50 < observations < 1000
    assert printed[1].startswith("Variograms: 400 modes hold")
    _, chance, naive = numbers(printed[2:])
    assert chance > 0.05 > 1e-4 > naive


@pytest.mark.slow
def test_coarea_formula(printed: list[str]) -> None:
    rows = np.array([numbers([line]) for line in printed[:4]])
    errors = np.abs(rows[:, 1:3] - np.pi**2)
    assert (np.diff(errors, axis=0) < 0.0).all() and errors[-1].max() < 4e-3
    before, after, error = numbers(printed[4:])
    assert before > 5 * after and abs(after - np.pi**2) < 1.0 and error < 0.1


def test_two_meshes_say_more(printed: list[str]) -> None:
    errors, orders, (vertices, one, two) = (numbers([line]) for line in printed)
    assert len(errors) == 4 and all(1.9 < order < 2.1 for order in orders)
    assert vertices == 10242 and two < 0.01 * one


def test_two_drums(printed: list[str]) -> None:
    for k, line in enumerate(printed[:4], 1):
        number, one, other = numbers([line])
        assert number == k and one == other
    # Driscoll (1997), for catheti of two; a mesh of straight elements lies above
    assert 2.5379 < numbers(printed[:1])[1] < 2.60 and 6.2 < numbers(printed[3:4])[1] < 6.7
    assert numbers(printed[4:5])[-1] < 1e-9 and numbers(printed[5:])[-1] < 1e-9


@pytest.mark.slow
def test_modes_of_a_sphere(printed: list[str]) -> None:
    own, sphere = (numbers([line])[::2] for line in printed)
    assert own == sorted(own) and sphere == sorted(sphere) and all("complete: True" in line for line in printed)
    assert 0.0 < own[-1] - sphere[-1] < 0.05


def test_hear_a_plate(printed: list[str]) -> None:
    area, exact_area, rim, exact_rim = numbers(printed[:1])
    assert area == pytest.approx(exact_area, rel=0.01) and rim == pytest.approx(exact_rim, rel=0.02)
    assert printed[0].endswith("True") and numbers(printed[1:])[-1] < 0.95 * exact_area


@pytest.mark.slow
def test_grid_around_a_cortex(printed: list[str]) -> None:
    vertices, edge = numbers(printed[:1])
    nodes = np.array([numbers([line]) for line in printed[1:4]])
    assert vertices == 10242 and 2.5 < edge < 3.5 and (np.diff(nodes[:, 1]) > 0).all() and nodes[-1, 2] > 30
    shares = [numbers([line])[1] for line in printed[4:]]
    assert shares == sorted(shares, reverse=True) and shares[-1] > 10


@pytest.mark.slow
def test_eigsh_that_misses(printed: list[str]) -> None:
    # how many runs of ARPACK fail depends on its build
    missing, runs = numbers(printed[:1])
    assert 0 < missing < runs == 153
    found, counted = numbers(printed[1:])
    assert found == counted == 64 and printed[1].endswith("True")


@pytest.mark.slow
def test_mode_k_of_two_bodies(printed: list[str]) -> None:
    first, rest = (int(number) for number in re.findall(r"for (\d+) of", printed[0]))
    before, after = numbers(printed[1:])
    assert first > 5 and rest < 12 and after > before + 0.1


@pytest.mark.slow
def test_counts_of_nodal_domains(printed: list[str]) -> None:
    most, mean, share = numbers(printed)
    assert mean < most <= 1.0 and mean < 0.69 and 60 < share < 100


def test_step_of_enhancement(printed: list[str]) -> None:
    steps, medians, largest = np.array([numbers([line]) for line in printed]).T
    assert steps.tolist() == [0.1, 0.2, 0.5, 1.0]
    assert (np.diff(medians) > 0).all() and medians[0] < 3 and largest[-1] > 50


@pytest.mark.slow
def test_length_of_a_sulcus(printed: list[str]) -> None:
    left, right = (numbers([line]) for line in printed)
    # area is in mm^2: its exponent is a number too
    assert left[0] == pytest.approx(right[0], rel=0.1) and left[-1] == pytest.approx(right[-1], rel=0.1)
    assert 100 < left[-1] < 200 and all(line.endswith("True") for line in printed)


@pytest.mark.slow
def test_distance_to_a_template(printed: list[str]) -> None:
    distances = numbers(printed[:1])
    assert len(distances) == 10 and distances[0] < 1e-3 and distances == sorted(distances)
    value, bound = numbers(printed[1:])
    assert value == bound == distances[-1] and printed[1].endswith("True")
