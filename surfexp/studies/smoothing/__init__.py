"""What smoothing does to maps whose truth is known, and to repetitions of maps where it is not."""
