"""Surfaces of synthetic people and bodies, made from one template or skeleton, so that what differs is known."""
