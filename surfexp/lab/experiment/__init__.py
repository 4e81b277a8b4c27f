"""What an experiment says: its configuration, its collections, its claims."""
