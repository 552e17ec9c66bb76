"""The command `isomortar` of a working copy. Its import builds what has changed, and that can be interrupted, or refused."""

import sys

try:
    from isomortar.cli import main
except KeyboardInterrupt:
    sys.exit(130)
except ImportError as error:
    print(f"isomortar: {error}", *getattr(error, "__notes__", ()), sep="\n", file=sys.stderr)
    sys.exit(1)
except OSError as error:
    print(
        f"isomortar: {error.strerror}: {error.filename}. This is a working copy, which is built anew when it is used: an account that may "
        "not write to it needs a copy of its own, or an installation by `pip install .`",
        file=sys.stderr,
    )
    sys.exit(1)
main()
