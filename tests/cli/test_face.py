"""Help, what is imported for it, and whether the README tells the truth."""

import json
import re
import subprocess
import sys
from importlib import import_module
from pathlib import Path
from pkgutil import iter_modules

import click
import pytest
from click.testing import CliRunner

import fitted
import sensorfault.cli
from cli.conftest import write_csv
from sensorfault.cli import cli
from sensorfault.faults.fault import Fault
from sensorfault.faults.inject import inject

README = (Path(__file__).parents[2] / "README.md").read_text()
VERBS = sorted(cli.commands)
# What a verb of its kind cannot do without.
OPTIONS = {
    "demo": {"--out", "--flight", "--method", "--seed", "--json"},
    "init": {"--out", "--force"},
    "fit": {"--vehicle", "--method", "--out", "--held-out", "--seed", "--json"},
    "detect": {"--vehicle", "--model", "--method", "--learn", "--report", "--seed", "--json"},
    "inject": {"--vehicle", "--fault", "--out", "--seed", "--json"},
    "evaluate": {"--vehicle", "--model", "--method", "--learn", "--truth", "--seed", "--json"},
    "report": {"--vehicle", "--model", "--method", "--learn", "--out", "--truth", "--seed"},
    "methods": {"--json"},
}


def test_the_verbs_are_those_of_the_issue() -> None:
    assert set(VERBS) >= set(OPTIONS)


def test_no_verb_is_forgotten() -> None:
    modules = (import_module(module.name) for module in iter_modules(sensorfault.cli.__path__, "sensorfault.cli."))
    assert {module.__name__.split(".")[-1] for module in modules if hasattr(module, "command")} == set(VERBS)


@pytest.mark.parametrize("verb", VERBS)
def test_help_says_what_a_verb_takes(verb: str) -> None:
    result = CliRunner().invoke(cli, [verb, "--help"])
    assert result.exit_code == 0
    command = cli.commands[verb]
    assert command.help
    assert " ".join(command.help.split("\n\n")[0].split()) in " ".join(result.output.split())
    options = {name for param in command.params if isinstance(param, click.Option) for name in param.opts}
    assert all(name in result.output for name in options)
    assert OPTIONS.get(verb, set()) <= options
    arguments = [param for param in command.params if isinstance(param, click.Argument)]
    assert all(argument.make_metavar(click.Context(command)) in result.output for argument in arguments)


@pytest.mark.parametrize("verb", VERBS)
def test_every_option_says_what_it_is_for(verb: str) -> None:
    silent = {"--seed"}
    for param in cli.commands[verb].params:
        if isinstance(param, click.Option) and not silent & set(param.opts):
            assert param.help, param.opts


def test_help_lists_every_verb() -> None:
    result = CliRunner().invoke(cli, ["--help"])
    assert result.exit_code == 0
    assert all(re.search(rf"^  {verb} ", result.output, re.MULTILINE) for verb in VERBS)
    assert CliRunner().invoke(cli, ["-h"]).output == result.output


def test_help_and_version_import_nothing_slow() -> None:
    code = (
        "import json, sys, time\n"
        "from sensorfault.cli import main\n"
        "for words in (['--help'], ['detect', '--help'], ['--version']):\n"
        "    sys.argv = ['sensorfault', *words]\n"
        "    try: main()\n"
        "    except SystemExit as end: assert not end.code\n"
        "import sensorfault\n"
        "print('\\n' + json.dumps(sorted({name.split('.')[0] for name in sys.modules})))\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    loaded = set(json.loads(done.stdout.splitlines()[-1]))
    assert "click" in loaded
    slow = {"jax", "jaxlib", "equinox", "numpy", "scipy", "polars", "plotly", "rich", "safetensors"}
    assert not loaded & slow
    assert "sensorfault, version" in done.stdout


@pytest.mark.parametrize(
    ("words", "unasked"),
    [
        (["init", "drive.csv"], {"jax", "equinox", "scipy", "plotly", "pyulog", "pymavlink", "asammdf"}),
        (["info", "drive.csv"], {"jax", "equinox", "optax", "scipy", "plotly", "pyulog", "pymavlink", "asammdf"}),
        (
            ["methods"],
            {"jax", "equinox", "optax", "scipy", "polars", "plotly", "sensorfault.methods.gnss.satellite_bank"},
        ),
        (["reproduce", "--help"], {"jax", "numpy", "polars", "sensorfault_studies"}),
        (["nosuch"], {"jax", "numpy", "polars", "sensorfault.cli.demo"}),
        (["--version"], {"jax", "numpy", "polars", "sensorfault.cli.demo", "sensorfault.cli.reproduce"}),
        (["demo", "--help"], {"jax", "numpy", "polars", "sensorfault.cli.detect", "sensorfault.cli.reproduce"}),
    ],
)
def test_a_verb_imports_what_it_needs(tmp_path: Path, recorded: bytes, words: list[str], unasked: set[str]) -> None:
    (tmp_path / "drive.csv").write_bytes(recorded)
    code = (
        "import sys\n"
        "from sensorfault.cli import main\n"
        f"sys.argv = ['sensorfault', *{words}]\n"
        "try: main()\n"
        "except SystemExit: pass\n"
        "print('\\n' + ' '.join(sys.modules))\n"
    )
    command = [sys.executable, "-c", code]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=True)
    loaded = set(done.stdout.splitlines()[-1].split())
    assert "click" in loaded
    assert not loaded & unasked


def test_a_process_ends_with_the_code_and_the_sentence() -> None:
    """Through `python -m`, as a shell sees it."""
    command = [sys.executable, "-m", "sensorfault", "detect", "nowhere.csv"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert done.stdout == ""
    (line,) = done.stderr.splitlines()
    assert line.startswith("sensorfault: nowhere.csv: ")


def test_the_readme_has_the_verbs() -> None:
    rows = re.findall(r"^\| `([a-z]+)[^`]*` \| .+ \|$", README, re.MULTILINE)
    assert sorted(rows) == VERBS
    json_verbs = {verb for verb in VERBS if any("--json" in param.opts for param in cli.commands[verb].params)}
    assert json_verbs >= {"demo", "fit", "detect", "inject", "evaluate", "methods"}


def test_the_commands_of_the_readme_are_commands() -> None:
    commands = re.findall(r"^    sensorfault (.+?)(?:  +#.*)?$", README, re.MULTILINE)
    assert len(commands) >= 3
    for command in commands:
        verb, *words = command.split()
        named = {name for param in cli.commands[verb].params for name in param.opts}
        assert {word for word in words if word.startswith("--")} <= named, command


def test_the_python_of_the_readme_runs(tmp_path: Path) -> None:
    """On a drive of 150 s whose gyro is stuck for three of the last thirty; by itself, as a reader would run it."""
    healthy = fitted.rig().between(end_s=150.0)
    log = inject(healthy, [Fault("frozen", "gyro", "y", 130.0, 3.0)]).log
    write_csv(tmp_path / "drive.csv", log)
    (code,) = re.findall(r"```python\n(.*?)```", README, re.DOTALL)
    code = f"values = {log.value[6001].tolist()}\n" + code
    done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    said = done.stdout.splitlines()
    assert any(line.split()[1:] == ["gyro", "y", "frozen"] for line in said)
    assert said[-1].split()[0] in ("ok", "unknown", "fault")
