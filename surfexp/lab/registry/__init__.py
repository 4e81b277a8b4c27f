"""Methods: where plugins lie, how they are loaded and described."""
