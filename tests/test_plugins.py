"""One contract for every registered plugin: documented options with bounds, the same bytes twice, a result of its kind."""

from __future__ import annotations

import typing
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pydantic import ValidationError
from pydantic_core import PydanticUndefined

from surfexp.contract.metric import find_metric
from surfexp.io.writing import write_mesh
from surfexp.lab.experiment.configuration import expand
from surfexp.lab.plan.outcome import read_event
from surfexp.lab.plan.resolution import make_plan
from surfexp.lab.registry import registry
from surfexp.lab.registry.loading import load_all
from surfexp.lab.running import stage
from surfexp.lab.store import store
from surfexp.lab.store.kinds import KINDS
from surfexp.mesh.shapes.icosphere import icosphere
from surfexp.report.declared import declared

load_all(Path("/nonexistent"))
PLUGINS = sorted(key for key in registry.PLUGINS if not key[1].startswith("toy_"))


def labelled(items: dict[str, dict[str, Any]]) -> list[dict[str, Any]]:
    return [{"label": label, **item} for label, item in items.items()]


SPHERE = {"name": "icosphere", "levels": 3}
GEOMETRY = {"solver": {"solver": "normal_filtering"}, "noisy": {}, "clean": {"surface": SPHERE}}
PIAL = {"template": {"surface": {"name": "labelled_fsaverage5", "sheet": "pial"}}}
# any closed surface with a concave region is a template; that of a cortex would take minutes
WORM = {"template": {"surface": {"name": "articulated", "body": "worm", "vertices": 600}}}
POPULATION = {"name": "sulcal_population", "subjects": 3, "regions": 1, "lines": False, "inputs": WORM}
LENGTHS = {"lengths": {"dataset": "blocks", "statistic": POPULATION}}
SMALL_ERROR = {"name": "spectrum_error", "low": 3, "high": 8}
RATIOS = {"reference": "weak", "baseline": "strong", "inputs": {"solutions": {"dataset": "smoothed"}}}
BODY = {"name": "ellipsoid", "levels": 3}
REBUILT = {
    "name": "mode_reconstruction",
    "twins": ["own", "shuffled"],
    "seeds": 2,
    "first": 2,
    "last": 20,
    "inputs": {"bases": {"dataset": "bases"}},
}
PEOPLE = {
    "name": "modes_of_people",
    "count": 12,
    "inputs": {"surfaces": {"dataset": "members"}, "systems": {"dataset": "members"}},
}
STRIP = {"name": "strip", "length": 14.0, "width": 4.0}
GRID = {
    "along": 8,
    "across": 3,
    "permutations": 20,
    "halvings": 2,
    "inputs": {"first": {"dataset": "strips"}, "second": {"dataset": "strips"}},
}
REJECTIONS = {
    "name": "null_rejections",
    "maps": 3,
    "nulls": 19,
    "planted_partners": 2,
    "examined": 1,
    "reach": 3.0,
    "inputs": {"sphere": {}, "image": {"image": {"name": "gaussian_fields", "length": 0.6, "count": 6}}},
}
SMALL = {
    ("surface", "cup"): {"vertices": 2500},
    ("surface", "hand"): {"count": 4000},
    ("surface", "half_double_torus"): {"count": 1500},
    ("surface", "cortex"): {"count": 10000},
    ("surface", "genus_surface"): {"count": 3000},
    ("surface", "torus"): {"n_u": 40, "n_v": 16},
    ("surface", "icosphere"): {"levels": 2},
    # plugins that take another stage of their own kind are told which
    ("surface", "noisy"): {"sigma": 0.05, "inputs": {"clean": {"surface": SPHERE}}},
    ("surface", "spherical_map"): {"inputs": {"original": {"surface": SPHERE}}},
    ("image", "coordinates"): {"inputs": {"clean": {"surface": SPHERE}}},
    ("image", "blurred"): {"inputs": {"original": {"image": "picture"}}},
    ("image", "inpainting_domain"): {"inputs": {"original": {"image": "picture"}}},
    ("solver", "conformal"): {"inputs": {"spherical": {"surface": SPHERE}}},
    ("statistic", "geometry_error"): {"inputs": GEOMETRY},
    ("statistic", "partition_energy"): {
        "inputs": {"solver": {"model": "convex_chan_vese", "solver": {"name": "primal_dual", "tolerance": 1e-3}}}
    },
    ("solver", "explicit_diffusion"): {"steps": 5},
    ("solver", "level_set"): {"points": 24},
    ("solver", "closest_point"): {"points": 24},
    ("figure", "regions"): {"inputs": {"solver": {"model": "multiphase"}}},
    ("figure", "segmentation"): {"inputs": {"solver": {"model": "convex_chan_vese"}}},
    ("figure", "parcellation"): {"inputs": {"solver": {"model": "convex_chan_vese"}}},
    ("figure", "geometry"): {
        "inputs": {**GEOMETRY, "statistic": {"statistic": {"name": "geometry_error", "inputs": GEOMETRY}}}
    },
    ("figure", "convergence"): {"inputs": {"solvers": {"dataset": "levels"}}},
    ("figure", "order"): {
        "errors": {"gradient": "gradient_error"},
        "inputs": {"statistics": {"dataset": "levels", "statistic": "operator_errors"}},
    },
    ("figure", "sweep"): {"metric": "rmse", "x_label": "level", "inputs": {"solvers": {"dataset": "levels"}}},
    ("surface", "subcortical"): {"vertices": 800},
    ("surface", "articulated"): {"vertices": 900},
    ("surface", "rectangle"): {"n_x": 20, "n_y": 14},
    ("surface", "drum"): {"divisions": 4},
    ("surface", "revolution"): {"rows": 16, "columns": 12},
    ("surface", "atrophied"): {"depth": 0.1, "inputs": {"original": {"surface": SPHERE}}},
    ("signature", "spectral"): {"count": 24},
    ("signature", "brainprint"): {"count": 20},
    ("surface", "flat_torus"): {"n": 8},
    ("distance_matrix", "signatures"): {"inputs": {"signatures": {"dataset": "members"}}},
    ("classifier", "random_forest"): {"permutations": 2},
    ("statistic", "isospectral_drums"): {"divisions": 4, "count": 8},
    ("statistic", "drum_values"): {"count": 10, "divisions": [4, 6, 8]},
    ("statistic", "torus_trend"): {"count": 40},
    ("statistic", "spectrum_error"): {"low": 3, "high": 8},
    ("statistic", "convergence_orders"): {"inputs": {"errors": {"dataset": "levels", "statistic": SMALL_ERROR}}},
    ("statistic", "count_agreement"): {
        "part": "nodal_counts",
        "inputs": {"reference": {}, "others": {"dataset": "members"}},
    },
    ("statistic", "signature_change"): {"inputs": {"reference": {}, "others": {"dataset": "members"}}},
    ("statistic", "eigenfunction_error"): {"level": 2, "count": 8},
    ("statistic", "midpoint_gain"): {"level": 1, "count": 8},
    ("statistic", "values_below"): {"level": 2, "count": 8},
    ("statistic", "narrow_band"): {"points": 24},
    ("statistic", "region_separation"): {
        "sizes": [3],
        "inputs": {
            "source_surface": {"surface": {"name": "labelled_fsaverage5"}},
            "source": {"surface": {"name": "labelled_fsaverage5"}},
            "target_surface": {"surface": {"name": "labelled_fsaverage5", "hemisphere": "right"}},
            "target": {"surface": {"name": "labelled_fsaverage5", "hemisphere": "right"}},
        },
    },
    ("statistic", "group_power"): {"sizes": [1], "draws": 10, "permutations": 19},
    ("figure", "signatures"): {"inputs": {"signatures": {"dataset": "members"}}},
    ("figure", "accuracies"): {"inputs": {"classifiers": {"dataset": "members"}}},
    ("figure", "curves"): {"x": "mode", "y": ["count"]},
    ("figure", "joint_curves"): {"x": "mode", "y": ["count"], "inputs": {"statistics": {"dataset": "members"}}},
    ("figure", "search_effort"): {"inputs": {"distances": {"dataset": "maps"}}},
    ("figure", "embedded_surfaces"): {
        "inputs": {"surfaces": {"dataset": "members"}, "systems": {"dataset": "members"}}
    },
    ("surface", "strip"): STRIP,
    ("surface", "y_patch"): {"edge_length": 0.5},
    ("surface", "callosum"): {"edge_length": 1.0, "pixel": 1.0},
    ("surface", "cingulate"): {"refine": 0},
    # a boundary is needed
    ("operator", "flux_weighted"): {"inputs": {"surface": {"surface": STRIP}}},
    ("feature", "boundary_distance"): {"inputs": {"surface": {"surface": STRIP}}},
    ("feature", "flux"): {"inputs": {"surface": {"surface": STRIP}}},
    ("feature", "scalar_map"): {
        "inputs": {"surface": {"surface": {"name": "callosum", "edge_length": 1.0, "pixel": 1.0, "signal": 1.0}}}
    },
    ("skeleton", "hamilton_jacobi"): {"inputs": {"surface": {"surface": STRIP}}},
    ("skeleton", "reeb_graph"): {"count": 8},
    ("statistic", "genus_check"): {"directions": 2, "counts": [10]},
    ("statistic", "skeleton_study"): {"count": 12, "inputs": {"surfaces": {"dataset": "strips"}}},
    ("statistic", "skeleton_topology"): {"inputs": {"skeletons": {"dataset": "levels"}}},
    ("statistic", "graph_agreement"): {"inputs": {"skeletons": {"dataset": "levels"}}},
    ("statistic", "width_test"): {
        "permutations": 20,
        "halvings": 2,
        "inputs": {"first": {"dataset": "strips"}, "second": {"dataset": "strips"}},
    },
    ("surface", "donor_cingulate"): {"edge_length": 3.0},
    ("statistic", "level_set_parametrization"): GRID,
    ("figure", "level_set_grid"): {
        "inputs": {
            "surface": {"surface": STRIP},
            "statistic": {"statistic": {"name": "level_set_parametrization", **GRID}},
        }
    },
    ("figure", "skeleton_shares"): {"inputs": {"statistics": {"dataset": "studies"}}},
    ("figure", "skeleton_group"): {"count": 12, "inputs": {"surfaces": {"dataset": "strips"}}},
    ("figure", "level_sets"): {
        "inputs": {
            "weights": {"dataset": "alphas"},
            "features": {"dataset": "alphas"},
            "skeletons": {"dataset": "alphas"},
        }
    },
    ("surface", "clover"): {"levels": 2},
    ("surface", "coarse"): {"count": 300, "inputs": {"original": {"surface": SPHERE}}},
    ("surface", "side_by_side"): {"inputs": {"original": {"surface": SPHERE}}},
    ("surface", "slivers"): {"inputs": {"original": {"surface": SPHERE}}},
    ("statistic", "missing_pairs"): {"counts": [10]},
    ("statistic", "null_rejections"): REJECTIONS,
    ("statistic", "step_decisions"): {
        "maps": 6,
        "flips": 20,
        "height": 2.0,
        "radius": 0.8,
        "inputs": {"image": {"image": {"name": "gaussian_fields", "length": 0.6, "count": 12}}},
    },
    ("statistic", "rejections_by_length"): {"inputs": {"statistics": {"dataset": "levels", "statistic": REJECTIONS}}},
    ("image", "gaussian_fields"): {"length": 0.6, "ratio": 2.0, "count": 3},
    ("statistic", "missing_by_kind"): {
        "inputs": {"statistics": {"dataset": "members", "statistic": {"name": "missing_pairs", "counts": [10]}}}
    },
    ("image", "repeated_map"): {"inputs": {"surface": {"surface": "masked_fsaverage5"}}},
    ("statistic", "carried_over_mask"): {
        "filter": "neighbour_mean",
        "inputs": {"surface": {"surface": {"name": "fsaverage5", "sheet": "white"}}},
    },
    ("statistic", "error_ratios"): RATIOS,
    ("figure", "ratio_table"): {
        "inputs": {"statistics": {"dataset": "sets", "statistic": {"name": "error_ratios"} | RATIOS}}
    },
    ("surface", "masked_by_map"): {"inputs": {"original": {"surface": {"name": "fsaverage5", "sheet": "sphere"}}}},
    ("statistic", "mode_reconstruction"): REBUILT,
    ("statistic", "reconstruction_differences"): {
        "maps": ["twin of own", "twin of shuffled"],
        "inputs": {"statistics": {"dataset": "maps", "statistic": REBUILT}},
    },
    ("figure", "difference_curves"): {"x": "mode", "differences": {"none": ("count", "count")}},
    ("statistic", "modes_of_people"): PEOPLE,
    ("statistic", "agreed_signs"): PEOPLE | {"name": "agreed_signs"},
    ("statistic", "modes_of_people_pooled"): {"inputs": {"statistics": {"dataset": "maps", "statistic": PEOPLE}}},
    ("statistic", "modes_of_twins"): {
        "count": 12,
        "inputs": {
            "surface": {"surface": BODY},
            "eigensolver": {"surface": BODY},
            "twins": {"dataset": "twins"},
            "systems": {"dataset": "twins"},
        },
    },
    ("surface", "subcortical_person"): {"vertices": 800, "change": "segmented"},
    ("surface", "cortical_person"): {"change": "half", "inputs": {"template": {"surface": SPHERE}}},
    ("signature", "fingerprint"): {"count": 60},
    ("statistic", "identification"): {
        "inputs": {"signatures": {"dataset": "seen", "signature": {"name": "fingerprint", "count": 50}}}
    },
    ("statistic", "pairwise_identification"): {
        "n": 3,
        "inputs": {"surfaces": {"dataset": "seen"}, "systems": {"dataset": "seen"}},
    },
    ("figure", "identification"): {"inputs": {"statistics": {"dataset": "recognised"}}},
    ("surface", "disguised"): {"remeshed": True, "inputs": {"original": {"surface": SPHERE}}},
    ("surface", "sulcal_regions"): {"inputs": {"original": {"surface": {"name": "fsaverage5", "sheet": "pial"}}}},
    ("figure", "embedded_regions"): {
        "inputs": {
            "source_surface": {"surface": {"name": "labelled_fsaverage5"}},
            "target_surface": {"surface": {"name": "labelled_fsaverage5", "hemisphere": "right"}},
            "distance": {
                "distance": {
                    "name": "embedding_map",
                    "n": 3,
                    "inputs": {
                        "source_surface": {"surface": {"name": "labelled_fsaverage5"}},
                        "source": {"surface": {"name": "labelled_fsaverage5"}},
                        "target_surface": {"surface": {"name": "labelled_fsaverage5", "hemisphere": "right"}},
                        "target": {"surface": {"name": "labelled_fsaverage5", "hemisphere": "right"}},
                    },
                }
            },
        }
    },
    ("distance", "mean_hausdorff"): {"n": 3},
    ("distance", "hausdorff"): {"n": 3},
    ("distance", "wasserstein"): {"n": 3, "samples": 60},
    ("distance", "spectral_icp"): {"n": 8, "samples": 200},
    ("distance", "zoomout"): {"n": 3, "last": 30, "field_modes": 20},
    ("distance", "embedding_map"): {"n": 3, "samples": 200},
    ("distance", "heat_kernel_signature"): {"n": 3},
    ("distance", "wave_kernel_signature"): {"n": 3},
    ("distance", "mirrored_space"): {"n": 3},
    ("distance", "vertex_index"): {"n": 3},
    ("distance_matrix", "pairs"): {
        "n": 3,
        "inputs": {"surfaces": {"dataset": "members"}, "systems": {"dataset": "members"}},
    },
    ("statistic", "distance_growth"): {"largest": 24},
    ("statistic", "sulci_names"): {
        "subjects": 1,
        "sizes": [3],
        "inputs": {"template": {"surface": {"name": "labelled_fsaverage5", "sheet": "pial"}}},
    },
    ("surface", "synthetic_subject"): {"inputs": PIAL},
    ("statistic", "sulcal_population"): {"subjects": 1, "regions": 1, "inputs": PIAL},
    ("statistic", "sulcal_asymmetry"): {"inputs": LENGTHS},
    ("statistic", "sulcal_power"): {"sizes": [3], "draws": 20, "inputs": LENGTHS},
    ("statistic", "sulcal_false_positives"): {"sizes": [3], "inputs": LENGTHS},
    ("statistic", "sulcal_table"): {"regions": 1, "inputs": {**PIAL, "surfaces": {"dataset": "sides"}}},
    ("statistic", "template_distances"): {"subjects": 1, "n": 6, "inputs": PIAL},
    ("statistic", "geodesic_errors"): {
        "samples": 5,
        "inputs": {
            "target_surface": {"surface": {"name": "disguised", "inputs": {"original": {"surface": SPHERE}}}},
            "maps": {"dataset": "maps"},
        },
    },
}
MEMBERS = {name: {"name": "torus", "n_v": 8, "minor_radius": minor} for name, minor in (("thin", 0.2), ("thick", 0.5))}
CONTEXT = {
    "surface": SPHERE,
    "image": {"name": "picture", "noise": 30.0},
    "operator": "fem",
    "model": "rof",
    "solver": {"name": "primal_dual", "tolerance": 1e-3},
    "eigensolver": {"name": "slicing", "count": 40},
    "signature": {"name": "spectral", "count": 24},
    "distance_matrix": {"name": "signatures", "inputs": {"signatures": {"dataset": "members"}}},
    "embedding": "classical",
    "classifier": {"name": "nearest_neighbour", "permutations": 5},
    "statistic": "nodal_trend",
    "distance": {"name": "mean_hausdorff", "n": 3},
    "feature": "height",
    "skeleton": {"name": "reeb_graph", "count": 8},
    "datasets": {
        "blocks": labelled({"from 2": {"statistic": {"first": 2}}}),
        "sides": labelled(
            {
                f"{side} anna": {
                    "class": side,
                    "group": "anna",
                    "surface": {"name": "fsaverage5", "sheet": "pial", "hemisphere": side},
                }
                for side in ("left", "right")
            }
        ),
        "bases": labelled({"shuffled": {"operator": "shuffled_lengths"}}),
        "twins": labelled(
            {
                "bent": {
                    "level": 0.05,
                    "surface": {
                        "name": "synthetic_subject",
                        "wavelength": 1.0,
                        "remeshed": False,
                        "inputs": {"template": {"surface": BODY}},
                    },
                }
            }
        ),
        "seen": labelled(
            {
                f"{change} {number}": {
                    "class": change,
                    "group": "one",
                    "level": number,
                    "surface": {"name": "ellipsoid", "levels": levels, "semiaxes": [1.0, 1.2, 1.5 + number]},
                }
                for change, levels in (("original", 3), ("half", 2))
                for number in (0, 1)
            }
        ),
        "recognised": labelled(
            {
                "shape DNA": {
                    "statistic": {
                        "name": "identification",
                        "inputs": {
                            "signatures": {"dataset": "seen", "signature": {"name": "fingerprint", "count": 50}}
                        },
                    }
                }
            }
        ),
        "maps": labelled({"near": {"distance": {"name": "embedding_map", "n": 3}}}),
        "studies": labelled(
            {
                f"alpha {alpha}": {
                    "statistic": {
                        "name": "skeleton_study",
                        "count": 12,
                        "alpha": alpha,
                        "inputs": {"surfaces": {"dataset": "strips"}},
                    }
                }
                for alpha in (0.0, 0.5)
            }
        ),
        "strips": labelled({f"strip {i}": {"surface": STRIP | {"seed": i}} for i in range(6)}),
        "smoothed": labelled(
            {
                f"{word} {seed}": {
                    "class": word,
                    "group": str(seed),
                    "image": {"name": "picture", "seed": seed},
                    "solver": solver,
                }
                for word, solver in (("weak", {"name": "heat_flow", "width": 0.1}), ("strong", {"name": "heat_flow"}))
                for seed in (1, 2)
            }
        ),
        "sets": labelled({"all": {"image": "picture"}}),
        "alphas": labelled(
            {"up": {"feature": "height"}, "aside": {"feature": {"name": "height", "direction": [1.0, 0.0, 0.0]}}}
        ),
        "levels": labelled(
            {
                f"rof {level}": {"class": "rof", "level": level, "surface": {"name": "icosphere", "levels": level}}
                for level in (2, 3)
            }
        ),
        "members": labelled(
            {
                f"{name} {i}": {"class": name, "group": i, "surface": MEMBERS[name] | {"n_u": 20 + i}}
                for name in MEMBERS
                for i in (1, 2)
            }
        ),
    },
}
NEEDS = {
    ("surface", "point_cloud"): "open3d",
    ("operator", "robust_laplacian"): "robust_laplacian",
    ("solver", "conic"): "cvxpy",
    ("signature", "brainprint"): "lapy",
    ("embedding", "umap"): "umap",
    ("surface", "conte69"): "brainspace",
    ("surface", "resting_fsaverage5"): "brainspace",
    ("image", "connectivity"): "brainspace",
}

