"""`python -m audits.torture [GROUP ...]`: run what goes wrong, print what came of it, and write docs/reliability.md."""

from audits.torture.groups import main

# what a new process runs has to be found in a module with a name
main()
