"""Results by key, sealed; kinds of results."""
