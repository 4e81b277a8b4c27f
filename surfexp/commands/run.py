"""`surfexp run` and `surfexp plan`: what follows them is Hydra's."""

from __future__ import annotations

from typing import Any

import click

from surfexp.commands import choices
from surfexp.commands.click_command import shown

RUN = (
    "",
    "experiment=NAME                       # surfexp list experiment",
    "experiment=NAME,NAME                  # several, one after the other",
    "solver=primal_dual,split_bregman      # a sweep: comma lists, range(1,5), glob(*)",
    "surface=file surface.path=mesh.ply    # your own surface",
    "surface=file 'surface.path=\"a b.ply\"'  # quotes for Hydra inside quotes for the shell",
    "experiment=NAME --cfg job             # Hydra's flags: what would be composed",
)


class HydraCommand(click.Command):
    """A command whose arguments are handed on as they are, and whose help lists what they can set."""

    def format_options(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """See click."""
        super().format_options(ctx, formatter)
        from surfexp.commands.arguments import choices_of_configuration

        for heading, rows in choices_of_configuration().items():
            with formatter.section(heading):
                formatter.write_dl(rows)


def _of_hydra(name: str, *examples: str) -> dict[str, Any]:
    settings = {"context_settings": {"ignore_unknown_options": True}}
    return shown(name, *examples, cls=HydraCommand) | settings


words = click.argument(
    "arguments",
    nargs=-1,
    type=click.UNPROCESSED,
    metavar="[experiment=NAME] [KIND=PLUGIN] [KIND.OPTION=VALUE] [SETTING=VALUE] ...",
    shell_complete=choices.setting,
)


@click.command(**_of_hydra("run", *RUN))
@words
def run(arguments: tuple[str, ...]) -> int:
    """Run an experiment or a sweep.

    What is missing is computed, what is there is kept. The arguments are Hydra's, and so are its flags: --cfg, --info,
    --config-dir, --multirun; ~KEY removes a key, +KEY=VALUE adds one.
    """
    from surfexp.commands.request import carried_out

    return carried_out("run", list(arguments))


@click.command(**_of_hydra("plan", "", "experiment=NAME", "experiment=NAME surface.levels=3,4,5"))
@words
def plan(arguments: tuple[str, ...]) -> int:
    """Show what a run would compute, and what is already done.

    The arguments are those of surfexp run.
    """
    from surfexp.commands.request import carried_out

    return carried_out("plan", list(arguments))
