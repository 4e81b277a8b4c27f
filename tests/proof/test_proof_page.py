"""Pages that prove themselves: node runs their scripts, planted changes are all seen, and the numbers are those of Python."""

from __future__ import annotations

import json
import shutil
import subprocess
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner

import surfexp as sx
from surfexp.commands.all_commands import surfexp
from surfexp.proof.page import LARGEST, asset, claims_page

NODE = shutil.which("node")
needs_node = pytest.mark.skipif(NODE is None, reason="needs node")
CHECKS = Path(__file__).with_name("check_page.js")
# rows of a claim that compare bytes, not numbers that were computed
BYTES = "SHA-256"


def computed(page: Any, folder: Path, changes: list[dict[str, Any]] = []) -> dict[str, Any]:  # noqa: B006
    """Return the rows of a page's claims, as it is and after each change, by its own scripts in node."""
    file = folder / "page.html"
    page.save(file)
    found = subprocess.run(
        [str(NODE), str(CHECKS), str(file)], input=json.dumps(changes), capture_output=True, text=True, check=True
    )
    return dict(json.loads(found.stdout))


def failing(rows: list[list[dict[str, Any]]], but: str = "\0") -> list[dict[str, Any]]:
    """Return the rows that do not hold; those that begin with `but` aside."""
    return [row for claim in rows for row in claim if not row["holds"] and not row["what"].startswith(but)]


def noisy(levels: int = 2) -> tuple[Any, Any]:
    sphere = sx.shape("icosphere", levels=levels)
    x, _, z = sphere.mesh.vertices.T
    return sphere, z + (x > 0) + 0.1 * np.random.default_rng(0).standard_normal(len(x))


def bodies() -> tuple[Any, Any]:
    body = sx.shape("ellipsoid", levels=2).mesh
    other = body.vertices * [1.0, 1.1, 0.9] + 0.02 * np.sin(3.0 * body.vertices[:, [1, 2, 0]])
    return (body.vertices, body.faces), (other, body.faces)


@pytest.fixture(scope="module")
def pages() -> dict[str, Any]:
    sphere, values = noisy()
    first, second = bodies()
    return {
        "rof": sx.proof_page(sx.denoise(sphere, values, method="rof")),
        "channels": sx.proof_page(
            sx.denoise(sphere, np.stack([values, values**2], axis=1), method="rof", tolerance=1e-3)
        ),
        "newton": sx.proof_page(sx.denoise(sphere, values, method="rof", tolerance=1e-10)),
        "tgv": sx.proof_page(sx.denoise(sphere, values, method="tgv")),
        "modes": sx.proof_page(sx.eigenpairs(first, 12), first),
        "lumped": sx.proof_page(sx.eigenpairs(sphere, 16, mass="lumped"), sphere, mass="lumped"),
        "distance": sx.proof_page(sx.distance(first, second, 6), first, second),
    }


@needs_node
@pytest.mark.parametrize("name", ["rof", "channels", "newton", "tgv", "modes", "lumped", "distance"])
def test_an_untouched_page_holds_with_the_numbers_of_python(name: str, pages: dict[str, Any], tmp_path: Path) -> None:
    rows = computed(pages[name], tmp_path)["unchanged"]
    assert failing(rows) == []
    stated = {row["what"]: row for claim in rows for row in claim if "slack" in row}
    assert stated
    for row in stated.values():
        computed_here, expected = row["computed"], row["stated"]
        if row["what"].startswith("largest distance"):
            computed_here, expected = computed_here**2, expected**2  # the gap, up to a factor
        assert abs(computed_here - expected) <= 1e-12 * max(abs(expected), 1.0)


