"""What has to be computed: stages, their keys, what became of each."""
