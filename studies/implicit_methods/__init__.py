"""What do level-set methods cost, and what do they lose? They against the intrinsic minimum."""
