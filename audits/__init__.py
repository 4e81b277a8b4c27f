"""What the makers ask of the code: rivals beside it, faults planted in it, and bad days on purpose."""
