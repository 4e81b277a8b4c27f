"""Is mode k of one person mode k of another? Counterparts of modes, and signs that maps of people agree on."""
