"""Which solver solves which model, for a check before anything runs."""

from __future__ import annotations

STRONGLY_CONVEX = frozenset({"rof", "vectorial_rof"})
CONVEX = STRONGLY_CONVEX | {"inpainting", "deblurring", "convex_chan_vese", "multiphase"}
SOLVABLE_MODELS: dict[str, frozenset[str]] = {
    "primal_dual": CONVEX,
    "split_bregman": CONVEX,
    "gradient_descent": CONVEX | {"chan_vese"},
    "chambolle_dual": STRONGLY_CONVEX,
    "fista_dual": STRONGLY_CONVEX,
    "newton": frozenset({"rof"}),
    "conic": frozenset({"rof", "inpainting", "convex_chan_vese"}),
    "published_split_bregman": frozenset({"rof", "convex_chan_vese"}),
    "published_chambolle": frozenset({"rof", "convex_chan_vese"}),
    "generalised_splitting": frozenset({"tgv"}),
    "generalised_primal_dual": frozenset({"tgv"}),
}
PUBLISHED = frozenset({"rof", "convex_chan_vese"})
AVERAGED_MODELS: dict[str, frozenset[str]] = {
    "primal_dual": PUBLISHED | {"inpainting", "deblurring"},
    "split_bregman": PUBLISHED,
    "chambolle_dual": PUBLISHED,
    "published_split_bregman": PUBLISHED,
    "published_chambolle": PUBLISHED,
}


def check_combination(solver: str, model: str, consistent: bool = True) -> None:
    """Refuse a solver that does not solve a model, or not with a vertex-averaged operator.

    Parameters
    ----------
    solver, model : str
        Names as in `SOLVABLE_MODELS`.
    consistent : bool
        False for the vertex-averaged operators.

    Raises
    ------
    ValueError
        Naming the solvers that do.
    """
    table = SOLVABLE_MODELS if consistent else AVERAGED_MODELS
    known = sorted(frozenset().union(*SOLVABLE_MODELS.values()))
    if model not in known:
        raise ValueError(f"model {model!r} is unknown, choose one of {', '.join(known)}")
    able = [name for name, models in table.items() if model in models]
    if not able:
        raise ValueError(
            f"model {model!r} needs a consistent operator such as fem, the published one has no solver for it"
        )
    if solver not in able:
        where = "" if consistent else " with a vertex-averaged operator"
        raise ValueError(f"solver {solver!r} does not solve model {model!r}{where}, choose one of {', '.join(able)}")
