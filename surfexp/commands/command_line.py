"""The `surfexp` command: takes its subcommand off and hands the rest to Hydra, or to a small function of its own."""

from __future__ import annotations

import os
import sys
import threading
import traceback
from collections.abc import Callable, Sequence
from importlib import import_module
from pathlib import Path

from surfexp import __version__
from surfexp.commands import processes
from surfexp.commands.error_line import error_line, tell
from surfexp.extras import MissingExtra, missing_line, missing_module
from surfexp.lab.errors import StageFailure, UserError, unknown

COMMANDS: dict[str, tuple[str, str]] = {
    "modes": ("surface_commands", "eigenpairs of a surface: surfexp modes SURFACE -k 400 --to modes.npz"),
    "denoise": ("map_commands", "a map without its noise: surfexp denoise SURFACE MAP --to clean.shape.gii"),
    "smooth": ("map_commands", "a map smoothed by heat flow: surfexp smooth SURFACE MAP --width 6mm --to FILE"),
    "segment": ("segment", "two regions, certified: surfexp segment SURFACE [MAP] --to parts.label.gii"),
    "skeleton": ("surface_commands", "the Reeb graph of a map: surfexp skeleton SURFACE [MAP] --to skeleton.vtk"),
    "distance": ("surface_commands", "spectral distance with proof: surfexp distance A B -n 20"),
    "align": ("surface_commands", "modes of B in correspondence with A's: surfexp align A B -k 50 --to FILE"),
    "fingerprint": ("fingerprint", "spectra of many as a table: surfexp fingerprint SUBJECTS_DIR -k 50 --to table.csv"),
    "geodesic": ("surface_commands", "distances from vertices: surfexp geodesic SURFACE VERTEX ... --to FILE"),
    "curvature": ("surface_commands", "mean curvature: surfexp curvature SURFACE --to FILE"),
    "convert": ("surface_commands", "another format: surfexp convert FILE FILE"),
    "plot": ("surface_commands", "a picture: surfexp plot SURFACE [MAP] --to FILE.png"),
    "check": ("mesh_quality", "the defects of meshes, or the mistakes of an experiment: surfexp check FILE ..."),
    "repair": ("mesh_quality", "a mesh without defects: surfexp repair FILE --to FILE"),
    "run": (
        "run",
        "run an experiment or a sweep, e.g. surfexp run experiment=quickstart solver=primal_dual,split_bregman",
    ),
    "plan": ("run", "what a run would do: stages, what is shared, what is done (same arguments as run)"),
    "list": ("catalogue", "the plugins of a kind, or the experiments: surfexp list [KIND | experiment]"),
    "info": (
        "catalogue",
        "options of a plugin, or what an experiment asks and cost: surfexp info KIND/NAME|EXPERIMENT",
    ),
    "table": ("views", "print the tables of an experiment again: surfexp table [EXPERIMENT]"),
    "report": ("views", "where the report page of an experiment is: surfexp report [EXPERIMENT]"),
    "open": ("open", "the page of an experiment, or the overview of all, in the browser: surfexp open [EXPERIMENT]"),
    "diff": ("diff", "in what two rows differ, options and numbers: surfexp diff RUN RUN"),
    "cite": ("cite", "what to cite for an experiment, as BibTeX: surfexp cite EXPERIMENT"),
    "export": ("export", "results as files for other programs: surfexp export EXPERIMENT|RUN --to FOLDER"),
    "ui": ("views", "open the MLflow dashboard on this machine: surfexp ui [--port N]"),
    "clean": ("clean", "remove stored results that no plan names: surfexp clean [--all] [--yes]"),
    "verify": ("verify", "hash every stored result again and name what is damaged: surfexp verify"),
    "new": ("new", "write a plugin file with its test, or an experiment: surfexp new KIND|experiment NAME"),
    "schema": ("schema", "experiments completed by an editor: surfexp schema --to FILE"),
    "view": ("view", "turn a surface in a window (needs open3d): surfexp view FILE"),
    "mesh": ("mesh", "check a mesh, or repair it: surfexp mesh check|repair FILE [--output FILE]"),
    "collect": ("collect", "an axis of your own surfaces: surfexp collect FOLDER --to NAME, then run axes=NAME"),
    "fetch": ("fetch", "get a public collection: surfexp fetch tosca [--to FOLDER]"),
    "completion": ("completion", 'what bash, zsh or fish complete: eval "$(surfexp completion bash)"'),
    "doctor": ("doctor", "versions, extras, disk; what to install where something is missing"),
}


def usage() -> str:
    """The help text of `surfexp --help`."""
    lines = [f"  {name:11} {text}" for name, (_, text) in COMMANDS.items()]
    return "\n".join(
        [
            "usage: surfexp COMMAND [ARGUMENTS]   (surfexp COMMAND --help explains one)",
            "",
            "Experiments in intrinsic surface processing, planned once, computed once, compared fairly.",
            "",
            *lines,
            "",
            "--version shows the version, --debug the traceback of an error.",
            "Exit codes: 2 a mistake in the request, 1 a failed stage, 3 a result that did not converge, 130 interrupted.",
        ]
    )


def main(arguments: Sequence[str] | None = None) -> int:
    """Entry point; returns the exit code."""
    if arguments is None and (instruction := os.environ.get("_SURFEXP_COMPLETE")):
        from surfexp.commands.completion import answer

        return answer(instruction)
    given = list(sys.argv[1:] if arguments is None else arguments)
    if "--debug" in given:
        given.remove("--debug")
        os.environ["SURFEXP_DEBUG"] = "1"
    if not given or given[0] in ("--help", "-h", "help"):
        print(usage())
        return 0
    if given[0] in ("--version", "-V"):
        print(f"surfexp {__version__}")
        return 0
    if threading.current_thread() is threading.main_thread():
        processes.end_on_signals()
    try:
        if given[0] not in COMMANDS:
            raise unknown("command", given[0], COMMANDS)
        module = import_module(f"surfexp.commands.{COMMANDS[given[0]][0]}")
        command: Callable[[str, list[str]], int | None] = module.command
        return command(given[0], given[1:]) or 0
    except KeyboardInterrupt:
        print(processes.INTERRUPTED, file=sys.stderr)
        return 130
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
        return 0
    except (UserError, StageFailure, MissingExtra, OSError) as error:
        return tell(error)
    except Exception as error:
        if isinstance(error, ImportError) and (missing := missing_module(error)):
            print(f"surfexp: {missing_line(given[0], [missing])}", file=sys.stderr)
            return 2
        if os.environ.get("SURFEXP_DEBUG"):
            raise
        where = traceback.extract_tb(error.__traceback__)[-1]
        place = f"{Path(where.filename).name}:{where.lineno}"
        what = error_line(f"unexpected {type(error).__name__} in {place}: {error}")
        print(f"surfexp: {what}; --debug shows more", file=sys.stderr)
        return 1


if __name__ == "__main__":
    sys.exit(main())