def planted(claims: tuple[Any, ...], count: int, rng: np.random.Generator) -> list[dict[str, Any]]:
    """Return changes of single numbers: of arrays, in turn, by a thousandth of their size, and of numbers of the claims."""
    places = [(k, "", name) for k, claim in enumerate(claims) for name in claim.arrays]
    skipped = (
        "tolerance",
        "shift",
        "spectra",
        "dimension",
        "weighting",
    )  # a change states another claim, which may hold
    for k, claim in enumerate(claims):
        for part in ("numbers", "stated"):
            named = getattr(claim, part)
            places += [(k, part, n) for n, v in named.items() if n not in skipped and not isinstance(v, str | bool)]
    places = [(k, part, n) for k, part, n in places if not (n == "ratio" and claims[k].numbers["model"] == "ROF")]
    changes = []
    for turn in range(count):
        k, part, name = places[turn % len(places)]
        if part:
            value = getattr(claims[k], part)[name]
            changed = value + 1 if isinstance(value, int) else value * 1.001 if abs(value) > 1e-9 else value + 1e-6
            changes.append({"claim": k, "part": part, "name": name, "value": changed})
            continue
        array = claims[k].arrays[name]
        index = int(rng.integers(array.size))
        value = array.ravel()[index]
        if np.issubdtype(array.dtype, np.integer):
            least, largest = int(array.min()), int(array.max())
            changed = int(value) + 1 if value < largest else least
        else:
            changed = float(value + 1e-3 * np.abs(array).max())
        changes.append({"claim": k, "array": name, "index": index, "value": changed})
    return changes


@needs_node
@pytest.mark.slow
def test_a_hundred_planted_changes_of_single_numbers_are_all_seen(pages: dict[str, Any], tmp_path: Path) -> None:
    rng, total, unseen, by_bytes_alone = np.random.default_rng(1), 0, [], set()
    for name, count in {"rof": 20, "channels": 12, "tgv": 20, "modes": 20, "lumped": 12, "distance": 36}.items():
        changes = planted(pages[name].claims, count, rng)
        found = computed(pages[name], tmp_path, changes)["changed"]
        for change, rows in zip(changes, found, strict=True):
            total += 1
            unseen += [] if failing(rows) else [(name, change)]
            by_bytes_alone |= set() if failing(rows, BYTES) else {change["array"]}
    assert (total, unseen) == (120, [])
    # a thousandth of a residual of 1e-11 is below the rounding of the residual
    assert by_bytes_alone <= {"residuals"}


@needs_node
def test_the_last_bit_of_any_array_is_seen_by_its_bytes(pages: dict[str, Any], tmp_path: Path) -> None:
    claim = pages["tgv"].claims[0]
    floats = {name: array for name, array in claim.arrays.items() if name != "faces"}
    changes = [
        {"claim": 0, "array": name, "index": 7, "value": float(np.nextafter(array.ravel()[7], np.inf))}
        for name, array in floats.items()
    ]
    assert all(failing(rows) for rows in computed(pages["tgv"], tmp_path, changes)["changed"])


@needs_node
def test_boundaries_holes_and_masks_are_those_of_python(tmp_path: Path) -> None:
    sphere, values = noisy()
    cap = sx.Surface(sphere.mesh, mask=sphere.mesh.vertices[:, 2] > -0.3)
    assert failing(computed(sx.proof_page(sx.denoise(cap, values, method="rof")), tmp_path)["unchanged"]) == []
    for boundary in ("neumann", "dirichlet"):
        system = sx.eigenpairs(cap, 10, boundary=boundary)
        rows = computed(sx.proof_page(system, cap, boundary=boundary), tmp_path)["unchanged"]
        assert failing(rows) == []


@needs_node
def test_a_choice_of_signs_that_is_decided_twice_is_seen(pages: dict[str, Any], tmp_path: Path) -> None:
    closed = pages["distance"].claims[2].arrays["closed"]
    places = np.flatnonzero(closed.ravel() != 0)[:12]
    changes = [{"claim": 2, "array": "closed", "index": int(k), "value": -int(closed.ravel()[k])} for k in places]
    for rows in computed(pages["distance"], tmp_path, changes)["changed"]:
        assert any("decided twice" in str(row["computed"]) for row in failing(rows, BYTES))


