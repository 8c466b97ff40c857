"""The command line: one verb a file. Nothing slow is imported before a verb runs."""

import io
import os
import signal
import sys
from collections import UserDict
from importlib import import_module

import click

VERBS = ("cache", "demo", "detect", "evaluate", "fit", "info", "init", "inject", "methods", "report", "reproduce")


class _Verbs(UserDict[str, click.Command]):
    """Name -> command. A verb is a module of this package with a `command`, imported when it is asked for."""

    def __getitem__(self, name: str) -> click.Command:
        if name not in self.data:
            raise KeyError(name)
        found: click.Command = import_module(f"{__name__}.{name}").command
        return found


@click.group(
    commands=_Verbs(dict.fromkeys(VERBS)),  # type: ignore[arg-type]  # no command yet
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100},
)
@click.version_option(package_name="sensorfault")
def cli() -> None:
    """Find faulty sensors of a vehicle: which sensor and channel, when, and what kind of fault.

    Start with `sensorfault demo`, or with a log of your own: `sensorfault init LOG`, then `sensorfault detect LOG`.
    LOG is a file (PX4 .ulg, ArduPilot .bin, .log or .tlog, ROS .bag, .db3 or .mcap, CSV, Parquet, MATLAB, NumPy, GNSS
    formats), or a folder of such files of one drive. `sensorfault info LOG` lists what it holds.
    """


def main() -> None:
    """Run the command line: bad input is one sentence on stderr and exit code 2."""
    from sensorfault.cli.errors import sentence_of

    _be_interruptible()
    os.environ.setdefault("TF_CPP_MIN_LOG_LEVEL", "3")  # XLA's own messages are no news to a user
    try:
        cli(standalone_mode=False)
    except click.exceptions.Exit as done:
        sys.exit(done.exit_code)
    except (click.Abort, KeyboardInterrupt):
        sys.exit(130)
    except BrokenPipeError:  # whoever read the answer has gone
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        sys.exit(141)
    except click.ClickException as error:
        click.echo(f"sensorfault: {error.format_message()}", err=True)
        sys.exit(2)
    except (ValueError, OSError, ImportError) as error:
        verb = next((word for word in sys.argv[1:] if word in cli.commands), "")
        sentence = sentence_of(error, f"`sensorfault {verb}`")
        if sentence is None:
            raise
        click.echo(f"sensorfault: {sentence}", err=True)
        sys.exit(2)


def _be_interruptible() -> None:
    """End on SIGTERM as on an interrupt, so that no temporary file stays; print any name in any locale."""
    signal.signal(signal.SIGTERM, lambda number, frame: sys.exit(128 + number))
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")
