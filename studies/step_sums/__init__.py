"""What the step of threshold-free enhancement decides."""
