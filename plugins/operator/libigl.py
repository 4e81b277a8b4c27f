"""Operators assembled by libigl."""

from surfexp.lab.registry.registry import register
from surfexp.operators.libigl_operator import libigl_operator

register(
    "operator",
    "libigl",
    summary="Gradient, cotangent weights and mass from libigl; agrees with fem to rounding.",
    options={},
)(libigl_operator)
