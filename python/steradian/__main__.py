"""``python -m steradian`` is the command ``steradian``."""

import sys

from steradian.cli import main

if __name__ == "__main__":
    sys.exit(main())
