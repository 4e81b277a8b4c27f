"""The Snakemake of a job on Slurm, which knows our executor: `python -m surfexp.lab.running.slurm_job ARGUMENTS`."""

from __future__ import annotations

import sys

from surfexp.lab.running.snakemake import run

if __name__ == "__main__":
    run(sys.argv[1:])
