# `snakemake -c2` runs the default experiment, `snakemake -c2 --config experiment=NAME` another.
import importlib.util
from pathlib import Path

include: str(Path(importlib.util.find_spec("surfexp.workflow").origin).parent / "rules.smk")

# Snakemake takes its default target and its handlers from this file only, not from an included one.
workflow.default_target = "all"


onstart:
    launch.hold_results(results)


onsuccess:
    launch.after_snakemake(plan_path)


onerror:
    launch.after_snakemake(plan_path)
