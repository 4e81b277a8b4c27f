"""Snakemake with our executor, as `surfexp run` starts it: `python -m surfexp.workers.snakemake ARGUMENTS`.

Snakemake finds a plugin by the name of its package among installed ones, but not in one that is installed as editable.
It ends with the process that started it.
"""

from __future__ import annotations

import os
import sys

from snakemake.cli import main
from snakemake_interface_executor_plugins.registry import ExecutorPluginRegistry

from surfexp.workers import executor
from surfexp.workers.stage_process import die_with_parent

if __name__ == "__main__":
    die_with_parent(os.getppid())
    ExecutorPluginRegistry().register_plugin("snakemake_executor_plugin_surfexp", executor)
    main(sys.argv[1:])
