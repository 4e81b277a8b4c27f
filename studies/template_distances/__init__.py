"""How far is a population from its template? Spectral distances of synthetic people."""
