"""The laboratory: experiments planned, run, stored by key; what the extra `lab` installs."""
