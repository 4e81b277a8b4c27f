"""Which descriptors recognise a person again."""
