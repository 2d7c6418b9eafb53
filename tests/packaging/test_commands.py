"""Commands and kinds of files that packages bring: found by entry point, imported when given, named when they fail."""

import json
import re
import subprocess
import sys

import pytest

pytestmark = pytest.mark.unit

OF_THE_FLOORS = ("bench", "drive", "new", "paper", "policy", "robot", "scenario", "serve", "sweep", "walk")
LAST_OF_THE_CORE = "history"

MODULE = '''
import sys
import typer
from surefoot.scenarios.errors import ScenarioError

group = typer.Typer(help="Two of them.")

def ends(how: str, code: int = 3) -> None:
    """End in a way."""
    if how == "exit":
        raise typer.Exit(code)
    if how == "usage":
        raise typer.BadParameter("no such way")
    if how == "refused":
        raise ScenarioError(["walk: is no run; give another"])
    if how == "leaves":
        sys.exit(0)
    if how == "fails":
        raise RuntimeError("out of order")
    typer.echo(f"done: {how}")

@group.command()
def one() -> None:
    """The first."""
    typer.echo("first")

@group.command()
def two() -> None:
    """The second."""
    raise RuntimeError("out of order")
'''


@pytest.fixture
def tools(site):
    """A package with a command that ends in several ways, and a group of two."""
    made = site("tools")
    made.write("my_package_tools.py", MODULE)
    made.register("surefoot.commands", ends="my_package_tools:ends", pair="my_package_tools:group")
    return made


def listed(text):
    return re.findall(r"(?m)^  ([a-z]+)  +\S", text.partition("Commands:")[2])


def test_commands_of_the_floors_are_found_behind_those_of_the_core(at_hand):
    names = listed(at_hand("-h").out)
    assert names[names.index(LAST_OF_THE_CORE) + 1 :] == list(OF_THE_FLOORS)


def test_a_command_of_the_core_imports_no_other(at_hand, tools):
    code = (
        "import sys\nfrom surefoot.scenarios.cli.program import program\n"
        "try: program(['schema'])\nfinally: print(*sys.modules)"
    )
    words = [sys.executable, "-c", code]
    loaded = subprocess.run(words, capture_output=True, text=True, check=True).stdout.splitlines()[-1].split()
    assert "surefoot.scenarios.cli.found" in loaded
    assert not [name for name in loaded if name.startswith(("surefoot.studies", "surefoot.apps"))]


def test_a_command_of_a_package_is_listed_given_and_completed(at_hand, tools, monkeypatch):
    names = listed(at_hand("-h", sites=[tools]).out)
    assert names[names.index(LAST_OF_THE_CORE) + 1 :] == sorted((*OF_THE_FLOORS, "ends", "pair"))
    assert at_hand("ends", "well") == (0, "done: well\n", "")
    assert at_hand("pair", "one").out == "first\n"
    assert "Usage: surefoot pair two" in at_hand("pair", "two", "-h").out
    for name, value in (("COMP_WORDS", "surefoot pai"), ("COMP_CWORD", "1"), ("_SUREFOOT_COMPLETE", "complete_bash")):
        monkeypatch.setenv(name, value)
    assert at_hand().out.split() == ["pair"]


@pytest.mark.parametrize(
    ("words", "code", "said"),
    [
        (("ends", "exit"), 3, ""),
        (("ends", "exit", "--code", "1"), 1, ""),
        (("ends", "exit", "--code", "x"), 2, "surefoot ends: invalid value for '--code'"),
        (("ends", "usage"), 2, "no such way"),
        (("ends", "refused"), 2, "walk: is no run; give another\n"),
        (("ends", "leaves"), 2, "command 'ends' of package tools: SystemExit: 0"),
        (("ends", "fails"), 2, "command 'ends' of package tools: RuntimeError: out of order"),
        (("pair", "two"), 2, "command 'pair' of package tools: RuntimeError: out of order"),
        (("pair", "too"), 2, "did you mean 'two'"),
    ],
)
def test_it_ends_as_one_of_ours_or_is_named(at_hand, tools, words, code, said):
    answer = at_hand(*words, sites=[tools])
    assert (answer.code, answer.out) == (code, "")
    assert said.lower() in answer.err.lower()
    assert answer.err.count("\n") == bool(said)


