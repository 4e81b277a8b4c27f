"""All commands as one group, which imports the module of a command when it is called."""

from __future__ import annotations

from importlib import import_module
from typing import NamedTuple

import click
from click.shell_completion import CompletionItem

from surfexp import __version__
from surfexp.commands.terminal import echo
from surfexp.lab.errors import UserError, unknown
from surfexp.lab.memory_limit import LEAST_FOR_NUMERICS, LEAST_FOR_RUNS, require_memory


class Entry(NamedTuple):
    """Where a command is written, and the first line of its help, which `surfexp --help` shows without importing it."""

    module: str
    summary: str


SECTIONS: dict[str, dict[str, Entry]] = {
    "Surfaces and maps": {
        "modes": Entry(
            "surface_commands", "Find the lowest Laplace-Beltrami eigenpairs, with the proof that none is missing."
        ),
        "denoise": Entry("map_commands", "Remove the noise of a map by the filters that promise the least error."),
        "noise": Entry("noise", "Say what noise a map has: level, outliers, correlation."),
        "smooth": Entry("map_commands", "Smooth a map by heat flow, as a Gaussian of a given width would."),
        "nulls": Entry("nulls", "Make null maps of a map, and tell its correlation with another from chance."),
        "test": Entry("permutation", "Test maps of subjects at every vertex, corrected for all of them."),
        "parcels": Entry("parcels", "Write the mean and median of a map in each parcel, weighted by area."),
        "segment": Entry("segment", "Divide a surface into two regions, with a proved lower bound."),
        "skeleton": Entry("skeleton", "Find the Reeb graph of a map on a surface."),
        "distance": Entry(
            "pairs_of_surfaces", "Measure the spectral distance of two surfaces, with a proved lower bound."
        ),
        "reeb-distance": Entry("reeb_distance", "Bound the distance of the Reeb graphs of maps on two surfaces."),
        "align": Entry("pairs_of_surfaces", "Align the modes of one surface with those of another."),
        "fingerprint": Entry("fingerprint", "Write area, volume and lowest eigenvalues of many surfaces as a table."),
        "geodesic": Entry("surface_commands", "Measure the geodesic distance from vertices, with a bound from below."),
        "curvature": Entry(
            "surface_commands", "Compute the mean curvature, positive where the surface bulges outward."
        ),
        "convert": Entry("surface_commands", "Write a surface in another format, with its maps."),
        "plot": Entry("surface_commands", "Draw a surface, coloured by a map or by labels."),
        "view": Entry("view", "Turn a surface, coloured by a map or by labels."),
        "check": Entry("mesh_quality", "Name the defects of mesh files, or the first mistake of experiment files."),
        "repair": Entry("mesh_quality", "Repair the defects of a mesh and name each change."),
    },
    "Experiments": {
        "run": Entry("run", "Run an experiment or a sweep."),
        "plan": Entry("run", "Show what a run would compute, and what is already done."),
        "list": Entry("catalogue", "List the plugins of a kind, or the experiments."),
        "info": Entry("catalogue", "Show the options of a plugin, or the question and cost of an experiment."),
        "init": Entry("init", "Write the files with which plain snakemake runs an experiment."),
        "new": Entry("new", "Write a first plugin with its test, or a first experiment."),
        "collect": Entry("collect", "Read your own surfaces as a dataset for experiments."),
        "upgrade": Entry("upgrade", "Rewrite experiments of an earlier version in the present spelling."),
        "fetch": Entry("fetch", "Get a public collection of surfaces."),
        "cite": Entry("cite", "Print what to cite for experiments, as BibTeX."),
    },
    "Results": {
        "table": Entry("table", "Print the tables of experiments."),
        "report": Entry("report", "Rewrite the report page of experiments."),
        "open": Entry("open", "Open the page of an experiment, or the overview of all, in the browser."),
        "diff": Entry("diff", "Compare two rows: the options that differ, and the metrics."),
        "export": Entry("export", "Write finished results as files for other programs."),
        "rerun": Entry("rerun", "Run a bundle again and compare the results."),
        "ui": Entry("ui", "Start the MLflow dashboard on this machine."),
        "clean": Entry("clean", "Remove stored results that no plan names."),
        "verify": Entry("verify", "Check the hash of every stored result and name what is damaged."),
    },
    "Set-up": {
        "doctor": Entry("doctor", "Show versions, extras and free disk, and what to install."),
        "schema": Entry("schema", "Write the JSON schema with which an editor completes experiments."),
        "completion": Entry("completion", "Print the shell code that completes commands, options and names."),
    },
}
COMMANDS = {name: entry for section in SECTIONS.values() for name, entry in section.items()}
SUCCESSORS = {
    "mesh": "surfexp mesh is now two commands: surfexp check FILE names defects, "
    "surfexp repair FILE --to FILE repairs them"
}


class Commands(click.Group):
    """All commands by name; the module of one is imported when that one is called."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """See click."""
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """See click."""
        if cmd_name not in COMMANDS:
            return None
        members = vars(import_module(f"surfexp.commands.{COMMANDS[cmd_name].module}")).values()
        return next(item for item in members if isinstance(item, click.Command) and item.name == cmd_name)

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """See click; a name that there is not is answered with the nearest one, a former one with its successor."""
        if not ctx.resilient_parsing and args[0] not in COMMANDS:
            raise UserError(SUCCESSORS[args[0]]) if args[0] in SUCCESSORS else unknown("command", args[0], COMMANDS)
        if not ctx.resilient_parsing and args[1:] != ["--help"]:
            if args[0] in SECTIONS["Surfaces and maps"]:
                require_memory(LEAST_FOR_NUMERICS)
            elif args[0] in ("run", "rerun"):
                require_memory(LEAST_FOR_RUNS)
        return super().resolve_command(ctx, args)

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """See click; no command is imported."""
        width = max(map(len, COMMANDS))
        for heading, entries in SECTIONS.items():
            with formatter.section(heading):
                formatter.write_dl([(f"{name:{width}}", entry.summary) for name, entry in entries.items()])

    def shell_complete(self, ctx: click.Context, incomplete: str) -> list[CompletionItem[str]]:
        """See click; no command is imported."""
        if incomplete.startswith("-"):
            return click.Command.shell_complete(self, ctx, incomplete)
        return [
            CompletionItem(name, help=entry.summary) for name, entry in COMMANDS.items() if name.startswith(incomplete)
        ]


@click.group(
    "surfexp",
    cls=Commands,
    invoke_without_command=True,
    subcommand_metavar="COMMAND [ARGUMENTS]...",
    context_settings={"help_option_names": ["-h", "--help"], "show_default": True, "max_content_width": 100},
    epilog="surfexp COMMAND --help explains a command. Exit codes: 2 a mistake in the request, 1 a failed stage, "
    "3 a result that did not converge, 130 interrupted.",
)
@click.option("--debug", is_flag=True, help="Show the traceback of an error; it may stand anywhere.")
@click.version_option(__version__, "-V", "--version", message="surfexp %(version)s")
@click.pass_context
def surfexp(ctx: click.Context, debug: bool) -> None:
    """Denoise, segment and compare maps and shapes on triangle meshes, and run experiments that compare methods."""
    if ctx.invoked_subcommand is None:
        echo(ctx.get_help())
