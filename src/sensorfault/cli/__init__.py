"""The command line: one verb a file. Nothing slow is imported before a verb runs."""

import sys
from collections import UserDict
from importlib import import_module

import click

VERBS = ("demo", "detect", "evaluate", "fit", "info", "init", "inject", "methods", "report", "reproduce")


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
    """Notice when a vehicle's sensor lies, name it and the kind of fault.

    Start with `sensorfault demo`, or with a log of your own: `sensorfault init LOG`, then `sensorfault detect LOG`.
    LOG is a file (PX4 .ulg, ArduPilot .bin, .log or .tlog, ROS .bag, .db3 or .mcap, CSV, Parquet, MATLAB, NumPy, GNSS
    formats), or a folder of such files of one drive. `sensorfault info LOG` says what it holds.
    """


def main() -> None:
    """Run the command line: bad input is one sentence on stderr and exit code 2."""
    from sensorfault.cli.errors import sentence_of

    try:
        cli(standalone_mode=False)
    except click.exceptions.Exit as done:
        sys.exit(done.exit_code)
    except (click.Abort, KeyboardInterrupt):
        sys.exit(130)
    except click.ClickException as error:
        click.echo(f"sensorfault: {error.format_message()}", err=True)
        sys.exit(2)
    except (ValueError, OSError) as error:
        sentence = sentence_of(error)
        if sentence is None:
            raise
        click.echo(f"sensorfault: {sentence}", err=True)
        sys.exit(2)
