"""The subcommands of `surfexp`, one module each."""
