"""Surfaces that turn in a report page: what of the stored results goes into it, and in how few bytes."""