@needs_node
def test_the_inertia_is_that_of_dense_algebra_and_its_backward_error_is_bounded() -> None:
    rng, size, cases = np.random.default_rng(3), 40, []
    for _ in range(20):
        matrix = rng.standard_normal((size, size)) * (rng.random((size, size)) < 0.1)
        matrix = matrix + matrix.T + np.diag(3.0 * rng.standard_normal(size))
        cases.append({"matrix": matrix.tolist(), "order": rng.permutation(size).tolist()})
    script = "".join(asset(name) for name in ("arrays.js", "triangles.js", "ldlt.js")).replace('"use strict";', "")
    script += """
    const cases = JSON.parse(require("fs").readFileSync(0, "utf8"));
    console.log(JSON.stringify(cases.map(({ matrix, order }) => {
      const rows = matrix.map((row) => new Map([...row.entries()].filter(([, entry]) => entry !== 0)));
      try { return inertia(compressed(rows), Int32Array.from(order)); } catch (error) { return { stopped: error.message }; }
    })));"""
    cases.append({"matrix": [[0.0, 1.0], [1.0, 0.0]], "order": [0, 1]})
    cases.append({"matrix": [[1.0, 0.0], [0.0, 1.0]], "order": [0, 0]})
    run = subprocess.run([str(NODE), "-e", script], input=json.dumps(cases), capture_output=True, text=True, check=True)
    *found, singular, unordered = json.loads(run.stdout)
    for case, one in zip(cases, found, strict=False):
        values = np.linalg.eigvalsh(np.array(case["matrix"]))
        assert np.abs(values).min() > one["error"]
        assert one["negative"] == (values < 0).sum()
    assert "choose another shift" in singular["stopped"] and "no permutation" in unordered["stopped"]


@needs_node
def test_a_missing_pair_is_counted(tmp_path: Path) -> None:
    body = bodies()[0]
    page = sx.proof_page(sx.eigenpairs(body, 8), body)
    claim = page.claims[0]
    kept = np.delete(np.arange(8), 3)
    arrays = {
        name: array[kept] if name in ("values", "vectors", "residuals") else array
        for name, array in claim.arrays.items()
    }
    forged = type(claim)(
        claim.kind, arrays, {**claim.numbers, "certified": claim.numbers["certified"] - 1}, claim.stated
    )
    seen = failing(computed(type(page)((forged,), ""), tmp_path)["unchanged"])
    assert any("by inertia" in row["what"] for row in seen)


