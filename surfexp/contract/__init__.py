"""What a result promises: its metrics, its members, its summary, the shapes of its arrays."""
