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
from typing import Any

for _variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS"):
    os.environ.setdefault(_variable, "1")

from surfexp.member import Member  # noqa: E402
from surfexp.workflow import registry, store  # noqa: E402
from surfexp.workflow.fingerprint import code_digest, edited_since  # noqa: E402
from surfexp.workflow.kinds import KINDS  # noqa: E402
from surfexp.workflow.plan import Keys, Node, read_plan  # noqa: E402

_progress: dict[str, Any] = {}


def report_progress(iteration: int, gap: float) -> None:
    """Progress callback for long loops: shows iteration and gap in the driver's live view, at most five times a second."""
    now = time.monotonic()
    if _progress and now - _progress["last"] > 0.2:
        _progress["last"] = now
        store.write_text(_progress["path"], f"iteration {iteration:,}, gap {gap:.1e}")


def event_path(results: Path, kind: str, key: str) -> Path:
    """Where the event record of a stage lies."""
    return results / "events" / kind / f"{key}.json"


def read_event(results: Path, kind: str, key: str) -> dict[str, Any]:
    """Event record of a stage, empty before it ran."""
    path = event_path(results, kind, key)
    return json.loads(path.read_text()) if path.exists() else {}


def run_stage(plan_path: Path, key: str) -> int:
    """Make one result; return 0, or 1 after recording the failure."""
    plan = read_plan(plan_path)
    results, node = plan_path.resolve().parent.parent, plan.nodes[key]
    # numba's disk cache does not see edits in functions called from another file: one cache for each state of the code.
    os.environ["NUMBA_CACHE_DIR"] = str(results / "cache" / "numba" / node.cache)
    _progress.update(path=results / "events" / node.kind / f"{key}.progress", last=0.0, seconds=0.0)
    failure = ""
    said: dict[str, Any] = {"metrics": {}, "notes": (), "history": {}}
    store.write_text(_progress["path"], "started")
    try:
        if edited_since(plan_path.stat().st_mtime, Path(node.file)) and code_digest(Path(node.file)) != node.code:
            raise RuntimeError("the code was edited after this run was planned; run the same command again")
        for _ in range(1 + plan.settings.timing):  # where clocks matter, the first call compiles and warms the caches
            result = make(plan.nodes, key, results)
        store.save(results, node.kind, key, result)
        said = {name: getattr(result, name, empty) for name, empty in said.items()}
    except Exception as error:
        failure = f"{node.kind}/{node.plugin}: {' '.join(str(error).split()) or type(error).__name__}"
        if os.environ.get("SURFEXP_DEBUG"):
            traceback.print_exc()
        print(failure, file=sys.stderr)
    finally:
        _progress["path"].unlink(missing_ok=True)
    event = {"kind": node.kind, "plugin": node.plugin, "seconds": _progress["seconds"], "failure": failure}
    event |= {
        "peak_memory_mb": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0,
        "metrics": {name: float(value) for name, value in said["metrics"].items()},
        "notes": said["notes"],
        "history": {name: [float(x) for x in values] for name, values in said["history"].items()},
    }
    store.write_text(event_path(results, node.kind, key), json.dumps(event, indent=1))
    return 1 if failure else 0


def make(nodes: Mapping[str, Node], key: str, results: Path) -> Any:
    """Call a node's plugin on its inputs: stored ones are read, the others are made here. The call alone is clocked."""
    node = nodes[key]
    registry.load_file(Path(node.file))
    method = registry.plugin(node.kind, node.plugin)

    def one(child: str) -> Any:
        kind = nodes[child].kind
        registry.load_file(Path(nodes[child].file))
        return store.load(results, kind, child) if KINDS[kind].stored else make(nodes, child, results)

    def some(role: str, keys: Keys) -> Any:
        if not isinstance(keys, dict):
            return one(keys) if isinstance(keys, str) else [one(key) for key in keys]
        names = [Member(**facts) for facts in node.members[role]] if role in node.members else list(keys)
        return dict(zip(names, map(one, keys.values()), strict=True))

    options, inputs = method.options(**node.options), {role: some(role, keys) for role, keys in node.inputs.items()}
    started = time.process_time()
    result = method.function(options, **inputs)
    _progress["seconds"] = time.process_time() - started
    expected = KINDS[node.kind].result
    if not isinstance(result, expected):
        raise TypeError(f"returned {type(result).__name__}, a {node.kind} plugin returns {expected.__name__}")
    return result


if __name__ == "__main__":
    # `python -m` runs this file as __main__; plugins import it by name and must find the same callback state.
    from surfexp.workflow import stage

    sys.exit(stage.run_stage(Path(sys.argv[1]), sys.argv[2]))
