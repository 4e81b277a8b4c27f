"""A surface made hard to recognise, for tests of invariance."""

from pydantic import Field

from surfexp.lab.registry.registry import register
from surfexp.populations.disguise import disguise

register(
    "surface",
    "disguised",
    options={
        "shuffled": Field(description="vertices in a random order"),
        "rotated": Field(description="turned in space at random"),
        "scale": Field(gt=0, le=1000000.0, description="factor of all lengths"),
        "bend": Field(ge=-6, le=6, description="roll the longest axis into an arc of this angle, radians"),
        "remeshed": Field(description="edges split and contracted, nearly no vertex stays"),
        "seed": Field(ge=0, description="seed of order and rotation"),
    },
    names={"surface": "original"},
)(disguise)
