"""How should a map on a cortex be smoothed? A race of methods on maps whose truth is known, and of rules that choose."""