# what a plugin asks of another kind
BESIDE: dict[tuple[str, str], dict[str, typing.Any]] = {("image", "connectivity"): {"surface": "resting_fsaverage5"}}


def configuration(kind: str, name: str, folder: Path) -> dict[str, typing.Any]:
    method = registry.plugin(kind, name)
    chosen: dict[str, typing.Any] = {"name": name, **SMALL.get((kind, name), {})}
    if "path" in method.options.model_fields and method.options.model_fields["path"].is_required():
        if kind == "surface":
            write_mesh(folder / "sphere.ply", icosphere(3).mesh)
            chosen["path"] = str(folder / "sphere.ply")
        else:
            np.save(folder / "values.npy", np.linspace(0.0, 255.0, 642))
            chosen["path"] = str(folder / "values.npy")
    context = {**CONTEXT, **BESIDE.get((kind, name), {}), kind: chosen, "target": kind}
    for needed, names in method.accepts.items():
        context[needed] = names[0]
    return context


@pytest.fixture(scope="module")
def shared(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """One results folder for all plugins: what several need, such as an operator, is made once."""
    return tmp_path_factory.mktemp("shared")


def compute(context: dict[str, typing.Any], results: Path) -> tuple[str, dict[str, bytes]]:
    """Make what is missing of a plan, its last stage in any case; return the key and the bytes of that stage."""
    plan = make_plan(expand(context))
    path, leaf = plan.write(results), plan.leaves[0]
    last = plan.nodes[leaf.key]
    store.discard(results, last.kind, last.key)
    for key, node in plan.nodes.items():
        if KINDS[node.kind].stored and not store.is_done(results, node.kind, key):
            assert stage.run_stage(path, key) == 0, read_event(results, node.kind, key)["failure"]
            known = declared(plan.nodes, key)
            measured = getattr(store.load(results, node.kind, key), "metrics", {})
            undeclared = [name for name in measured if find_metric(name, known) is None]
            assert not undeclared, f"{node.kind}/{node.plugin} does not declare {', '.join(undeclared)}"
    folder = store.result_folder(results, last.kind, last.key)
    return leaf.key, {file.name: file.read_bytes() for file in folder.iterdir()}


def test_no_plugin_is_left_out() -> None:
    assert not registry.BROKEN


def test_no_option_is_infinite_or_no_number() -> None:
    """A bound from one side lets infinity pass, and a flow of infinite time ends nowhere."""
    tried = 0
    for key in PLUGINS:
        options = registry.PLUGINS[key].options
        for name, field in options.model_fields.items():
            if field.annotation is not float:
                continue
            for value in (float("inf"), float("-inf"), float("nan")):
                with pytest.raises(ValidationError) as refused:
                    options.model_validate({name: value})
                assert name in {error["loc"][0] for error in refused.value.errors()}, (key, name, value)
            tried += 1
    assert tried > 100


@pytest.mark.parametrize(("kind", "name"), PLUGINS)
def test_options_are_documented_and_bounded(kind: str, name: str) -> None:
    method = registry.plugin(kind, name)
    assert method.summary.endswith(".") and len(method.summary) > 20
    for option, field in method.options.model_fields.items():
        assert field.description, f"{kind}/{name}.{option} has no description"
        number = field.annotation in (int, float, int | None, float | None)
        bounded = any(hasattr(rule, bound) for rule in field.metadata for bound in ("ge", "gt", "le", "lt"))
        free = {"azimuth"}
        assert not number or bounded or option in free, f"{kind}/{name}.{option} is a number without bound"
        if field.default is not PydanticUndefined and number and bounded:
            with pytest.raises(ValidationError):
                method.options(**{option: float("nan")})


@pytest.mark.parametrize(("kind", "name"), PLUGINS)
def test_declared_metrics_have_a_meaning(kind: str, name: str) -> None:
    metrics = {**getattr(KINDS[kind].result, "METRICS", {}), **registry.plugin(kind, name).metrics}
    for metric, declaration in metrics.items():
        assert declaration.meaning and declaration.better in ("", "lower", "higher"), f"{kind}/{name}: {metric}"


# a population on a whole cortex, computed twice
SULCAL = (
    "sulcal_population",
    "sulcal_false_positives",
    "sulcal_table",
    "sulci_names",
    "sulcal_asymmetry",
    "template_distances",
)
LONG = {("statistic", name) for name in SULCAL} | {("surface", "cortex")}
STORED = [
    pytest.param(*key, marks=[pytest.mark.slow] * (key in LONG) + [pytest.mark.optional] * (key in NEEDS))
    for key in PLUGINS
    if KINDS[key[0]].stored
]


@pytest.mark.parametrize(("kind", "name"), STORED)
def test_the_same_bytes_twice_and_a_result_of_its_kind(kind: str, name: str, shared: Path, tmp_path: Path) -> None:
    if (kind, name) in NEEDS:
        pytest.importorskip(NEEDS[kind, name], exc_type=ImportError)
    context = configuration(kind, name, tmp_path)
    key, first = compute(context, shared)
    _, second = compute(context, shared)
    assert first and first == second
    result = store.load(shared, kind, key)
    assert isinstance(result, KINDS[kind].result)
    assert all(np.isfinite(value) for value in result.metrics.values()), result.metrics


def solve(context: dict[str, typing.Any], results: Path) -> str:
    plan = make_plan(expand(context))
    path = plan.write(results)
    for key, node in plan.nodes.items():
        if KINDS[node.kind].stored and stage.run_stage(path, key):
            return str(read_event(results, node.kind, key)["failure"])
    return ""


def test_an_image_of_another_length_or_with_nan_is_refused(tmp_path: Path) -> None:
    np.save(tmp_path / "short.npy", np.zeros(10))
    values = np.linspace(0, 1, 642)
    values[3] = np.nan
    np.save(tmp_path / "nan.npy", values)
    for name, message in (
        ("short", "has 10 values, the surface has 642 vertices"),
        ("nan", "NaN at 1 of 642 vertices"),
    ):
        context = {**CONTEXT, "image": {"name": "file", "path": str(tmp_path / f"{name}.npy")}, "target": "image"}
        assert message in solve(context, tmp_path / name)


@pytest.mark.parametrize(
    ("spoil", "message"),
    [
        (lambda v, f: (v, f[:0]), "642 points without faces: make a surface of them first"),
        (lambda v, f: (v, np.vstack([f[1:], f[:1, ::-1]])), "surfexp repair"),
        (lambda v, f: (v, np.vstack([f, [[0, 0, 1]]])), "surfexp repair"),
        (lambda v, f: (v, np.vstack([f, [[f[0, 0], f[0, 1], len(v) - 1]]])), "surfexp repair"),
    ],
)
def test_defective_meshes_are_refused_with_the_remedy(
    spoil: typing.Callable[..., tuple[np.ndarray, np.ndarray]], message: str, tmp_path: Path
) -> None:
    mesh = icosphere(3).mesh
    vertices, faces = spoil(mesh.vertices.copy(), mesh.faces.copy())
    lines = [f"v {x} {y} {z}" for x, y, z in vertices] + [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in faces]
    (tmp_path / "bad.obj").write_text("\n".join(lines))
    context = {**CONTEXT, "surface": {"name": "file", "path": str(tmp_path / "bad.obj")}, "target": "surface"}
    failure = solve(context, tmp_path / "results")
    assert message in failure or "nan" in failure.lower(), failure


@pytest.mark.parametrize(
    ("spoil", "kept"),
    [
        (lambda v, f: (np.where(np.arange(len(v))[:, None] == 5, np.nan, v), f), 641),
        (lambda v, f: (np.vstack([v, [[9.0, 9, 9]]]), f), 642),
    ],
)
def test_vertices_that_no_method_can_use_are_cut_away(spoil: typing.Any, kept: int, tmp_path: Path) -> None:
    mesh = icosphere(3).mesh
    vertices, faces = spoil(mesh.vertices.copy(), mesh.faces)
    np.savez(tmp_path / "loose.npz", vertices=vertices, faces=faces)
    plugin = registry.plugin("surface", "file")
    surface = plugin({"path": tmp_path / "loose.npz"})
    assert len(surface.mesh.vertices) == kept and surface.part.whole_count == len(vertices) and surface.notes


def test_a_truncated_file_is_refused_by_name(tmp_path: Path) -> None:
    write_mesh(tmp_path / "sphere.ply", icosphere(3).mesh)
    content = (tmp_path / "sphere.ply").read_bytes()
    (tmp_path / "sphere.ply").write_bytes(content[: len(content) // 2])
    context = {**CONTEXT, "surface": {"name": "file", "path": str(tmp_path / "sphere.ply")}, "target": "surface"}
    assert "sphere.ply" in solve(context, tmp_path / "results")
