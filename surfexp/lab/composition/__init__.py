"""Hydra: a configuration composed from files and the command line."""
