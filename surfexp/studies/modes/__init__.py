"""Whether modes are missing, and what they are good for."""