def test_one_that_cannot_be_loaded_disturbs_only_who_gives_it(at_hand, site):
    made = site("broken-tools")
    made.write("broken_tools.py", "raise ImportError('no such engine')\n")
    made.register("surefoot.commands", broken="broken_tools:command", absent="broken_tools_2:command")
    helped = at_hand("-h", sites=[made])
    assert (helped.code, helped.err) == (0, "")
    assert "Cannot be used: 'broken' of package broken-tools" in " ".join(helped.out.split())
    assert at_hand("list").code == 0
    for name in ("broken", "absent"):
        answer = at_hand(name, "word", "--option", "-h")
        assert (answer.code, answer.out, answer.err.count("\n")) == (2, "", 1)
        assert f"'{name}' of package broken-tools cannot be loaded" in answer.err


@pytest.mark.parametrize("name", ["run", "sweep"])
def test_a_name_of_ours_means_ours_whichever_floor_it_is_of(at_hand, site, name):
    made = site("my-package")
    made.write("my_package_taken.py", "def other(): print('another')\n")
    made.register("surefoot.commands", **{name: "my_package_taken:other"})
    assert f"Usage: surefoot {name} " in at_hand(name, "-h", sites=[made]).out
    answer = at_hand("list")
    assert f"'{name}' of package my-package in surefoot.commands has the name of one of surefoot's own" in answer.err
    assert answer.err.count("\n") == 1
    assert "my_package_taken" not in sys.modules


def test_a_program_without_its_entry_points_says_so(at_hand, monkeypatch):
    from surefoot.parts import plugins

    assert "installed" not in at_hand("swep").err
    monkeypatch.setattr(plugins, "entry_points", lambda group: ())
    answer = at_hand("sweep", "soak")
    assert (answer.code, answer.out) == (2, "")
    assert "no such command 'sweep', and surefoot is installed without all of its commands" in answer.err
    assert listed(at_hand("-h").out)[-1] == LAST_OF_THE_CORE


def test_files_of_a_package_are_listed_and_shown(at_hand, site):
    made = site("my-package")
    made.write("my_package_files.py", "from pathlib import Path\ndef maps():\n    here = Path(__file__).parent\n"
               "    return {'hall': here / 'hall.yaml', 'gone': here / 'gone.yaml'}\n")  # fmt: skip
    made.write("hall.yaml", "# A hall.\nlength: 3\n")
    made.register("surefoot.files", map="my_package_files:maps")
    answer = at_hand("list", sites=[made])
    assert (answer.code, answer.err) == (0, "")
    lines = [re.sub(" +", " ", line) for line in answer.out.splitlines() if line.startswith("map ")]
    assert lines == ["map hall A hall. [my-package]", "map gone [my-package]"]
    assert at_hand("show", "hall").out == "# A hall.\nlength: 3\n"
    assert json.loads(at_hand("list", "--json").out)["map"][0] == {
        "name": "hall", "package": "my-package", "doc": "A hall.",
    }  # fmt: skip
    gone = at_hand("show", "gone")
    assert (gone.code, gone.err.count("\n")) == (2, 1)
    assert "gone.yaml: cannot be read" in gone.err


@pytest.mark.parametrize(
    ("body", "said"),
    [
        ("raise RuntimeError('none today')", "file 'map' of package my-package: RuntimeError: none today"),
        ("return ['hall']", "file 'map' of package my-package: gave ['hall'], which has no paths by name"),
        ("return {'hall': 'hall.yaml'}", "which has no paths by name"),
    ],
)
def test_files_that_cannot_be_had_are_told_beside_the_others(at_hand, site, body, said):
    made = site("my-package")
    made.write("my_package_files.py", f"def maps():\n    {body}\n")
    made.register("surefoot.files", map="my_package_files:maps")
    answer = at_hand("list", sites=[made])
    assert answer.code == 0 and "campaign   soak" in answer.out
    assert said in answer.err and answer.err.count("\n") == 1
    assert at_hand("show", "soak").code == 0


@pytest.mark.parametrize(
    ("words", "module", "extra"),
    [
        (("drive", "walk"), "viser", "replay"),
        (("sweep", "push-map-pendulum", "--cluster", "tcp://127.0.0.1:1"), "distributed", "cluster"),
    ],
)
def test_a_command_of_a_floor_without_its_extra_says_what_installs_it(
    at_hand, monkeypatch, tmp_path, words, module, extra
):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setitem(sys.modules, module, None)
    answer = at_hand(*words)
    assert (answer.code, answer.out, answer.err.count("\n")) == (2, "", 1)
    assert f"needs the package {module}; install it with: " in answer.err and f"[{extra}]" in answer.err
    assert at_hand(words[0], "-h").code == 0
