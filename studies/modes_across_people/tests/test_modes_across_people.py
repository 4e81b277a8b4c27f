"""Modes of two surfaces paired where the answer is known: copies, deformed copies, and shares counted by hand."""

from dataclasses import replace

import numpy as np
import pytest

from surfexp.contract.member import Member
from surfexp.embedding.mode_pairs import ModePairs
from surfexp.mesh.shape_metrics import with_metrics
from surfexp.mesh.shapes.ellipsoid import ellipsoid
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.operators.fem import fem
from surfexp.populations.synthetic_subject import synthetic_subject
from surfexp.spectrum.eigensystem import EigenSystem
from surfexp.spectrum.surface_spectrum import surface_spectrum
from surfexp_studies.modes_across_people import agreed_signs as agreed
from surfexp_studies.modes_across_people import modes_across_people
from surfexp_studies.modes_across_people.modes_across_people import modes_of_people, modes_of_twins, pooled
from surfexp_studies.modes_across_people.paired_modes import METHODS, PairedModes, pair_modes, true_pairs

COUNT = 12
points = ellipsoid(3, (1.0, 1.5, 2.5)).mesh
# without symmetry
BODY = with_metrics(
    Surface(TriangleMesh(points.vertices + 0.3 * np.sin(2.0 * points.vertices[:, [1, 2, 0]] + 0.5), points.faces))
)


def with_modes(surface: Surface) -> tuple[Surface, EigenSystem]:
    return surface, surface_spectrum(surface, fem(surface.mesh), COUNT + 11)


def twin(strain: float, seed: int = 0) -> tuple[Surface, EigenSystem]:
    return with_modes(synthetic_subject(BODY, seed, "left", strain, 2.0, remeshed=False))


ORIGINAL, COPY, BENT = with_modes(BODY), twin(0.0), twin(0.05)


def test_a_disguised_copy_has_the_same_modes_in_the_same_order() -> None:
    truth = true_pairs(ORIGINAL, COPY, COPY[0].truth.origin, COUNT)
    found = pair_modes(ORIGINAL, COPY, COUNT)
    assert truth.partners.tolist() == list(range(COUNT))
    for name in METHODS:
        assert found.methods[name].agrees(truth).all(), name
    assert found.space.agrees(truth).all()
    assert found.proved and found.leading >= 3
    assert found.signs.agrees(truth)[: found.leading].all()
    assert not found.signs.paired[found.leading :].any()


def test_blocks_of_one_are_modes_apart_on_both_surfaces() -> None:
    values = np.array([0.0, *np.cumsum(np.full(COUNT + 10, 1.0))])
    near = values.copy()
    near[6] = near[5] * 1.005
    one, other = ((BODY, replace(ORIGINAL[1], values=each)) for each in (values, near))
    found = pair_modes(one, other, COUNT)
    assert np.flatnonzero(~found.single).tolist() == [4, 5] and found.leading == 4
    # the value after the last one counts as well
    near = values.copy()
    near[COUNT + 1] = near[COUNT] * 1.005
    assert np.flatnonzero(~pair_modes(one, (BODY, replace(ORIGINAL[1], values=near)), COUNT).single).tolist() == [11]
    near = values.copy()
    near[2] = near[1] * 1.005
    assert pair_modes(one, (BODY, replace(ORIGINAL[1], values=near)), COUNT).leading == 0


def test_twins_are_rated_by_their_truth() -> None:
    twins = {Member("b", level=0.05): BENT, Member("a", level=0.0): COPY, Member("c", level=0.05): twin(0.05, 1)}
    found = modes_of_twins(ORIGINAL, twins, COUNT)
    assert found.columns["level"].tolist() == [0.0, 0.05] and found.columns["pairs"].tolist() == [1.0, 2.0]
    for name in METHODS:
        assert found.metrics[f"{name} right, level 0"] == 1.0
    assert found.metrics["itself, level 0"] == 1.0 and found.metrics["none, level 0"] == 0.0
    assert found.metrics["functional map invents, level 0"] == 0.0
    shares = [found.metrics[f"{what}, level 0.05"] for what in ("itself", "another", "none")]
    assert sum(shares) == pytest.approx(1.0) and shares[0] > 0.5
    for member in (Member("x"), Member("x", level=0.1)):
        with pytest.raises(ValueError, match="twin 'x' has no level, or does not know its vertices"):
            modes_of_twins(ORIGINAL, {member: ORIGINAL}, COUNT)


