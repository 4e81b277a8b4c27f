"""Signatures, distance matrices, embeddings, classifications and statistics as .csv, figures as .png, plots as .svg too."""

from __future__ import annotations

import shutil
from collections.abc import Sequence
from typing import Any

import numpy as np

from surfexp.commands.exporting.writers import Place, write, write_csv, write_metrics
from surfexp.figures.encode import encode_png
from surfexp.figures.figure import Figure
from surfexp.report.drawing import is_still
from surfexp.report.printing import DOTS_PER_INCH, as_pdf, as_png
from surfexp.spectrum.signature import Signature
from surfexp.statistics.classification import Classification
from surfexp.statistics.distance_matrix import DistanceMatrix
from surfexp.statistics.point_embedding import PointEmbedding
from surfexp.statistics.statistic import Statistic

MEMBER = ("label", "class", "group")


@write.register
def _signature(signature: Signature, place: Place) -> None:
    """One number a row, with the signature that it belongs to and its place in it."""
    parts = {signature.name or "signature": signature.values, **signature.parts}
    rows = [(name, k, number) for name, values in parts.items() for k, number in enumerate(np.ravel(values))]
    write_csv(place.file(".csv"), ("signature", "index", "value"), rows)


@write.register
def _distance_matrix(matrix: DistanceMatrix, place: Place) -> None:
    """A row and a column a member, the columns after its label, class and group."""
    facts = list(zip(matrix.labels, matrix.classes, matrix.groups, strict=True))
    rows = [(*member, *values) for member, values in zip(facts, matrix.values, strict=True)]
    write_csv(place.file(".csv"), (*MEMBER, *matrix.labels), rows)
    if matrix.coordinates is not None:
        _write_points(place, "-coordinates.csv", facts, matrix.coordinates)


@write.register
def _embedding(embedding: PointEmbedding, place: Place) -> None:
    facts = list(zip(embedding.labels, embedding.classes, embedding.groups, strict=True))
    _write_points(place, ".csv", facts, embedding.points)


def _write_points(place: Place, suffix: str, facts: Sequence[tuple[str, ...]], points: np.ndarray) -> None:
    rows = [(*member, *point) for member, point in zip(facts, points, strict=True)]
    write_csv(place.file(suffix), (*MEMBER, *(f"x{k + 1}" for k in range(points.shape[1]))), rows)


@write.register
def _classification(found: Classification, place: Place) -> None:
    """The class that each member was given, and the confusion matrix: a row a true class."""
    members = zip(found.labels, found.classes, found.groups, found.predicted, strict=True)
    write_csv(place.file(".csv"), (*MEMBER, "predicted"), members)
    rows = [(name, *counts) for name, counts in zip(found.names, found.confusion, strict=True)]
    write_csv(place.file("-confusion.csv"), ("class", *found.names), rows)


@write.register
def _statistic(statistic: Statistic, place: Place) -> None:
    """Its table, a value with its interval in three columns; without a table its metrics."""
    columns: dict[str, Any] = {}
    for name, values in statistic.columns.items():
        parts = np.asarray(values).reshape(len(values), -1).T
        columns |= {name + end: part for end, part in zip(("", ", low", ", high"), parts, strict=False)}
    if not columns:
        write_metrics(place.file(".csv"), statistic.metrics)
        return
    count = max(map(len, columns.values()))
    rows = zip(statistic.rows or range(1, count + 1), *columns.values(), strict=True)
    write_csv(place.file(".csv"), ("row", *columns), rows)


@write.register
def _figure(figure: Figure, place: Place) -> None:
    """The pixels, and the drawing of a plot; the picture of the report where that has the same bytes."""
    if figure.svg and is_still(figure.svg):
        place.file(".svg").write_text(figure.svg, encoding="utf-8")
        if place.for_print:
            place.file(".pdf").write_bytes(as_pdf(figure.svg))
            place.file(f"-{DOTS_PER_INCH}dpi.png").write_bytes(as_png(figure.svg))
    target = place.file(".png")
    if place.picture is not None:
        shutil.copyfile(place.picture, target)
    else:
        target.write_bytes(encode_png(figure.pixels))
