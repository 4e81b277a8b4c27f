"""Classification: separable classes, chance on labels without meaning, groups never split, retrieval by hand."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from sklearn.metrics import silhouette_score

from surfexp.contract.member import Member
from surfexp.spectrum.signature import Signature
from surfexp.statistics.class_distances import class_distances
from surfexp.statistics.class_readings import class_readings
from surfexp.statistics.classifiers import METHODS, classify
from surfexp.statistics.distance_matrix import DistanceMatrix
from surfexp.statistics.energy_distance_test import p_value
from surfexp.statistics.group_power import group_power
from surfexp.statistics.multidimensional_scaling import classical_scaling
from surfexp.statistics.resampling import exact_interval
from surfexp.statistics.separation import retrieval, separation
from surfexp.statistics.signature_distances import euclidean, signature_distances


def member(written: str) -> Member:
    """A member from its class and group, written "class @ group detail" in these tests alone."""
    class_name, _, owner = written.partition(" @ ")
    return Member(written, class_name, owner.split()[0])


def classes_of(written: list[str]) -> list[str]:
    return [member(item).class_name for item in written]


def collection(points: np.ndarray, written: list[str]) -> DistanceMatrix:
    groups = tuple(member(item).group for item in written)
    return DistanceMatrix(tuple(written), euclidean(points), tuple(classes_of(written)), groups, points, "points")


def people(classes: str = "abc", count: int = 6) -> list[str]:
    return [f"{name} @ {person} {side}" for name in classes for person in range(count) for side in ("left", "right")]


def test_members_are_their_own_class_and_group_unless_told() -> None:
    assert Member("caudate @ 9861 left") == Member("caudate @ 9861 left", "caudate @ 9861 left", "caudate @ 9861 left")
    plain = DistanceMatrix(("a @ 1", "a @ 2"), np.zeros((2, 2)))
    assert plain.classes == plain.groups == ("a @ 1", "a @ 2")


def test_labels_decide_nothing() -> None:
    rng = np.random.default_rng(3)
    kinds = [(name, str(owner)) for name in "ab" for owner in range(5) for _ in range(2)]
    signatures = [Signature(rng.normal(size=9) + 2 * (name == "b"), "test") for name, _ in kinds]
    numbers = []
    for labels in ([f"{name} {i}" for i, (name, _) in enumerate(kinds)], [f"{i % 3} @ {i} b" for i in range(20)]):
        keys = [Member(label, *kind) for label, kind in zip(labels, kinds, strict=True)]
        matrix = signature_distances(dict(zip(keys, signatures, strict=True)))
        judged = classify(matrix, permutations=19)
        power = group_power(matrix, [3], draws=20, permutations=30)
        points = classical_scaling(matrix)
        numbers.append(
            [matrix.metrics, judged.metrics, judged.predicted, power.metrics, points.classes, points.metrics]
        )
    assert numbers[0] == numbers[1]


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
    alone = DistanceMatrix(matrix.labels, matrix.values, matrix.classes, matrix.labels, matrix.coordinates)
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


def test_weighted_distance_is_the_published_one() -> None:
    rng = np.random.default_rng(0)
    signatures = {
        Member(f"a {i}", "a"): Signature(rng.normal(size=9), "test", {"other": rng.normal(size=4)}) for i in range(4)
    }
    found = signature_distances(signatures, alpha=1.0, length=7)
    rows = np.stack([signature.values[:7] for signature in signatures.values()])
    by_hand = np.sqrt((((rows[1] - rows[3]) / np.arange(1, 8)) ** 2).sum())
    assert found.values[1, 3] == pytest.approx(by_hand) and found.coordinates.shape == (4, 7)
    assert signature_distances(signatures, "other").coordinates.shape == (4, 4)
    for words, arguments in (("no part 'nothing'", {"part": "nothing"}), ("take length <= 9", {"length": 10})):
        with pytest.raises(ValueError, match=words):
            signature_distances(signatures, **arguments)
    with pytest.raises(ValueError, match="is not finite"):
        signature_distances({**signatures, Member("b"): Signature(np.full(9, np.nan), "test")})
    with pytest.raises(ValueError, match="at least 2"):
        signature_distances({Member("a 1", "a"): signatures[Member("a 1", "a")]})


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


def energy_distance(distances: np.ndarray, first: np.ndarray, second: np.ndarray) -> float:
    """2 E|X - Y| - E|X - X'| - E|Y - Y'| over members of two groups (Szekely and Rizzo 2004)."""
    within = sum(distances[np.ix_(some, some)].mean() for some in (first, second))
    return float(2.0 * distances[np.ix_(first, second)].mean() - within)


def test_the_energy_distance_of_like_groups_has_uniform_p_values() -> None:
    rng = np.random.default_rng(1)
    first, second = np.arange(5), np.arange(5, 12)
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
    assert [note.rpartition(": ")[2] for note in lonely.notes if "always wrong" in note] == ["b."]
    known = classify(collection(points, ["a @ 1", "b @ 1", "a @ 2", "b @ 2"]), permutations=0)
    assert not any("always wrong" in note for note in known.notes)
    bare = DistanceMatrix(("a @ 1", "b @ 2"), np.array([[0.0, 1.0], [1.0, 0.0]]))
    with pytest.raises(ValueError, match="needs coordinates"):
        classify(bare, "random_forest")


def sided(count: int, seed: int) -> DistanceMatrix:
    """Two classes of `count` people each whose two sides are nearly the same; no class differs from the other."""
    rng = np.random.default_rng(seed)
    labels, points = [], []
    for name in "ab":
        for person in range(count):
            home = rng.normal(size=3)
            for side in ("left", "right"):
                labels.append(f"{name} @ {name}{person} {side}")
                points.append(home + 0.02 * rng.normal(size=3))
    return collection(np.array(points), labels)


def test_permuting_people_keeps_the_level_that_permuting_their_sides_breaks() -> None:
    hits = {"member": 0, "person": 0}
    for seed in range(120):
        matrix = sided(4, seed)
        first, second = np.arange(8), np.arange(8, 16)
        owners = np.unique(np.array(matrix.groups), return_inverse=True)[1]
        rng = np.random.default_rng(seed)
        hits["member"] += p_value(matrix.values, first, second, 199, rng) <= 0.1
        hits["person"] += p_value(matrix.values, first, second, 199, rng, owners) <= 0.1
    low, high = exact_interval(hits["person"], 120)
    assert low <= 0.1 <= high
    assert exact_interval(hits["member"], 120)[0] > 0.1


def test_all_splits_of_few_people_are_taken_once() -> None:
    matrix = sided(3, 0)
    owners = np.unique(np.array(matrix.groups), return_inverse=True)[1]
    rng = np.random.default_rng(0)
    share = p_value(matrix.values, np.arange(6), np.arange(6, 12), 199, rng, owners)
    assert share * 20 == pytest.approx(round(share * 20)) and share >= 0.1  # a split and its mirror image are alike
    best = max(
        itertools.combinations(range(6), 3),
        key=lambda some: energy_distance(
            matrix.values, *(np.flatnonzero(np.isin(owners, some) == inside) for inside in (True, False))
        ),
    )
    groups = [np.flatnonzero(np.isin(owners, best) == inside) for inside in (True, False)]
    assert p_value(matrix.values, *groups, 199, rng, owners) == pytest.approx(0.1)


def test_power_by_person_on_planted_and_equal_classes() -> None:
    labels = people("ab", 6)
    shift = np.repeat([0.0, 30.0], 12)[:, None]
    matrix = collection(shift + np.random.default_rng(1).normal(size=(24, 3)), labels)
    found = group_power(matrix, [2, 3], level=0.1, draws=60, unit="person")
    assert found.metrics["power 3"] == 1.0 and found.metrics["power 2"] == 0.0 and found.metrics["least_p"] == 0.1
    assert found.metrics["false_alarms"] == 0.1 and found.metrics["draws"] == 20.0  # one of ten splits and its mirror
    drawn = group_power(matrix, [3], level=0.1, draws=19, unit="person").metrics
    assert drawn["draws"] == 19.0 and drawn["false_alarms_low"] <= 0.1 <= drawn["false_alarms_high"]
    assert found.columns["power"][1, 1] == pytest.approx(0.025 ** (1 / 20))
    assert not found.notes and "p-value under 0.1" in group_power(matrix, [3], draws=10, unit="person").notes[0]
    with pytest.raises(ValueError, match="take at most half"):
        group_power(matrix, [4], unit="person")
    with pytest.raises(ValueError, match="choose 'member' or 'person'"):
        group_power(matrix, [2], unit="side")


def test_permuting_members_of_people_drawn_whole_raises_false_alarms() -> None:
    labels = people("ab", 6)
    own = np.repeat(np.random.default_rng(2).normal(size=(12, 3)), 2, axis=0)
    matrix = collection(own + 0.01 * np.random.default_rng(3).normal(size=(24, 3)), labels)
    by_person = group_power(matrix, [3], level=0.1, unit="person").metrics
    by_member = group_power(matrix, [3], level=0.1, unit="person", permuted="member").metrics
    assert by_person["false_alarms"] == 0.1 and by_member["false_alarms"] > 0.3
    assert by_member["draws"] == by_person["draws"] == 20.0
    assert by_member["least_p"] == pytest.approx(2.0 / 924.0) and by_person["least_p"] == 0.1
    with pytest.raises(ValueError, match="unit 'side' is unknown, choose 'member' or 'person'"):
        group_power(matrix, [2], permuted="side")


def test_exact_interval() -> None:
    assert exact_interval(0, 10) == (0.0, pytest.approx(1 - 0.025**0.1))
    assert exact_interval(10, 10) == (pytest.approx(0.025**0.1), 1.0)
    assert exact_interval(5, 10) == (pytest.approx(0.187086, abs=1e-6), pytest.approx(0.812914, abs=1e-6))


def test_readings_of_a_picture() -> None:
    places = {"cat": 0.0, "lioness": 1.0, "david": 10.0, "michael": 12.0, "centaur": 100.0}
    labels = [f"{name} @ {name}{k}" for name in places for k in range(2)]
    points = np.array([[places[label.split()[0]] + 0.01 * k] for k, label in enumerate(labels)])
    near = [("cat", "lioness"), ("michael", "david"), ("cat", "wolf")]
    found = class_readings(collection(points, labels), near, ["centaur", "wolf", "cat"])
    metrics = found.metrics
    assert metrics["rank cat, lioness"] == 1.0 and metrics["rank cat to lioness"] == 1.0
    assert metrics["rank michael, david"] == 2.0 and metrics["rank michael to david"] == 1.0
    assert metrics["remoteness centaur"] == 1.0 and metrics["remoteness cat"] == 2.0
    assert metrics["nearest centaur"] > 1.0 > metrics["nearest cat"]
    assert metrics["readings"] == 4.0 and "wolf" in found.notes[-1]
    assert "rank cat, wolf" not in metrics and "remoteness wolf" not in metrics
    absent = class_readings(collection(points[:4], labels[:4]), near[1:], ["wolf"])
    assert absent.metrics["readings"] == 0.0 and set(absent.metrics) == {"members", "classes", "readings"}


def test_as_many_neighbours_vote_as_were_asked_for() -> None:
    """On a line about x = 0: a at 1, b at 2 and 3, a at 4, a at 5. One says a, three b, five a."""
    points = np.array([0.0, 1.0, -2.0, 3.0, -4.0, 5.0, 50.0])[:, None]
    written = ["b @ own x", "a @ 1 x", "b @ 2 x", "b @ 3 x", "a @ 4 x", "a @ 5 x", "b @ 6 x"]
    said = {
        count: classify(collection(points, written), "k_nearest", count, permutations=0).predicted[0]
        for count in (1, 3, 5)
    }
    assert said == {1: "a", 3: "b", 5: "a"}
    assert classify(collection(points, written), "nearest_neighbour", permutations=0).predicted[0] == "a"
