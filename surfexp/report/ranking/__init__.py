"""Which of several methods is better on the problems that they share: ranks, tests, differences and profiles."""
