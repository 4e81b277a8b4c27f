"""What is heard in the heat trace? Area, boundary and topology from finitely many eigenvalues."""
