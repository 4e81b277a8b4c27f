"""An experiment as one file that runs again: what goes in, how it is described, opened, run anew and held against."""
