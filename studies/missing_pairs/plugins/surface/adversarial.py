"""Meshes on which eigensolvers are tried."""

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.mesh.coarsening import coarse
from surfexp_studies.missing_pairs.adversarial_meshes import side_by_side, with_slivers

register(
    "surface",
    "coarse",
    options={
        "count": Field(1600, ge=20, le=1000000, description="vertices that stay"),
        "seed": Field(ge=0, description="seed of what is shaken before edges are contracted"),
        "thinnest": Field(ge=0, description="cut away where the map 'thickness' is less, mm"),
    },
    names={"surface": "original"},
)(coarse)


register(
    "surface",
    "side_by_side",
    options={
        "perturbation": Field(ge=0, le=1, description="noise on the copy, in diameters"),
        "seed": Field(ge=0, description="seed of the noise"),
    },
    names={"surface": "original"},
)(side_by_side)


register(
    "surface",
    "slivers",
    options={
        "angle": Field(0.001, gt=0, le=30, description="least angle of a sliver, degrees"),
        "share": Field(gt=0, le=1, description="share of the triangles that are flattened"),
        "seed": Field(ge=0, description="seed of the choice"),
    },
    names={"surface": "original"},
)(with_slivers)
