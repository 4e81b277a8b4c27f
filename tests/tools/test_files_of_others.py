"""A share of the dialects that other programs write, and that a difference is seen where there is one."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from audits.reliability.fuzzing import REFUSED, RIGHT, WRONG, Dialect, dialects, fuzz, judged, read_one, table
from audits.reliability.mesh_dialects import off
from audits.reliability.scene import random_scene
from audits.reliability.truth import SURFACE, Found, Truth, difference


@pytest.mark.parametrize("dialect", dialects(), ids=lambda dialect: dialect.__name__)
def test_each_dialect_is_read_as_it_was_written(dialect: Dialect, tmp_path: Path) -> None:
    for seed in range(7):
        place = tmp_path / str(seed)
        place.mkdir()
        found = read_one(dialect, seed, place, others=False)
        assert found.outcome in (RIGHT, REFUSED), (seed, found.said)


SQUARE = np.array([[0.0, 0, 0], [2, 0, 0], [2, 2, 0], [0.8, 0.4, 0], [0, 2, 0]])
TOLD = Truth(SURFACE, SQUARE, [[0, 1, 2, 3, 4]], {"a": np.arange(5.0)})
EARS = [[0, 1, 3], [1, 2, 3], [0, 3, 4]]


@pytest.mark.parametrize(
    ("found", "said"),
    [
        (Found(SQUARE, EARS, {"a": np.arange(5.0)}), ""),
        (Found(SQUARE, [[0, 1, 2], [0, 2, 3], [0, 3, 4]], {"a": np.arange(5.0)}), "lie over one another"),
        (Found(SQUARE, [face[::-1] for face in EARS]), "orientation"),
        (Found(SQUARE, EARS[:2]), "2 triangles"),
        (Found(SQUARE, [[0, 1, 3], [1, 2, 3], [0, 3, 1]]), "other corners"),
        (Found(SQUARE + 1e-9, EARS), "vertices differ"),
        (Found(SQUARE[:4], EARS), "vertices"),
        (Found(SQUARE, EARS, {"b": np.arange(5.0)}), "maps"),
        (Found(SQUARE, EARS, {"a": np.arange(5.0)[::-1]}), "other values"),
    ],
)
def test_a_difference_is_seen(found: Found, said: str) -> None:
    seen = difference(TOLD, found)
    assert said in seen and bool(said) == bool(seen)


def test_labels_and_masks_are_compared() -> None:
    told = Truth("labels", labels=["a", "b"], mask=np.array([True, False]))
    assert "1 of 2 labels differ" in difference(told, Found(labels=["a", "a"]))
    assert "2 of 2 inside" in difference(told, Found(mask=np.array([True, True])))
    assert not difference(told, Found(labels=["a", "b"], mask=np.array([True, False])))


def test_a_refusal_without_need_and_a_reading_without_right_are_wrong(tmp_path: Path) -> None:
    rng = np.random.default_rng(0)
    path, truth = off(random_scene(rng), rng, tmp_path)
    assert judged(path, replace(truth, refused="volumes")) == (WRONG, "read, though it had to be refused (volumes)")
    path.write_text("OFF\n3 1 0\n")
    outcome, said = judged(path, truth)
    assert outcome == WRONG and said.startswith("refused: a.off")
    assert judged(path, replace(truth, refused="it ends"))[0] == REFUSED


def test_scenes_repeat_and_have_concave_quadrangles() -> None:
    scenes = [random_scene(np.random.default_rng(seed)) for seed in range(20)]
    again = random_scene(np.random.default_rng(3))
    assert np.array_equal(again.vertices, scenes[3].vertices) and again.polygons == scenes[3].polygons
    assert any(not scene.triangular for scene in scenes) and any(scene.triangular for scene in scenes)
    for scene in scenes:
        assert sorted({corner for polygon in scene.polygons for corner in polygon}) == list(range(len(scene.vertices)))


def test_the_table_counts_files_and_readers() -> None:
    text = table(list(fuzz(len(dialects()), seed=3, others=False)))
    assert f"| **all** | {len(dialects())} |" in text and text.splitlines()[-1].split("|")[5].strip() == "0"
