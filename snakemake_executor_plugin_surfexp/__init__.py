"""The name by which Snakemake finds the executor of this project: `snakemake --executor surfexp`."""

from surfexp.lab.running.executor import Executor as Executor
from surfexp.lab.running.executor import common_settings as common_settings
