"""What a plugin takes, read from its signature: inputs by their types, everything else is an option."""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, fields, is_dataclass, replace
from typing import Annotated, Any, get_args, get_origin, get_type_hints

from pydantic import BaseModel, ConfigDict, Field, create_model
from pydantic.errors import PydanticUserError
from pydantic.fields import FieldInfo

from surfexp.contract.member import Member
from surfexp.lab.errors import UserError
from surfexp.lab.store.kinds import KINDS, kind_of, part_of

NEW_FORM = "def f(surface: Surface, *, radius: Annotated[float, Field(gt=0, description='...')] = 1.0) -> Surface"
SHAPES = {list: "list", dict: "dict", Mapping: "dict"}


class Options(BaseModel):
    """Base class of plugin options: unknown names are refused."""

    model_config = ConfigDict(extra="forbid", frozen=True, validate_default=True, allow_inf_nan=False)


@dataclass(frozen=True)
class Input:
    """One input of a plugin: the kind it asks for, how it takes results, and which part of a result, if not the whole.

    It takes one, a list, or a dict by label or by member. `group` is the parameter whose field it fills, if it does not
    stand alone.
    """

    kind: str
    shape: str
    part: str = ""
    group: str = ""


def options_and_inputs(
    where: str,
    function: Callable[..., Any],
    defaults_of: Sequence[Callable[..., Any]],
    chosen: Mapping[str, Any] | None,
    names: Mapping[str, str],
    given: Mapping[str, Any],
) -> tuple[type[BaseModel], dict[str, Input]]:
    """Options and inputs of a plugin, from the signature of its function.

    Parameters
    ----------
    where : str
        What the function is called in errors.
    function : callable
        A parameter whose annotation is the result type of a stage kind, or a list or dict of it, is an input; one that
        is `mesh: TriangleMesh` takes the mesh of the surface, role "surface"; the fields of a dataclass that holds results
        alone are inputs; every other one is an option. Its bounds and
        description stand in `Annotated[..., Field(...)]`, or its description in the docstring.
    defaults_of : sequence of callable
        Functions that hold the defaults of options without a default here, under the same name; the first that has one counts,
        and None only for an option that takes it.
    chosen : dict of str to pydantic's Field, or None
        The parameters that are options, of a function of the library: bounds, description, and a default where the function
        has none; `Annotated[type, Field(...)]` where an experiment takes less than the function. The other parameters keep
        their defaults. None: every parameter that is no input is an option, of the type it has.
    names : dict of str to str
        What an experiment calls a parameter, where the function calls it otherwise.
    given : dict of str to object
        Parameters that are neither: the plugin gives them these values.

    Returns
    -------
    options : type of BaseModel
    inputs : dict of str to Input
        By role: the name of the parameter as an experiment calls it.

    Raises
    ------
    UserError
        If a parameter is neither, the same default stands twice, or a chosen option is no parameter.
    """
    hints = get_type_hints(
        vars(function).get("__init__", function), include_extras=True
    )  # of a class, its constructor's
    described = _described(inspect.getdoc(function) or "")
    inputs, options = dict[str, Input](), dict[str, Any]()
    parameters = inspect.signature(function).parameters
    if missing := sorted({*(chosen or {}), *names, *given} - {*parameters}):
        raise UserError(
            f"{where}: {function.__name__} has no parameter {missing[0]!r}; it has: {', '.join(parameters)}"
        )
    for name, parameter in parameters.items():
        if name in given:
            continue
        shown = names.get(name, name)
        if shown in (*inputs, *options):
            raise UserError(f"{where}: two parameters are called {shown!r}")
        if parameter.kind in (parameter.VAR_KEYWORD, parameter.VAR_POSITIONAL) or name not in hints:
            raise UserError(f"{where}: parameter {name!r} must be one input or option with its type, as in {NEW_FORM}")
        hint = hints[name]
        if isinstance(hint, type) and issubclass(hint, BaseModel):
            raise UserError(
                f"{where}: options are parameters of the function, not the model {hint.__name__}: {NEW_FORM}"
            )
        if (found := _input(name, hint)) is not None:
            inputs[found.kind if found.part else shown] = found
            continue
        if grouped := _group(name, hint):
            inputs |= grouped
            continue
        if chosen is not None and name not in chosen:
            if parameter.default is parameter.empty:
                raise UserError(
                    f"{where}: parameter {name!r} of {function.__name__} has no default; name it in options="
                )
            continue
        if shown in (*KINDS, "name", "inputs"):
            raise UserError(f"{where}: option {shown!r} has the name of a stage kind or of a setting")
        if name in described:
            hint = Annotated[hint, Field(description=described[name])]
        if chosen is None:
            options[shown] = (hint, _default(where, name, parameter, hint, defaults_of))
        else:
            options[shown] = _chosen_option(where, function, parameter, hint, chosen[name])
    try:
        return create_model(function.__name__, __base__=Options, **options), inputs
    except PydanticUserError as error:
        raise UserError(
            f"{where}: {', '.join(options)}: a parameter is a stage's result or a plain value ({error})"
        ) from None


