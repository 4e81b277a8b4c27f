"""What is known of source files and plugins without reading or importing them again."""
