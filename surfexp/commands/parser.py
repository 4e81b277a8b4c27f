"""argparse as the other commands are: a mistake is one line, not the usage and a line."""

from __future__ import annotations

import argparse
from typing import NoReturn

from surfexp.lab.errors import UserError


class Parser(argparse.ArgumentParser):
    """A parser whose errors end as those of every command, with exit code 2."""

    def error(self, message: str) -> NoReturn:
        """See argparse."""
        raise UserError(f"{message}; {self.prog} --help lists what there is")
