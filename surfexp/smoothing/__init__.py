"""Linear filters of maps on surfaces, as imaging packages apply them, beside total variation."""
