"""Surfaces that turn in a page: what is shown of them, and in how few bytes."""
