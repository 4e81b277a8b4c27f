# `snakemake -c2` runs the default experiment, `snakemake -c2 --config experiment=NAME` another.
import importlib.util
from pathlib import Path

include: str(Path(importlib.util.find_spec("surfexp.workflow").origin).parent / "rules.smk")
