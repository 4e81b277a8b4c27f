"""Classification: separable classes, chance on labels without meaning, groups never split, retrieval by hand."""

from __future__ import annotations

import numpy as np
import pytest
from sklearn.metrics import silhouette_score

from surfexp.spectrum.signature import Signature
from surfexp.statistics.class_distances import class_distances
from surfexp.statistics.classifiers import METHODS, classify
from surfexp.statistics.distance_matrix import DistanceMatrix
from surfexp.statistics.group_power import energy_distance, group_power, p_value
from surfexp.statistics.labels import classes_of, groups_of
from surfexp.statistics.separation import retrieval, separation
from surfexp.statistics.signature_distances import euclidean, signature_distances


def collection(points: np.ndarray, labels: list[str]) -> DistanceMatrix:
    return DistanceMatrix(tuple(labels), euclidean(points), coordinates=points, name="points")


def people(classes: str = "abc", count: int = 6) -> list[str]:
    return [f"{name} @ {person} {side}" for name in classes for person in range(count) for side in ("left", "right")]


def test_labels() -> None:
    assert classes_of(["caudate @ 9861 left", "sphere"]) == ("caudate", "sphere")
    assert groups_of(["caudate @ 9861 left", "sphere"]) == ("9861", "sphere")


@pytest.mark.parametrize("method", METHODS)
def test_separable_classes_are_found(method: str) -> None:
    labels = people()
    centres = np.repeat(10.0 * np.eye(3), 12, axis=0)
    matrix = collection(centres + np.random.default_rng(0).normal(size=(36, 3)), labels)
    permutations = 4 if method == "random_forest" else 19
    found = classify(matrix, method, permutations=permutations)
    assert found.metrics["accuracy"] == 1.0 and found.predicted == matrix.classes
    assert (found.confusion == 12 * np.eye(3)).all() and found.names == ("a", "b", "c")
    assert found.metrics["p_value"] == pytest.approx(1 / (1 + permutations))
    assert found.metrics["chance"] == pytest.approx(1 / 3, abs=0.15)
    assert found.metrics["accuracy_low"] == found.metrics["accuracy_high"] == 1.0


def test_labels_without_meaning_are_at_chance() -> None:
    rng = np.random.default_rng(7)
    matrix = collection(rng.normal(size=(72, 3)), people("abc", 12))
    metrics = classify(matrix, permutations=99).metrics
    assert 0.15 < metrics["accuracy"] < 0.5 and metrics["p_value"] > 0.05
    assert metrics["accuracy_low"] < 1 / 3 < metrics["accuracy_high"]


def test_nobody_is_judged_by_their_own_other_side() -> None:
    # every person has an own place; without groups the other side gives the class away
    rng = np.random.default_rng(2)
    labels, places = people("ab", 8), []
    home = {label.split()[2] + label[0]: rng.normal(size=4) * 50 for label in labels}
    for label in labels:
        places.append(home[label.split()[2] + label[0]] + 0.01 * rng.normal(size=4))
    matrix = collection(np.array(places), labels)
    alone = DistanceMatrix(matrix.labels, matrix.values, groups=matrix.labels, coordinates=matrix.coordinates)
    assert classify(alone, permutations=0).metrics["accuracy"] == 1.0
    assert classify(matrix, permutations=0).metrics["accuracy"] < 0.9


def test_separation_agrees_with_scikit_learn() -> None:
    points, labels = np.random.default_rng(4).normal(size=(36, 3)) + np.repeat(np.eye(3), 12, axis=0), people()
    found = separation(euclidean(points), classes_of(labels))
    assert found["silhouette"] == pytest.approx(silhouette_score(points, classes_of(labels)), abs=1e-12)
    assert separation(euclidean(points), ["a"] * 36) == {}


def test_retrieval_by_hand() -> None:
    # on a line: a a b a b; from the first, answers are a b a b: precisions 1 and 2/3
    distances = euclidean(np.array([[0.0], [1.0], [2.1], [3.3], [4.6]]))
    found = retrieval(distances, list("aabab"))
    by_hand = [(1 + 2 / 3) / 2, (1 + 2 / 3) / 2, 1 / 4, (1 / 3 + 2 / 4) / 2, 1 / 2]
    assert found["mean_average_precision"] == pytest.approx(np.mean(by_hand))
    assert found["nearest_neighbour"] == pytest.approx(2 / 5)
    assert found["first_tier"] == pytest.approx(np.mean([0.5, 0.5, 0.0, 0.0, 0.0]))
    with pytest.raises(ValueError, match="nothing can be retrieved"):
        retrieval(distances, list("abcde"))


