"""Radii and loops of tubes that are known, and files of skeletons read back by other readers."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import networkx
import numpy as np
import pytest
from skimage.measure import marching_cubes

import surfexp as sx
from audits.benchmarks.nets_of_tubes import errors_of_tubes, net_of_tubes
from surfexp.commands.command_line import main
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.skeleton.export import write_skeleton
from surfexp.skeleton.radii import branch_paths, contour_radii
from surfexp.skeleton.reeb_graph import reeb_graph
from surfexp.skeleton.skeleton import Skeleton

ALONG, AROUND = 120, 24
SHARES = np.linspace(0.0, 1.0, ALONG)
# an inscribed polygon lies inside its circle: mean distance of a regular one of 24 corners
POLYGON = 1.0 - (np.pi / AROUND) ** 2 / 3.0


def bent_tube(seed: int, radius: float) -> tuple[TriangleMesh, np.ndarray]:
    """An open tube of constant radius around a random curve, and the curve."""
    waves = np.random.default_rng(seed).normal(size=(2, 3)) * [1.0, 0.5, 0.3]
    across = [sum(wave[k] * np.sin((k + 1) * np.pi * SHARES + j) for k in range(3)) for j, wave in enumerate(waves)]
    curve = np.stack([6.0 * SHARES, *across], axis=1)
    ahead = np.gradient(curve, axis=0)
    ahead /= np.linalg.norm(ahead, axis=1)[:, None]
    side = np.empty_like(curve)
    side[0] = np.cross(ahead[0], [0.3, 0.5, 0.8])
    for k in range(ALONG):
        side[k] = side[max(k - 1, 0)] - side[max(k - 1, 0)] @ ahead[k] * ahead[k]
        side[k] /= np.linalg.norm(side[k])
    angles = 2.0 * np.pi * np.arange(AROUND) / AROUND
    rings = np.cos(angles)[:, None] * side[:, None] + np.sin(angles)[:, None] * np.cross(ahead, side)[:, None]
    i, j = AROUND * np.arange(ALONG - 1)[:, None], np.arange(AROUND)[None]
    k = (j + 1) % AROUND
    faces = [np.stack([i + j, i + AROUND + j, i + AROUND + k], -1), np.stack([i + j, i + AROUND + k, i + k], -1)]
    vertices = (curve[:, None] + radius * rings).reshape(-1, 3)
    return TriangleMesh(vertices, np.concatenate([part.reshape(-1, 3) for part in faces])), curve


@pytest.mark.parametrize("radius", [0.1, 0.3])
@pytest.mark.parametrize("seed", range(4))
def test_radii_of_bent_tubes_are_known_whatever_the_map(seed: int, radius: float) -> None:
    """Contours of a height, a distance and an eigenfunction cut the tube aslant; those of its own parameter straight."""
    tube, curve = bent_tube(seed, radius)
    length = np.linalg.norm(np.diff(curve, axis=0), axis=1).sum()
    maps = {
        "parameter": np.repeat(SHARES, AROUND),
        "height": tube.vertices[:, 0],
        "distance": sx.geodesic(tube, np.arange(AROUND)),
        "eigenfunction": sx.eigenpairs(tube, 2).vectors[:, 1],
    }
    for name, values in maps.items():
        found = sx.reeb_graph(tube, values, count=40)
        table = found.branches()
        longest = int(np.argmax(table["length"]))  # a distance has a small one at the rim
        assert table["radius"][longest] == pytest.approx(radius, rel=0.02), name
    straight = sx.reeb_graph(tube, maps["parameter"], count=40)
    np.testing.assert_allclose(straight.radii[straight.kinds == 0], POLYGON * radius, rtol=5e-3)
    # its ends are vertices on the rims
    assert 0.98 * length < straight.branches()["length"][0] < 1.02 * length + 2.0 * radius


@pytest.mark.parametrize("seed", range(50))
def test_loops_are_the_rings_of_fifty_nets_of_tubes(seed: int) -> None:
    net = net_of_tubes(seed, radius=0.22, spacing=0.08)
    mesh, rings = net.mesh, net.rings
    assert mesh.component_count - mesh.euler_characteristic // 2 == rings
    values = mesh.vertices @ np.random.default_rng(seed).standard_normal(3)
    found = sx.reeb_graph(mesh, values, count=60, levels="critical")
    assert found.metrics["b1"] == rings and found.metrics["components"] == 1
    branches = found.branches()
    junctions = np.bincount(found.arcs.ravel())
    assert len(branches["length"]) - (junctions != 2).sum() + 1 == rings
    assert sum(branches["length"]) == pytest.approx(
        np.linalg.norm(found.positions[found.arcs[:, 1]] - found.positions[found.arcs[:, 0]], axis=1).sum()
    )


def test_nets_of_tubes_have_many_rings() -> None:
    rings = [net_of_tubes(seed, radius=0.22, spacing=0.08).rings for seed in range(0, 50, 5)]
    assert min(rings) < 3 and max(rings) > 5


@pytest.mark.parametrize("seed", [3, 7, 11])
def test_every_tube_of_a_net_has_its_radius_and_its_axis(seed: int) -> None:
    """Fronts from one point run along slender tubes; the mesh lies inside the tubes by half a per cent."""
    net = net_of_tubes(seed, radius=0.1, spacing=0.025)
    source = int(np.argmin(net.mesh.vertices @ [1.0, 0.3, 0.2]))
    found = sx.reeb_graph(net.mesh, sx.geodesic(net.mesh, source), count=60, levels="critical")
    contours = found.kinds == 0
    errors, offsets = errors_of_tubes(net, found.positions[contours], found.radii[contours])
    assert found.metrics["b1"] == net.rings
    assert errors.max() < 0.02 and offsets.max() < 0.1


@pytest.mark.parametrize(
    ("arcs", "paths"),
    [
        ([[0, 1], [1, 2]], [[0, 1, 2]]),
        ([[0, 1], [1, 2], [1, 3]], [[0, 1], [1, 2], [1, 3]]),
        ([[0, 1], [1, 2], [2, 0]], [[0, 1, 2, 0]]),
        ([[0, 1], [1, 2], [2, 3], [3, 1]], [[0, 1], [1, 2, 3, 1]]),
        ([], []),
    ],
)
def test_branches_of_small_graphs(arcs: list[list[int]], paths: list[list[int]]) -> None:
    assert branch_paths(np.array(arcs, dtype=np.int64).reshape(-1, 2), 4) == paths


@pytest.mark.parametrize("closed", [True, False])
def test_a_closed_contour_has_one_more_side(closed: bool) -> None:
    """Far from the middle the distance is nearly quadratic along a side, where Simpson's rule is nearly exact."""
    corners = np.array([[10.0, 0.0, 0.0], [10.0, 10.0, 0.0], [0.0, -20.0, 0.0]])
    middle, starts = np.array([[0.0, 0.0, 500.0]]), np.array([0, 3])
    found = contour_radii(middle, corners, starts, np.array([closed]), np.empty((0, 2), np.int64))
    ends = np.roll(corners, -1, axis=0)[: 3 if closed else 2]
    shares = (np.arange(1000) + 0.5)[:, None] / 1000
    sides = [start + shares * (end - start) for start, end in zip(corners, ends, strict=False)]
    lengths = [np.linalg.norm(end - start) for start, end in zip(corners, ends, strict=False)]
    means = [np.linalg.norm(side - middle, axis=1).mean() for side in sides]
    assert found[0] == pytest.approx(np.average(means, weights=lengths), rel=1e-6)


