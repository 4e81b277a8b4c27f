# `snakemake -c2` runs the default experiment, `snakemake -c2 --config experiment=NAME` another.
import importlib.util
from pathlib import Path

include: str(Path(importlib.util.find_spec("surfexp.lab.running").origin).parent / "rules.smk")

from surfexp.commands import execution

execution.before_snakemake(plan, results)

# Snakemake takes its default target and its handlers from this file only, not from an included one.
workflow.default_target = "all"


onstart:
    execution.hold_results(results)


onsuccess:
    execution.after_snakemake(plan_path)


onerror:
    execution.after_snakemake(plan_path)
