"""How do nodal counts grow, and are they the same on another mesh?"""
