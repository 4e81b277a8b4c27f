"""What the project is held against: other people's readers and files."""