@needs_node
def test_an_order_of_some_rows_proves_nothing_and_no_more_pairs_are_certified_than_there_are(
    pages: dict[str, Any], tmp_path: Path
) -> None:
    """A principal submatrix has every smaller number of negative pivots at some size: the count would come out."""
    claim = pages["modes"].claims[0]
    count, certified = len(claim.arrays["order"]), claim.numbers["certified"]
    changes: list[Any] = [{"claim": 0, "array": "order", "rows": rows} for rows in (count - 1, count // 2, 1)]
    fewer = [{"claim": 0, "array": name, "rows": certified - 1} for name in ("values", "vectors", "residuals")]
    *cut, short = computed(pages["modes"], tmp_path, [*changes, fewer])["changed"]
    assert all(any("the order has" in str(row["computed"]) for row in failing(rows, BYTES)) for rows in cut)
    assert [row["what"] for row in failing(short, BYTES) if "of those that are given" in row["what"]]


@needs_node
def test_a_distance_of_more_eigenfunctions_than_there_are_or_of_other_signs_does_not_hold(
    pages: dict[str, Any], tmp_path: Path
) -> None:
    changes = [
        {"claim": 2, "part": "numbers", "name": "dimension", "value": 7},
        {"claim": 2, "array": "signs", "index": 1, "value": 0},
        {"claim": 2, "array": "signs", "index": 1, "value": 2},
    ]
    unproved, none, two = computed(pages["distance"], tmp_path, changes)["changed"]
    assert failing(unproved, BYTES)
    assert all(any("sign of 1 or -1" in row["what"] for row in failing(rows, BYTES)) for rows in (none, two))


@needs_node
def test_what_a_page_says_is_written_from_the_numbers_that_its_checks_decide(
    pages: dict[str, Any], tmp_path: Path
) -> None:
    claim, change = pages["rof"].claims[0], {"claim": 0, "part": "numbers", "name": "tolerance", "value": 1e-12}
    assert "relative gap" not in pages["rof"].html().partition("<script")[0]
    found = computed(pages["rof"], tmp_path, [change])
    ((heading, sentence),) = found["said"]
    assert heading == "The map is within a relative gap of 0.0001 of the minimum of TV(u) + mu/2 |u - f|^2"
    assert f"{claim.stated['energy']:.10g}" in sentence and f"noise {claim.numbers['noise']:.10g}" in sentence
    assert failing(found["changed"][0], BYTES)
    ((heading, sentence),) = computed(pages["modes"], tmp_path)["said"]
    certified = pages["modes"].claims[0].numbers["certified"]
    assert heading == f"The first {certified} of 12 eigenpairs are the lowest ones, and none is missing"
    assert f"exactly {certified} eigenvalues lie below" in sentence and "boundary: neumann" in sentence


@needs_node
def test_a_part_of_a_surface_says_which_rows_it_has(tmp_path: Path) -> None:
    sphere, values = noisy()
    mask = sphere.mesh.vertices[:, 2] > -0.3
    page = sx.proof_page(sx.denoise(sx.Surface(sphere.mesh, mask=mask), values, method="rof"))
    ((_, sentence),) = computed(page, tmp_path)["said"]
    arrays = page.claims[0].arrays
    assert "rows[k]" in sentence and np.array_equal(arrays["vertices"], sphere.mesh.vertices[arrays["rows"]])
    assert np.array_equal(arrays["map"], values[arrays["rows"]])
    assert "rows" not in sx.proof_page(sx.denoise(sphere, values, method="rof")).claims[0].arrays


def test_a_page_says_what_it_does_not_prove_and_loads_nothing(pages: dict[str, Any]) -> None:
    text = pages["modes"].html()
    assert "the arrays are those of your data" in text and "default-src 'none'" in text
    assert "Nothing is computed yet." in text and "http" not in text.replace("http-equiv", "")


def test_results_without_a_certificate_are_refused(tmp_path: Path) -> None:
    sphere, values = noisy()
    for result, surfaces, said in (
        (sx.smooth(sphere, values, 0.5), (), "choose method rof or tgv"),
        (sx.eigenpairs(sphere, 5), (), "give 1"),
        (sx.eigenpairs(sphere, 5, mass="lumped"), (sphere,), "give the surface, mass and boundary"),
        (sx.distance(*bodies(), 3), bodies()[::-1], "give the ones it is of"),
        (values, (), "has no certificate for a page"),
    ):
        with pytest.raises(ValueError, match=said):
            sx.proof_page(result, *surfaces)
    with pytest.raises(ValueError, match=r"choose \.html"):
        sx.proof_page(sx.denoise(sphere, values, method="rof")).save(tmp_path / "page.txt")


def test_a_pair_that_is_none_is_refused_however_right_its_value() -> None:
    """A thousandth of another mode leaves the value right to 1e-6 and the residual wrong."""
    system = sx.eigenpairs(first := bodies()[0], 12)
    vectors = system.vectors.copy()
    vectors[:, 3] += 2e-4 * vectors[:, 4]
    with pytest.raises(ValueError, match=r"residual .* from those of linear elements"):
        sx.proof_page(replace(system, vectors=vectors), first)


@needs_node
def test_a_distance_says_whether_other_signs_give_less(tmp_path: Path) -> None:
    first, second = bodies()
    found = sx.distance(first, second, 6)
    for one, said in ((found, "no other signs give less"), (replace(found, optimal=False), "no signs give less than ")):
        told = computed(sx.proof_page(one, first, second), tmp_path)
        assert failing(told["unchanged"]) == []
        starts = [heading.partition(" ")[0] for heading, _ in told["said"]]
        heading = told["said"][-1][0]
        assert starts[:2] == ["source:", "target:"] and said in heading and f"{found.value:.10g}" in heading
    assert f"{found.lower_bound:.10g}" in heading


@needs_node
def test_a_distance_that_cuts_a_cluster_says_how_many_eigenfunctions_are_proved_the_lowest(tmp_path: Path) -> None:
    """Of a ball 3, 5 and 7 are alike: the fourth is one of five."""
    ball, body = sx.shape("icosphere", levels=2), bodies()[0]
    told = computed(sx.proof_page(sx.distance(ball, body, 4), ball, body), tmp_path)
    assert failing(told["unchanged"]) == []
    assert "the first 3 of these are proved to be the lowest ones" in told["said"][-1][1]
    told = computed(sx.proof_page(sx.distance(ball, body, 3), ball, body), tmp_path)
    assert "all of these are proved to be the lowest ones" in told["said"][-1][1]


def test_a_distance_that_takes_a_browser_minutes_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    first, second = bodies()
    found = sx.distance(first, second, 3)
    monkeypatch.setattr("surfexp.tasks.proved_claims.MOST_COMPARISONS", 100.0)
    with pytest.raises(ValueError, match="a browser minutes"):
        sx.proof_page(found, first, second)


def test_a_page_above_five_megabytes_is_refused(pages: dict[str, Any]) -> None:
    claims = pages["modes"].claims
    copies = LARGEST // (len(claims_page(claims, "")) - len(claims_page((), ""))) + 2
    with pytest.raises(ValueError, match="at most 5"):
        claims_page(claims * copies, "")


def test_commands_write_the_page_beside_the_result(tmp_path: Path) -> None:
    sphere, values = noisy()
    surface, noise = str(tmp_path / "a.ply"), str(tmp_path / "map.csv")
    sx.write(surface, sphere)
    np.savetxt(noise, values)
    page, result = tmp_path / "proof.html", str(tmp_path / "result.npz")
    for given in (
        ["denoise", surface, noise, "--method", "rof", "--to", result],
        ["modes", surface, "-k", "9", "--to", result],
        ["distance", surface, surface, "-n", "3"],
    ):
        page.unlink(missing_ok=True)
        done = CliRunner().invoke(surfexp, [*given, "--proof", str(page)])
        assert done.exit_code == 0, done.output
        assert "computes the certificate again" in done.output and "Nothing is computed yet." in page.read_text()
    refused = CliRunner().invoke(
        surfexp, ["denoise", surface, noise, "--method", "auto", "--to", result, "--proof", str(page)]
    )
    assert refused.exit_code != 0 and "choose method rof or tgv" in str(refused.exception or refused.output)


def test_a_page_that_is_refused_leaves_the_result_and_one_that_must_be_refused_is_so_at_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    sphere, values = noisy()
    surface, noise, page = str(tmp_path / "a.ply"), str(tmp_path / "map.csv"), tmp_path / "proof.html"
    sx.write(surface, sphere)
    np.savetxt(noise, values)
    for command, limit in (
        (["denoise", surface, noise, "--method", "rof"], 30_000),
        (["modes", surface, "-k", "12"], 35_000),
        (["distance", surface, surface, "-n", "3"], 50_000),
    ):
        target = tmp_path / f"{command[0]}.csv" if command[0] == "distance" else tmp_path / f"{command[0]}.npz"
        whole = [*command, "--to", str(target), "--proof", str(page)]
        # above the least that its arrays take, below the page
        monkeypatch.setattr("surfexp.proof.page.LARGEST", limit)
        refused = CliRunner().invoke(surfexp, whole)
        assert "MB, at most" in str(refused.exception) and target.exists() and not page.exists(), refused.output
        target.unlink()
        if command[0] != "distance":
            monkeypatch.setattr("surfexp.proof.page.LARGEST", 5_000)
            refused = CliRunner().invoke(surfexp, whole)
            assert "MB, at most" in str(refused.exception) and not target.exists()


def test_a_window_above_the_lowest_pairs_is_no_proof_of_these() -> None:
    surface = bodies()[0]
    spectrum = sx.Spectrum(surface)
    values = spectrum.values(12)
    with pytest.raises(
        ValueError, match=r"^4 eigenvalues lie below .*, the pairs have 0 of them: give the first pairs"
    ):
        sx.proof_page(spectrum.between(0.5 * (values[3] + values[4]), 0.5 * (values[9] + values[10])), surface)
    with pytest.raises(ValueError, match="there are 0 pairs"):
        sx.proof_page(spectrum.between(0.1, 0.2), surface)
    sx.proof_page(spectrum.between(-1.0, 0.5 * (values[9] + values[10])), surface)
    sx.proof_page(spectrum.first(7), surface)


def test_a_map_of_a_path_says_what_it_lacks() -> None:
    path = sx.denoise_path(*noisy(), weights=(0.5, 2.0), tolerance=1e-2)
    with pytest.raises(ValueError, match=r"^the map after rof has no dual field.*method='rof', weight=0\.9\)$"):
        sx.proof_page(path.at(0.9))


def test_a_map_that_no_gap_was_proved_of_is_named() -> None:
    surface, values = noisy()
    with pytest.raises(ValueError, match="a map after heat has no duality gap: choose method rof or tgv"):
        sx.proof_page(sx.smooth(surface, values, 0.2, method="heat"))