def _chosen_option(
    where: str, function: Callable[..., Any], parameter: inspect.Parameter, hint: Any, chosen: Any
) -> tuple[Any, Any]:
    """Type and default of an option of a function of the library, whose default stands in one place."""
    annotated = get_origin(chosen) is Annotated
    field = next((part for part in (*get_args(chosen), chosen) if isinstance(part, FieldInfo)), None)
    if field is None:
        raise UserError(
            f"{where}: option {parameter.name!r} is Field(...) or Annotated[type, Field(...)], not {chosen!r}"
        )
    if parameter.default is parameter.empty:
        default = field.default if not field.is_required() else ...
    elif field.is_required():
        default = parameter.default
    else:
        raise UserError(
            f"{where}: the default of {parameter.name!r} stands here and in {function.__name__}; leave it out here"
        )
    return chosen if annotated else Annotated[hint, chosen], default


def _input(name: str, hint: Any) -> Input | None:
    if (whole := part_of(name, hint)) is not None:
        return Input(whole, "one", name)
    origin, parts = get_origin(hint), get_args(hint)
    shape = "members" if origin in (dict, Mapping) and Member in parts else SHAPES.get(origin, "one")
    result = hint if shape == "one" else parts[-1]
    try:
        return Input(kind_of(result), shape)
    except (AttributeError, KeyError):
        return None


def _group(name: str, hint: Any) -> dict[str, Input]:
    """The inputs that a dataclass holds, if it holds nothing else."""
    if not (isinstance(hint, type) and is_dataclass(hint)):
        return {}
    hints = get_type_hints(hint)
    found = {field.name: _input(field.name, hints[field.name]) for field in fields(hint)}
    return {role: replace(item, group=name) for role, item in found.items() if item} if all(found.values()) else {}


def _default(
    where: str, name: str, parameter: inspect.Parameter, hint: Any, defaults_of: Sequence[Callable[..., Any]]
) -> Any:
    """The one default of an option; `...` where it is required, as where None stands for an option that takes no None."""
    known = {one.__name__: inspect.signature(one).parameters.get(name) for one in defaults_of}
    found = {one: other.default for one, other in known.items() if other and other.default is not other.empty}
    taken = get_args(hint)[0] if get_origin(hint) is Annotated else hint
    if type(None) not in get_args(taken):
        found = {one: value for one, value in found.items() if value is not None}
    if parameter.default is not parameter.empty:
        if twice := [one for one, value in found.items() if value == parameter.default]:
            raise UserError(f"{where}: the default of {name!r} stands here and in {twice[0]}; leave it out here")
        return parameter.default
    return next(iter(found.values()), ...)


def _described(docstring: str) -> dict[str, str]:
    """What the section Parameters of a numpydoc docstring says of each parameter."""
    section = re.search(r"^Parameters\n-+\n(.*?)(?=^\w[^\n]*\n-{3,}$|\Z)", docstring, re.DOTALL | re.MULTILINE)
    found = re.findall(r"^(\w+)(?: :[^\n]*)?\n((?:[ ]+\S[^\n]*\n?)+)", section[1] if section else "", re.MULTILINE)
    return {name: " ".join(text.split()) for name, text in found}
