"""The command `isomortar` of a working copy. Its import builds what has changed, and that can be interrupted, or refused."""

import signal
import sys


def launch() -> None:
    """Run the command; where it cannot be built, say why."""
    heard = signal.getsignal(signal.SIGINT) is signal.default_int_handler
    if heard:
        signal.signal(signal.SIGINT, signal.SIG_DFL)  # ends the process, wherever it comes: nothing is open yet
    try:
        from isomortar.cli import main
    except ImportError as error:
        print(f"isomortar: {error}", *getattr(error, "__notes__", ()), sep="\n", file=sys.stderr)
        sys.exit(1)
    except OSError as error:
        print(
            f"isomortar: {error.strerror}: {error.filename}. This is a working copy, which is built anew when it is used: an account that "
            "may not write to it needs a copy of its own, or an installation by `pip install .`",
            file=sys.stderr,
        )
        sys.exit(1)
    if heard:
        signal.signal(signal.SIGINT, signal.default_int_handler)
    main()


if __name__ == "__main__":  # processes that it starts import this file, too
    launch()
