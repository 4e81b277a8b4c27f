"""What the makers ask of the code: rivals beside it, other readers, faults planted in it, and bad days on purpose."""
