# `snakemake -c2` runs the default experiment, `snakemake -c2 --config experiment=NAME` another; `surfexp init` writes a
# Snakefile for a folder of one's own.
from surfexp.commands.plain_snakemake import SNAKEFILE


include: SNAKEFILE


rule all:
    input:
        rules.stages.input,
        rules.report.output,
