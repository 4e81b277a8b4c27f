"""Can one hear the shape of a drum? Isospectral pairs of seven tiles, their values and what tells them apart."""
