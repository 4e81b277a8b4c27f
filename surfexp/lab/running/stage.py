"""The stage runner: one process makes one result from a plan and leaves an event record of what it took."""

from __future__ import annotations

import json
import os
import resource
import sys
import time
import traceback
from collections.abc import Mapping
from pathlib import Path
from statistics import median
from typing import Any

for _variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS"):
    os.environ.setdefault(_variable, "1")

from surfexp.contract.member import Member  # noqa: E402
from surfexp.contract.result_contract import check_result  # noqa: E402
from surfexp.lab.digests import file_digest  # noqa: E402
from surfexp.lab.errors import DamagedResult  # noqa: E402
from surfexp.lab.plan.code_digests import check_code  # noqa: E402
from surfexp.lab.plan.outcome import event_path  # noqa: E402
from surfexp.lab.plan.plan import Keys, Node, Plan, read_plan  # noqa: E402
from surfexp.lab.registry import registry  # noqa: E402
from surfexp.lab.registry.option_files import file_named  # noqa: E402
from surfexp.lab.running import compiled_code  # noqa: E402
from surfexp.lab.running.clock import clocked  # noqa: E402
from surfexp.lab.running.machine import machine  # noqa: E402
from surfexp.lab.running.planned_code import loaded_methods, read_code  # noqa: E402
from surfexp.lab.store import store  # noqa: E402
from surfexp.lab.store.kinds import KINDS  # noqa: E402

# in benchmark mode: so many calls at most, until all but the first have taken so many seconds
CALLS, ENOUGH = 10, 1.0
_progress: dict[str, Any] = {}


def report_progress(iteration: int, gap: float) -> None:
    """Progress callback for long loops: shows iteration and gap in the driver's live view, at most five times a second."""
    now = time.monotonic()
    if _progress and now - _progress["last"] > 0.2:
        _progress["last"] = now
        store.write_text(_progress["path"], f"iteration {iteration:,}, gap {gap:.1e}")


def run_stage(plan_path: Path, key: str, plan: Plan | None = None) -> int:
    """Make one result of a plan, which is read unless it is given; return 0, or 1 after recording the failure."""
    plan = plan or read_plan(plan_path, key)
    results, node = plan_path.resolve().parent.parent, plan.nodes[key]
    # numba's disk cache does not see edits in functions called from another file: one cache for each state of the code.
    compiled_code.use(node.cache)
    _progress.update(path=results / "events" / node.kind / f"{key}.progress", last=0.0, seconds=0.0)
    failure = ""
    store.write_text(_progress["path"], "started")
    try:
        read_code(plan.nodes, key)
        planned = loaded_methods(plan.nodes, key)
        check_code(planned)
        calls: list[float] = []
        while not calls or (plan.settings.timing and len(calls) < CALLS and sum(calls[1:]) < ENOUGH):
            result = make(plan.nodes, key, results)
            calls.append(_progress["seconds"])
        _progress["seconds"] = median(
            calls[1:] or calls
        )  # the first fills caches, and one clock of a short call is chance
        check_code(planned)
        store.save(results, node.kind, key, result)
    except Exception as error:
        failure = f"{node.kind}/{node.plugin}: {told(error)}"
        if os.environ.get("SURFEXP_DEBUG"):
            traceback.print_exc()
        print(failure, file=sys.stderr)
    finally:
        _progress["path"].unlink(missing_ok=True)
    event: dict[str, Any] = {"kind": node.kind, "plugin": node.plugin, "failure": failure}
    event |= {"seconds": _progress["seconds"], "alone": plan.settings.timing, "warnings": compiled_code.complaints()}
    event["machine"] = machine()
    event["peak_memory_mb"] = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
    store.write_text(event_path(results, node.kind, key), json.dumps(event, indent=1))
    return 1 if failure else 0


def told(error: Exception) -> str:
    """Return what a person is told of an error, on one line; of numba's, which are about its own types, what they come to.

    Examples
    --------
    >>> told(ValueError("weight is -1,\\n  choose a positive one")), told(KeyError()), told(KeyError("age"))
    ('weight is -1, choose a positive one', 'KeyError', "KeyError: 'age'")
    """
    kind = type(error)
    if kind.__module__.partition(".")[0] == "numba":
        return (
            "it does not compile for these inputs, as for a map of several channels where one value a vertex is needed "
            f"(numba's {kind.__name__}, which SURFEXP_DEBUG=1 shows)"
        )
    said = " ".join(str(error).split())
    # the text of a KeyError is the key alone
    return f"{kind.__name__}: {said}" if said and isinstance(error, KeyError) else said or kind.__name__


def make(nodes: Mapping[str, Node], key: str, results: Path) -> Any:
    """Call a node's plugin on its inputs: stored ones are read, the others are made here. The call alone is clocked."""
    node = nodes[key]
    registry.load_file(Path(node.file))
    method = registry.plugin(node.kind, node.plugin)

    def one(child: str) -> Any:
        kind = nodes[child].kind
        registry.load_file(Path(nodes[child].file))
        if not KINDS[kind].stored:
            return make(nodes, child, results)
        try:
            return store.load(results, kind, child)
        except DamagedResult as error:
            store.discard(results, kind, child)  # whoever runs the plan sees that it is missing and computes it again
            store.write_text(event_path(results, kind, child), json.dumps({"damage": str(error)}))
            raise

    def some(role: str, keys: Keys) -> Any:
        if not isinstance(keys, dict):
            return one(keys) if isinstance(keys, str) else [one(key) for key in keys]
        names = [Member(**facts) for facts in node.members[role]] if role in node.members else list(keys)
        return dict(zip(names, map(one, keys.values()), strict=True))

    options, inputs = node.options, {role: some(role, keys) for role, keys in node.inputs.items()}
    _check_files(node)
    with clocked() as clock:
        result = method(options, **inputs)
    _progress["seconds"] = clock.seconds
    _check_files(node)
    check_result(result, KINDS[node.kind].result)
    return result


def _check_files(node: Node) -> None:
    """Refuse input files that are not those of the plan; called before a plugin reads them and when it has."""
    for option, planned in node.files.items():
        path = Path(file_named(node.options, option))
        file_digest.cache_clear()
        if not path.exists() or file_digest(path.resolve()) != planned:
            raise RuntimeError(f"{option} {path} was changed after this run was planned; run the same command again")
