"""Stages run: by Snakemake, in processes, on a cluster."""
