"""The processes that make stages, and the compiled code that they share."""
