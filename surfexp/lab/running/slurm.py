"""Snakemake's executor for Slurm, with one process for all stages of a job.

A job of the plugin starts a Snakemake that starts another for each of its stages, through srun, and that the stage.
Here the Snakemake of a job hands its stages to warm processes, as one on this machine does.
"""

from __future__ import annotations

from typing import Any

import snakemake_executor_plugin_slurm
from snakemake_executor_plugin_slurm import ExecutorSettings as ExecutorSettings
from snakemake_executor_plugin_slurm import common_settings as common_settings

JOB = "surfexp.lab.running.slurm_job"


class Executor(snakemake_executor_plugin_slurm.Executor):
    """Submits, watches and cancels as the plugin does."""

    def additional_general_args(self) -> str:
        """See Snakemake: what the Snakemake of a job is told."""
        return "--executor surfexp"

    def format_job_exec(self, job: Any) -> str:
        """See Snakemake: the command of a job, with an entry that knows our executor."""
        command: str = super().format_job_exec(job)
        return command.replace("-m snakemake", f"-P -m {JOB}", 1)
