"""Studies: one folder each, with its code, the plugins that only it uses, its page and its tests; any can be deleted."""