def test_a_method_that_errs_is_charged(monkeypatch: pytest.MonkeyPatch) -> None:
    """With pairs put in by hand: 4 modes of one twin, true partners 0, 2, none, 3."""
    truth = ModePairs(np.array([0, 2, -1, 3]), np.array([1, -1, 0, 1], np.int8))
    wrong = ModePairs(np.array([0, 2, 1, 3]), np.array([1, 1, 1, 1], np.int8))
    leading = ModePairs(np.array([0, 1, -1, -1]), np.array([1, -1, 0, 0], np.int8))
    methods = dict.fromkeys(METHODS, truth) | {"correlation": wrong, "functional map": wrong}
    pair = PairedModes(np.array([True, True, False, True]), 2, True, leading, methods, truth)
    monkeypatch.setattr(modes_across_people, "pair_modes", lambda *_: pair)
    monkeypatch.setattr(modes_across_people, "true_pairs", lambda *_: truth)
    rated = modes_of_twins(ORIGINAL, {Member("x", level=0.0): COPY}, 4).metrics
    assert rated["order, skewness right, level 0"] == 1.0
    assert rated["correlation right, level 0"] == pytest.approx(2 / 3)
    assert rated["functional map invents, level 0"] == 0.25
    assert rated["itself, level 0"] == 0.5 and rated["another, level 0"] == 0.25 and rated["none, level 0"] == 0.25
    assert rated["proved signs right, level 0"] == 0.5 and rated["leading modes, level 0"] == 2
    people = modes_of_people({Member(name): BODY for name in "ab"}, {Member(name): ORIGINAL[1] for name in "ab"}, 4)
    assert people.metrics["modes in blocks of one"] == 3.0 and people.metrics["pairs"] == 1.0
    assert people.columns["itself by map"].tolist() == [1, 0, 0, 1]
    assert people.columns["another by map"].tolist() == [0, 1, 1, 0]
    assert people.columns["none by space"].tolist() == [0, 0, 1, 0]
    assert people.metrics["map and space agree"] == pytest.approx(2 / 3)
    assert people.metrics["order, skewness agrees"] == 0.5
    assert people.metrics["signs proved"] == 1.0


def test_signs_are_rated_where_both_maps_agree(monkeypatch: pytest.MonkeyPatch) -> None:
    by_map = ModePairs(np.array([0, 1, 2, 4, 3]), np.array([1, -1, 1, 1, 1], np.int8))
    space = ModePairs(np.array([0, 1, 2, 4, 3]), np.array([1, -1, -1, 1, 1], np.int8))
    order = ModePairs(np.arange(5), np.array([-1, -1, 1, 1, 1], np.int8))
    # modes 0 and 1 are agreed on and lead; 2 has two signs, 3 and 4 change places
    signs = ModePairs(np.array([0, 1, 2, 3, -1]), np.array([1, -1, 1, 1, 0], np.int8))
    methods = dict.fromkeys(METHODS, order) | {"functional map": by_map}
    pair = PairedModes(np.ones(5, bool), 4, True, signs, methods, space)
    monkeypatch.setattr(agreed, "pair_modes", lambda *_: pair)
    people = {Member(name): BODY for name in "abc"}
    found = agreed.agreed_signs(people, dict.fromkeys(people, ORIGINAL[1]), 5)
    assert found.rows == ("a, b", "a, c", "b, c")
    assert found.metrics["agreed"] == 2.0 and found.metrics["proved right"] == 1.0
    assert found.metrics["order, skewness right"] == 0.5
    with pytest.raises(ValueError, match="0 subjects"):
        agreed.agreed_signs({}, {})


def test_people_are_compared_in_pairs_and_structures_are_pooled() -> None:
    owners = {Member("a"): ORIGINAL, Member("b"): COPY, Member("c"): BENT}
    done: list[tuple[int, float]] = []
    found = modes_of_people(
        {member: each[0] for member, each in owners.items()},
        {member: each[1] for member, each in owners.items()},
        COUNT,
        lambda number, left: done.append((number, left)),
    )
    assert found.metrics["pairs"] == 3 and [number for number, _ in done] == [1, 2, 3] and done[-1][1] == 0.0
    np.testing.assert_allclose(sum(found.columns[f"{what} by map"] for what in ("itself", "another", "none")), 1.0)
    assert found.metrics["itself by space, modes 1 to 10"] == pytest.approx(
        found.columns["itself by space"][:10].mean()
    )
    other = replace(found, metrics=dict.fromkeys(found.metrics, 0.0) | {"pairs": 3.0})
    other.columns.update({"single": np.zeros(COUNT)})
    both = pooled({Member("x"): found, Member("y"): other})
    assert both.metrics["pairs"] == 6.0
    single = found.columns["single"]
    np.testing.assert_allclose(both.columns["single"], np.stack([0.5 * single, 0.0 * single, single], axis=1))
    assert both.metrics["signs proved"] == pytest.approx(0.5 * found.metrics["signs proved"])
    with pytest.raises(ValueError, match="equal numbers are needed"):
        pooled({Member("x"): found, Member("y"): replace(found, metrics=found.metrics | {"pairs": 1.0})})
    with pytest.raises(ValueError, match="1 subjects, at least 2"):
        modes_of_people({Member("a"): BODY}, {Member("a"): ORIGINAL[1]})


def test_short_and_unproved_spectra_are_refused() -> None:
    with pytest.raises(ValueError, match="has 23 eigenpairs, complete True; 24 are needed"):
        pair_modes(ORIGINAL, COPY, COUNT + 1)
    with pytest.raises(ValueError, match="complete False"):
        pair_modes(ORIGINAL, (COPY[0], replace(COPY[1], complete=False)), COUNT)
