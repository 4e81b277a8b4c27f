"""Pages that recompute what a result is certified by, in the browser of who reads them."""
