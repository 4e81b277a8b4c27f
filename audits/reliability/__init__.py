"""Files that other programs write, read by ours and by theirs, and what came of each."""

from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