def test_weighted_distance_is_the_printed_one() -> None:
    rng = np.random.default_rng(0)
    signatures = {f"a @ {i}": Signature(rng.normal(size=9), "test", {"other": rng.normal(size=4)}) for i in range(4)}
    found = signature_distances(signatures, alpha=1.0, length=7)
    rows = np.stack([signature.values[:7] for signature in signatures.values()])
    by_hand = np.sqrt((((rows[1] - rows[3]) / np.arange(1, 8)) ** 2).sum())
    assert found.values[1, 3] == pytest.approx(by_hand) and found.coordinates.shape == (4, 7)
    assert signature_distances(signatures, "other").coordinates.shape == (4, 4)
    for words, arguments in (("no part 'nothing'", {"part": "nothing"}), ("take length <= 9", {"length": 10})):
        with pytest.raises(ValueError, match=words):
            signature_distances(signatures, **arguments)
    with pytest.raises(ValueError, match="is not finite"):
        signature_distances({**signatures, "b @ 9": Signature(np.full(9, np.nan), "test")})
    with pytest.raises(ValueError, match="at least 2"):
        signature_distances({"a @ 1": signatures["a @ 1"]})


def test_distances_between_classes() -> None:
    points = np.array([[0.0], [1.0], [10.0], [11.0], [40.0], [41.0]])
    found = class_distances(collection(points, [f"{name} @ {i}" for i, name in enumerate("aabbcc")]), "b", "a")
    assert found.rows == ("a, b", "b, c", "a, c") and found.metrics["relatives_rank"] == 1.0
    assert found.columns["distance"] == pytest.approx(np.array([10.0, 30.0, 40.0]) / (80.0 / 3.0))


def test_power_grows_with_the_group_and_false_alarms_stay_at_the_level() -> None:
    rng = np.random.default_rng(5)
    labels = [f"{name} @ {i}" for name in ("patient", "control") for i in range(24)]
    points = rng.normal(size=(48, 2)) + np.repeat([[2.4, 0.0], [0.0, 0.0]], 24, axis=0)
    found = group_power(collection(points, labels), [4, 10], draws=80, permutations=99)
    assert found.metrics["power 4"] < found.metrics["power 10"] and found.metrics["power 10"] > 0.7
    assert found.metrics["false_alarms"] < 0.12 and found.metrics["p_value"] < 0.01


def test_energy_distance_and_its_permutations() -> None:
    rng = np.random.default_rng(1)
    distances = euclidean(rng.normal(size=(12, 2)))
    first, second = np.arange(5), np.arange(5, 12)
    by_hand = 2 * distances[:5, 5:].mean() - distances[:5, :5].mean() - distances[5:, 5:].mean()
    assert energy_distance(distances, first, second) == pytest.approx(by_hand)
    values = [
        p_value(euclidean(np.random.default_rng(s).normal(size=(12, 2))), first, second, 99, rng) for s in range(60)
    ]
    assert 0.3 < np.mean(values) < 0.7


def test_unfit_collections_are_refused() -> None:
    points = np.random.default_rng(0).normal(size=(4, 2))
    with pytest.raises(ValueError, match="one class, 'a'"):
        classify(collection(points, [f"a @ {i}" for i in range(4)]))
    with pytest.raises(ValueError, match="one group"):
        classify(collection(points, ["a @ 1", "a @ 1 b", "b @ 1", "b @ 1 b"]))
    lonely = classify(collection(points, ["a @ 1", "a @ 2", "a @ 3", "b @ 4"]), permutations=0)
    assert any("b" in note and "always wrong" in note for note in lonely.notes)
    bare = DistanceMatrix(("a @ 1", "b @ 2"), np.array([[0.0, 1.0], [1.0, 0.0]]))
    with pytest.raises(ValueError, match="needs coordinates"):
        classify(bare, "random_forest")
