"""Are sulci of equal length on both sides? Sulci named across people, measured, and compared with what was planted."""
