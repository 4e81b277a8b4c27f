"""Classifiers of shapes, each member judged by a rule that never saw its person or object."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Literal

import numpy as np

from surfexp.contract.arrays import Floats, Integers
from surfexp.statistics.classification import Classification
from surfexp.statistics.distance_matrix import DistanceMatrix
from surfexp.statistics.resampling import bootstrap_interval, permuted
from surfexp.statistics.separation import retrieval

Method = Literal["nearest_neighbour", "k_nearest", "nearest_centroid", "support_vectors", "random_forest"]
Predictor = Callable[[Integers, Integers, Integers], Integers]
METHODS = ("nearest_neighbour", "k_nearest", "nearest_centroid", "support_vectors", "random_forest")


def classify(
    matrix: DistanceMatrix,
    method: Method = "nearest_neighbour",
    neighbours: int = 3,
    permutations: int = 200,
    seed: int = 0,
) -> Classification:
    """Predict the class of every member from the members of other groups.

    Parameters
    ----------
    matrix : DistanceMatrix
        With coordinates, unless the method looks at neighbours.
    method : str
        One of `METHODS`; those that are not neighbours standardise the coordinates on the training set.
    neighbours : int
        Of "k_nearest".
    permutations : int
        Random permutations of the classes (inside groups where groups hold several classes) for the p-value; 0 for none.
    seed : int

    Returns
    -------
    Classification
        Metrics: accuracy, accuracy_low, accuracy_high (95 % bootstrap over groups), balanced_accuracy, silhouette,
        chance, p_value, and those of `retrieval`.

    Raises
    ------
    ValueError
        If there is one class, one group, or no coordinates for a method that needs them.
    """
    if method not in METHODS:
        raise ValueError(f"classifier {method!r} is unknown, choose one of {', '.join(METHODS)}")
    if method not in ("nearest_neighbour", "k_nearest") and matrix.coordinates is None:
        raise ValueError(f"{method} needs coordinates, the distances {matrix.name!r} have none: take nearest_neighbour")
    return cross_validated(matrix, _predictor(matrix, method, neighbours, seed), method, permutations, seed)


def cross_validated(
    matrix: DistanceMatrix, predict: Predictor, method: str, permutations: int = 200, seed: int = 0
) -> Classification:
    """Predict the class of every member by a rule that is given the members of the other groups alone.

    Parameters
    ----------
    matrix : DistanceMatrix
    predict : callable
        ``predict(train, labels, test)``: places (a,) of the members of other groups, their classes (a,) as numbers from 0,
        and places (b,) of the members that are asked for; returns their classes (b,) int64.
    method : str
        Name of the rule.
    permutations, seed : int
        As in `classify`.

    Returns
    -------
    Classification
        As `classify`.

    Raises
    ------
    ValueError
        If there is one class, or one group.
    """
    codes, names, owners = _coded(matrix)
    predicted = _left_out(predict, codes, owners)
    right = predicted == codes
    confusion = np.zeros((len(names), len(names)), np.int64)
    np.add.at(confusion, (codes, predicted), 1)
    rng = np.random.default_rng(seed)
    low, high = bootstrap_interval(right, owners, rng)
    metrics = {"accuracy": float(right.mean()), "accuracy_low": low, "accuracy_high": high}
    metrics["balanced_accuracy"] = float((confusion.diagonal() / confusion.sum(axis=1)).mean())
    metrics |= {name: matrix.metrics[name] for name in ("silhouette", "between_within") if name in matrix.metrics}
    if permutations:
        shuffled = [permuted(codes, owners, rng) for _ in range(permutations)]
        scores = np.array([(_left_out(predict, labels, owners) == labels).mean() for labels in shuffled])
        metrics["chance"] = float(scores.mean())
        metrics["p_value"] = float((1 + (scores >= right.mean() - 1e-12).sum()) / (1 + permutations))
    metrics |= retrieval(matrix.values, matrix.classes, matrix.groups)
    return Classification(
        labels=matrix.labels,
        classes=matrix.classes,
        groups=matrix.groups,
        predicted=tuple(names[code] for code in predicted),
        names=names,
        confusion=confusion,
        method=method,
        name=matrix.name,
        metrics=metrics,
        notes=(*matrix.notes, *_lonely(codes, owners, names)),
    )


def _left_out(predict: Predictor, codes: Integers, owners: Integers) -> Integers:
    predicted = np.empty_like(codes)
    for owner in range(int(owners.max()) + 1):
        test, train = np.flatnonzero(owners == owner), np.flatnonzero(owners != owner)
        predicted[test] = predict(train, codes[train], test)
    return predicted


def _predictor(matrix: DistanceMatrix, method: str, neighbours: int, seed: int) -> Predictor:
    distances, points = matrix.values, matrix.coordinates
    if method in ("nearest_neighbour", "k_nearest"):
        count = 1 if method == "nearest_neighbour" else neighbours

        def near(train: Integers, labels: Integers, test: Integers) -> Integers:
            order = np.argsort(distances[np.ix_(test, train)], axis=1, kind="stable")[:, :count]
            classes = np.eye(int(labels.max()) + 1)
            # the nearest one decides between classes of equal votes
            votes = classes[labels[order]].sum(axis=1) + 0.5 * classes[labels[order[:, 0]]]
            return np.asarray(votes.argmax(axis=1))

        return near
    assert points is not None  # noqa: S101, narrows a type

    def fitted(train: Integers, labels: Integers, test: Integers) -> Integers:
        if len(np.unique(labels)) == 1:
            return np.full(len(test), labels[0])
        centre, spread = points[train].mean(axis=0), points[train].std(axis=0)
        scaled = (points - centre) / np.where(spread > 0, spread, 1.0)
        if method == "nearest_centroid":
            return _nearest_centroid(scaled[train], labels, scaled[test])
        return np.asarray(_model(method, seed).fit(scaled[train], labels).predict(scaled[test]))

    return fitted


def _nearest_centroid(train: Floats, labels: Integers, test: Floats) -> Integers:
    names = np.unique(labels)
    centroids = np.stack([train[labels == name].mean(axis=0) for name in names])
    distances = np.linalg.norm(test[:, None] - centroids[None], axis=2)
    return np.asarray(names[distances.argmin(axis=1)])


def _model(method: str, seed: int) -> Any:
    if method == "support_vectors":
        from sklearn.svm import SVC

        return SVC(C=10.0, kernel="rbf", gamma="scale")
    from sklearn.ensemble import RandomForestClassifier

    return RandomForestClassifier(60, random_state=seed, n_jobs=1)


def _coded(matrix: DistanceMatrix) -> tuple[Integers, tuple[str, ...], Integers]:
    names, codes = np.unique(np.asarray(matrix.classes), return_inverse=True)
    owners = np.unique(np.asarray(matrix.groups), return_inverse=True)[1]
    if len(names) < 2:
        raise ValueError(f"the collection has one class, {str(names[0])!r}: a classifier needs at least 2")
    if owners.max() < 1:
        raise ValueError("all members belong to one group: grouped validation needs at least 2")
    return codes.astype(np.int64), tuple(str(name) for name in names), owners.astype(np.int64)


def _lonely(codes: Integers, owners: Integers, names: tuple[str, ...]) -> tuple[str, ...]:
    alone = [names[c] for c in range(len(names)) if len(np.unique(owners[codes == c])) < 2]
    if not alone:
        return ()
    return (f"Classes found in one group only are always wrong when it is left out: {', '.join(alone)}.",)