def cone() -> Skeleton:
    """A closed body of revolution whose radius is a half at height 0: caps at both ends."""
    ball = sx.shape("icosphere", levels=4).mesh
    return sx.reeb_graph(TriangleMesh(ball.vertices * [0.5, 0.5, 2.0], ball.faces), ball.vertices[:, 2], count=21)


def test_caps_have_radius_0_and_contours_that_of_an_ellipsoid() -> None:
    found = cone()
    contours = found.kinds == 0
    heights = found.positions[contours, 2] / 2.0
    np.testing.assert_allclose(found.radii[contours], 0.5 * np.sqrt(1.0 - heights**2), rtol=0.01)
    assert found.radii[~contours].tolist() == [0.0, 0.0]
    np.testing.assert_allclose(found.in_length(10.0).radii, 10.0 * found.radii, rtol=1e-12)


def forked() -> Skeleton:
    """The skeleton of a tree of tubes with one fork."""
    points = np.stack(np.meshgrid(*[np.arange(-1.6, 1.61, 0.08)] * 3, indexing="ij"), axis=-1)
    field = np.full(points.shape[:3], np.inf)
    for end, radius in (((0, 0, -1.2), 0.3), ((0.9, 0, 1.1), 0.2), ((-0.9, 0, 1.1), 0.25)):
        step = np.array(end, float)
        share = np.clip(points @ step / (step @ step), 0.0, 1.0)[..., None]
        field = np.minimum(field, np.linalg.norm(points - share * step, axis=-1) - radius)
    vertices, faces, _, _ = marching_cubes(-field, 0.0, allow_degenerate=False)
    mesh = TriangleMesh(vertices.astype(np.float64) * 0.08 - 1.6, faces[:, ::-1].astype(np.int64))
    return sx.reeb_graph(mesh, mesh.vertices[:, 2], count=40, persistence=0.05)


