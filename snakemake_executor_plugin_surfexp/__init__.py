"""The name by which Snakemake finds the executor of this project: `snakemake --executor surfexp`."""

from surfexp.workers.executor import Executor as Executor
from surfexp.workers.executor import common_settings as common_settings
