"""What is recorded of a run: MLflow, and where results come from."""
