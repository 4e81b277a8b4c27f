"""The page of verdicts on published claims, and what it rests on."""
