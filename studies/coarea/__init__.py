"""Do total variation and perimeters of a mesh converge? The theorems of section 2.2."""
