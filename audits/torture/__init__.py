"""Bad days on purpose: files, requests, results and names that nobody should meet, and what comes of each."""

from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