def test_branches_of_a_fork_have_their_radii() -> None:
    table = forked().branches()
    assert [{*ends} for ends in zip(table["from"], table["to"], strict=True)] == [{"cap", "junction"}] * 3
    np.testing.assert_allclose(sorted(table["radius"]), [0.2, 0.25, 0.3], rtol=0.02)


def rows_of_swc(path: Path) -> np.ndarray:
    """The numbers of an SWC file, as its description has them: number, type, x, y, z, radius, parent."""
    return np.array([line.split() for line in path.read_text().splitlines() if not line.startswith("#")], dtype=float)


@pytest.mark.parametrize("make", [cone, forked])
def test_an_swc_file_has_the_tree_back(tmp_path: Path, make: object) -> None:
    found = make()  # type: ignore[operator]
    sx.write(tmp_path / "s.swc", found)
    rows = rows_of_swc(tmp_path / "s.swc")
    assert (rows[:, 0] == np.arange(1, len(rows) + 1)).all() and (rows[:, 6] < rows[:, 0]).all()
    assert (rows[:, 6] == -1).sum() == 1 and rows[0, 6] == -1
    order = [int(np.flatnonzero((np.abs(found.positions - row[2:5]) < 1e-7).all(axis=1))[0]) for row in rows]
    np.testing.assert_allclose(rows[:, 5], found.radii[order], atol=1e-8)
    edges = {frozenset((order[int(row[0]) - 1], order[int(row[6]) - 1])) for row in rows[1:]}
    assert edges == {frozenset(pair) for pair in found.arcs.tolist()}


def test_two_pieces_are_two_trees(tmp_path: Path) -> None:
    ball = sx.shape("icosphere", levels=3).mesh
    n = len(ball.vertices)
    two = TriangleMesh(
        np.r_[ball.vertices, ball.vertices + np.array([3.0, 0.0, 0.5])], np.r_[ball.faces, ball.faces + n]
    )
    write_skeleton(tmp_path / "s.swc", sx.reeb_graph(two, two.vertices[:, 2], count=9))
    rows = rows_of_swc(tmp_path / "s.swc")
    assert (rows[:, 6] == -1).sum() == 2


def test_morphio_reads_the_tree(tmp_path: Path) -> None:
    morphio = pytest.importorskip("morphio")
    found = forked()
    write_skeleton(tmp_path / "s.swc", found)
    read = morphio.Morphology(str(tmp_path / "s.swc"))
    table = found.branches()
    assert len(read.sections) == len(table["length"])
    lengths = [np.linalg.norm(np.diff(one.points, axis=0), axis=1).sum() for one in read.sections]
    np.testing.assert_allclose(sorted(lengths), sorted(table["length"]), rtol=1e-5)
    np.testing.assert_allclose(
        sorted({*read.diameters.tolist()}), sorted({*np.float32(2.0 * found.radii).tolist()}), rtol=1e-5
    )


def test_a_ring_is_no_tree_and_graphml_has_it(tmp_path: Path) -> None:
    torus = sx.shape("torus")
    found = sx.reeb_graph(torus, torus.mesh.vertices[:, 0], count=20)
    with pytest.raises(ValueError, match=r"has loops \(1\), an SWC file holds trees only: choose \.graphml"):
        sx.write(tmp_path / "s.swc", found)
    assert not (tmp_path / "s.swc").exists()
    sx.write(tmp_path / "s.graphml", found)
    read = networkx.read_graphml(tmp_path / "s.graphml", node_type=int)
    assert [read.nodes[i]["radius"] for i in range(len(found.radii))] == found.radii.tolist()
    assert len(networkx.cycle_basis(networkx.Graph(read))) == 1


def test_a_skeleton_without_contours_has_no_radii(tmp_path: Path) -> None:
    ball = sx.shape("icosphere", levels=2).mesh
    found = reeb_graph(ball, ball.vertices[:, 2], np.array([0.1]))
    bare = replace(found, contour_points=np.empty((0, 3)), contour_starts=np.zeros(len(found.kinds) + 1, np.int64))
    assert np.isnan(bare.radii).all() and "radius" not in bare.graph().nodes[0]
    with pytest.raises(ValueError, match="without a radius"):
        write_skeleton(tmp_path / "s.swc", bare)


def test_the_command_writes_tree_and_branches(working_folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    sx.write("egg.ply", sx.shape("ellipsoid"))
    assert main(["skeleton", "egg.ply", "--branches", "branches.csv", "--to", "egg.swc"]) == 0
    assert Path("branches.csv").read_text().startswith("first,last,from,to,nodes,length,radius")
    assert len(rows_of_swc(Path("egg.swc"))) == 52
    sx.write("torus.ply", sx.shape("torus"))
    capsys.readouterr()
    assert main(["skeleton", "torus.ply", "--to", "torus.swc"]) == 2
    assert "choose .graphml" in capsys.readouterr().err and not Path("torus.swc.json").exists()
