"""A report whose figures turn, of results made by hand: two operators, one surface, one image."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from audits.benchmarks.synthetic_results import fill, plan_of, sweep
from surfexp.figures.figure import Figure
from surfexp.lab.plan.plan import Plan
from surfexp.lab.store import store
from surfexp.mesh.surface import Surface
from surfexp.mesh.triangle_mesh import TriangleMesh
from surfexp.report.page import write_report
from surfexp.variational.image import Image
from surfexp.variational.solution import Solution

STILL = Figure(np.full((60, 80, 3), (10, 200, 30), np.uint8), "The still picture.", "Denoising")


def torus(n_u: int, n_v: int) -> TriangleMesh:
    """A torus about the z axis with a bump, so that no view of it is like another."""
    u, v = (grid.ravel() for grid in np.meshgrid(np.arange(n_u), np.arange(n_v), indexing="ij"))
    a, b = 2 * np.pi * u / n_u, 2 * np.pi * v / n_v
    radius = 0.5 + 0.2 * np.exp(-4.0 * a**2)
    ring = 2.0 + radius * np.cos(b)
    vertices = np.stack([ring * np.cos(a), ring * np.sin(a), radius * np.sin(b)], axis=1)
    right, up = (u + 1) % n_u * n_v + v, u * n_v + (v + 1) % n_v
    both = (u + 1) % n_u * n_v + (v + 1) % n_v
    corners = u * n_v + v
    faces = np.concatenate([np.stack([corners, right, both], 1), np.stack([corners, both, up], 1)])
    return TriangleMesh(vertices, faces)


def results_of(mesh: TriangleMesh, label: str = "height") -> dict[str, Any]:
    """A surface, an image on it, and what a solver made of it, by kind."""
    height = mesh.vertices[:, 2] + 0.3 * mesh.vertices[:, 0]
    noisy = height + np.random.default_rng(0).normal(0.0, 0.1, len(height))
    image = Image(noisy, label, "mm", noise=0.1)
    return {"surface": Surface(mesh, "torus"), "image": image, "solver": Solution(height, 1.0), "figure": STILL}


def turning_plan(results: Path, made: Mapping[str, Any], **changes: Any) -> Plan:
    """A plan of two denoisings with their figures, its results stored."""
    grid = {"operator": ["fem", "vertex_averaged"]}
    plan = plan_of({**sweep(1), "grid": grid, "figures": ["denoising"], **changes}, results)
    operators = {node.key: node.plugin for node in plan.nodes.values() if node.kind == "operator"}
    for node in plan.stored:
        if node.kind in made:
            result = made[node.kind]
            if node.kind == "solver" and "vertex_averaged" in {operators.get(child) for child in node.children}:
                result = replace(result, values=0.5 * result.values)
            store.save(results, node.kind, node.key, result)
    fill(plan, results)
    return plan


def turning_page(results: Path, made: Mapping[str, Any] | None = None, **changes: Any) -> Path:
    """The report of such a plan."""
    plan = turning_plan(results, made or results_of(torus(40, 24)), **changes)
    return write_report(plan, results) / "report.html"
