"""A surface cut to a mask: what belongs to its vertices follows, through the plugins that read files of one's own."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import surfexp as sx
from surfexp.io.label_files import write_labels
from surfexp.lab.errors import UserError
from surfexp.lab.plan.resolution import make_plan
from surfexp.lab.registry import registry
from surfexp.lab.registry.loading import load_all
from surfexp.mesh.label_map import LabelMap
from surfexp.mesh.masked_surface import cut_to_mask
from surfexp.mesh.surface import Surface, Truth

load_all(Path("/nonexistent"))
BALL = sx.shape("icosphere", levels=3)
Z = BALL.mesh.vertices[:, 2]
UPPER = Z > -0.3
NUMBERS = np.arange(len(Z))


def test_all_that_belongs_to_vertices_follows_them() -> None:
    table = LabelMap(NUMBERS % 3, {1: "one", 2: "two"})
    whole = Surface(BALL.mesh, scalars={"z": Z}, labels={"thirds": table}, truth=Truth(labels=NUMBERS), mask=UPPER)
    cut = cut_to_mask(whole, whole.mask)
    assert cut.part is not None and cut.mask is None
    kept = cut.part.vertices
    assert (cut.mesh.vertices == BALL.mesh.vertices[kept]).all() and (cut.scalars["z"] == Z[kept]).all()
    assert (cut.labels["thirds"].keys == kept % 3).all() and (cut.truth.labels == kept).all()
    assert f"keeps {len(kept)} of {len(Z)} vertices" in cut.notes[0]
    assert cut_to_mask(whole, None).part is None and cut_to_mask(whole, np.ones(len(Z))).mesh is whole.mesh


@pytest.fixture
def files(working_folder: Path) -> Path:
    sx.write("ball.surf.gii", BALL)
    np.savetxt("height.txt", Z)
    np.savetxt("partial.txt", np.where(UPPER, Z, np.nan))
    write_labels(Path("halves.label.gii"), np.where(UPPER, 1, 2), ["unknown", "upper", "lower"])
    return working_folder


def surface(**options: Any) -> Surface:
    method = registry.plugin("surface", "file")
    return method(dict(path="ball.surf.gii", **options))


def image(on: Surface, path: str) -> Any:
    method = registry.plugin("image", "file")
    return method({"path": path}, surface=on)


def test_a_file_is_cut_by_names_of_labels_and_by_what_is_known_of_a_map(files: Path) -> None:
    named = surface(mask="halves.label.gii", mask_names=["upper"], maps={"height": "height.txt"})
    known = surface(finite="partial.txt", labels={"halves": "halves.label.gii"})
    assert (named.mesh.faces == known.mesh.faces).all() and named.mesh.vertices[:, 2].min() > -0.3
    assert np.abs(named.scalars["height"] - named.mesh.vertices[:, 2]).max() < 1e-6
    assert set(known.labels["halves"].keys) == {1}
    for path in ("height.txt", "partial.txt"):  # maps of the whole file are cut alike
        assert np.abs(image(named, path).values - named.mesh.vertices[:, 2]).max() < 1e-6


def test_what_does_not_fit_is_refused_with_the_way_out(files: Path) -> None:
    with pytest.raises(ValueError, match=r"NaN at \d+ of 642 vertices: cut them away by surface\.finite=partial\.txt"):
        image(surface(), "partial.txt")
    np.savetxt("short.txt", Z[:-1])
    with pytest.raises(ValueError, match=r"short\.txt has 641 values, the surface has 642 vertices"):
        image(surface(), "short.txt")
    with pytest.raises(ValueError, match=r"short\.txt has 641 values, the surface has 642 vertices"):
        surface(finite="short.txt")


def test_every_file_of_an_option_counts_in_the_key(files: Path) -> None:
    def key(**maps: str) -> str:
        options = {"name": "file", "path": "ball.surf.gii", "maps": maps}
        plan = make_plan([{"experiment": "one", "target": "surface", "surface": options}])
        (node,) = plan.nodes.values()
        assert set(node.files) == {"path", *(f"maps.{name}" for name in maps)}
        return node.key

    first = key(height="height.txt")
    assert key(height="height.txt") == first != key(depth="height.txt")
    Path("copy.txt").write_bytes(Path("height.txt").read_bytes())
    assert key(height="copy.txt") == first  # the bytes count, not where they lie
    with pytest.raises(UserError, match=r"'missing\.txt' does not exist"):
        key(height="missing.txt")
