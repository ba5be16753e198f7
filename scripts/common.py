"""Shared by the scripts in Python."""
import argparse
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def fail(message, status=2):
    print(f"scripts/{Path(sys.argv[0]).name}: {message}", file=sys.stderr)
    sys.exit(status)


class Arguments(argparse.ArgumentParser):
    """A parser of arguments whose help is the documentation of the script."""

    def __init__(self, documentation):
        super().__init__(add_help=False, usage=argparse.SUPPRESS, allow_abbrev=False)
        self.documentation = documentation
        self.add_argument("-h", "--help", action="store_true")

    def flags(self, *names):
        for name in names:
            self.add_argument(name, action="store_true")

    def error(self, message):
        fail(f"{message}; see scripts/{Path(sys.argv[0]).name} --help")

    def parse(self):
        options = self.parse_intermixed_args()
        if options.help:
            print(self.documentation.strip())
            sys.exit(0)
        return options
