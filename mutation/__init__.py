"""Faults planted in a copy of the code, each of which a named test has to catch: `python -m mutation`."""
