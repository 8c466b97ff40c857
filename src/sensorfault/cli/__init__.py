"""The command line: one verb a file. Nothing slow is imported before a verb runs."""

import sys

import click

from sensorfault.cli import demo, detect, evaluate, fit, info, init, inject, methods, report, reproduce


@click.group(context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100})
@click.version_option(package_name="sensorfault")
def cli() -> None:
    """Find faulty sensors of a vehicle: which sensor and channel, when, and what kind of fault.

    Start with `sensorfault demo`, or with a log of your own: `sensorfault init LOG`, then `sensorfault detect LOG`.
    LOG is a file (PX4 .ulg, ArduPilot .bin, .log or .tlog, ROS .bag, .db3 or .mcap, CSV, Parquet, MATLAB, NumPy, GNSS
    formats), or a folder of such files of one drive. `sensorfault info LOG` lists what it holds.
    """


for verb in (demo, init, info, fit, detect, inject, evaluate, report, methods, reproduce):
    cli.add_command(verb.command)


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
