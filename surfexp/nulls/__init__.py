"""Null models of maps on surfaces: random maps that keep what a map claims to be tested with."""
