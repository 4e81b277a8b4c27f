"""What do eigenfunctions leave open? Signs, and the search over them."""
