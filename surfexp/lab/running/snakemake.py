"""Snakemake with our executor, as `surfexp run` starts it: `python -m surfexp.lab.running.snakemake PARENT ARGUMENTS`.

Snakemake finds a plugin by the name of its package among installed ones, but not in one that is installed as editable.
It ends with the process that started it, from its first moment: its imports take seconds.
"""

from __future__ import annotations

import contextlib
import sys
from typing import Any

from surfexp.lab.running.lifetime import die_with_parent


def register(registry: Any) -> None:
    """Add our executor to Snakemake's, and put ours for Slurm before that of the plugin, if it is installed."""
    from surfexp.lab.running import executor

    registry.register_plugin("snakemake_executor_plugin_surfexp", executor)
    if registry.is_installed("slurm"):
        with contextlib.suppress(
            ImportError, AttributeError
        ):  # of a plugin with other insides, which does without ours
            from surfexp.lab.running import slurm

            registry.plugins["slurm"] = registry.load_plugin("slurm", slurm)


def run(arguments: list[str]) -> None:
    """Run Snakemake's command line."""
    from snakemake import cli
    from snakemake.exceptions import print_exception
    from snakemake_interface_executor_plugins.registry import ExecutorPluginRegistry

    register(ExecutorPluginRegistry())
    try:
        parser, options = cli.parse_args(arguments)
        if options.executor == "surfexp":
            # meant for submissions to a cluster: its timers, a thread and a look at all jobs for each that has ended, add up
            options.max_jobs_per_timespan = None
        done = cli.args_to_api(options, parser)
    except Exception as error:
        print_exception(error)
        done = False
    sys.exit(0 if done else 1)


if __name__ == "__main__":
    die_with_parent(int(sys.argv[1]))
    run(sys.argv[2:])
