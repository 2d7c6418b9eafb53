"""`make results` tells what a change can have touched, and never calls a result fresh that was not made so."""

import importlib
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.unit

DOCS = Path(__file__).parents[2] / "docs"
MAKER = 'from surefoot.law import force\n\nopen("kept.csv", "w").write(f"{force(2.0)}, {open(\'x.yaml\').read()}")\n'
LAW = 'def force(x):\n    """Of a spring."""\n    from surefoot.gain import GAIN\n\n    return GAIN * x\n'


@pytest.fixture
def results(monkeypatch):
    monkeypatch.syspath_prepend(str(DOCS))
    return importlib.import_module("results")


@pytest.fixture
def tree(tmp_path):
    for folder in ("surefoot", "scenarios/catalogue", "models/robots"):
        (tmp_path / folder).mkdir(parents=True)
    for name, text in {
        "surefoot/__init__.py": "",
        "surefoot/law.py": LAW,
        "surefoot/gain.py": "GAIN = 2.0\n",
        "surefoot/other.py": "X = 1\n",
        "constraints.txt": "numpy==2.4.0\nrich==15.0\n",
        "maker.py": MAKER,
        "x.yaml": "scenario: walk-level\n",
        "scenarios/catalogue/walk-level.yaml": "steps: 3\n",
        "scenarios/catalogue/stand.yaml": "steps: 0\n",
    }.items():
        (tmp_path / name).write_text(text)
    return tmp_path


@pytest.fixture
def one(results, tree):
    """A result, and what its state is, and making it."""

    class One:
        result = results.Result("one", (f"{sys.executable} maker.py",), ("maker.py",), ("x.yaml",), ("kept.csv",))
        path = tree / "made.json"

        def state(self):
            return results.state(self.result, results.kept(self.path), tree)

        def make(self):
            return results.make(self.result, self.path, tree)

    return One()


def edit(tree, name, before, after):
    text = (tree / name).read_text()
    assert before in text
    (tree / name).write_text(text.replace(before, after))


def test_a_result_is_unknown_until_it_is_made(one, tree):
    (tree / "kept.csv").write_text("made by nobody knows what")
    assert one.state() == "unknown"
    assert "made in" in one.make()
    assert one.state() == "fresh"
    assert (tree / "kept.csv").read_text() == "4.0, scenario: walk-level\n"


@pytest.mark.parametrize(
    ("name", "before", "after", "state"),
    [
        ("surefoot/gain.py", "2.0", "3.0", "stale: code"),
        ("surefoot/law.py", "GAIN * x", "-GAIN * x", "stale: code"),
        ("maker.py", "force(2.0)", "force(3.0)", "stale: code"),
        ("x.yaml", "walk-level", "stand", "stale: inputs"),
        ("scenarios/catalogue/walk-level.yaml", "3", "4", "stale: inputs"),
        ("constraints.txt", "2.4.0", "2.5.0", "stale: versions"),
        ("kept.csv", "4.0", "5.0", "unknown: it was written since by something else"),
        ("surefoot/law.py", "Of a spring.", "Its force.", "fresh"),
        ("surefoot/other.py", "1", "2", "fresh"),
        ("scenarios/catalogue/stand.yaml", "0", "1", "fresh"),
        ("constraints.txt", "15.0", "15.1", "fresh"),
    ],
)
def test_a_change_makes_stale_what_it_can_have_touched(one, tree, name, before, after, state):
    one.make()
    edit(tree, name, before, after)
    assert one.state() == state
    one.make()
    assert one.state() == "fresh"


def test_what_fails_is_not_made(one, tree):
    edit(tree, "maker.py", "force(2.0)", "nothing")
    assert "it is not made" in one.make()
    assert one.state() == "unknown"


def test_what_changes_while_it_is_made_is_not_fresh(one, tree):
    with (tree / "maker.py").open("a") as file:
        file.write('\nopen("surefoot/gain.py", "w").write("GAIN = 5.0")\n')
    assert "changed while it was made" in one.make()
    assert one.state() == "unknown"


def test_those_that_are_stale_are_made_and_then_the_tables(one, tree, results, capsys):
    after = ("touch tables",)
    assert results.make_all([one.result], one.path, tree, after) == 0
    assert (tree / "tables").exists()
    (tree / "tables").unlink()
    assert results.make_all([one.result], one.path, tree, after) == 0
    assert not (tree / "tables").exists()
    assert capsys.readouterr().out.endswith("one: fresh\n")


def test_what_follows_from_results_is_there(results):
    scripts = [command.split()[1] for command in results.AFTER]
    assert scripts and all((DOCS.parent / script).is_file() for script in scripts)


def test_every_kept_result_and_baseline_has_a_maker_whose_inputs_are_there(results):
    every = results.results()
    written = {path for result in every.values() for path in result.writes}
    there = [*(DOCS / "results").glob("*.csv"), *(DOCS.parent / "scenarios" / "baselines").glob("*.yaml")]
    assert {path.relative_to(DOCS.parent).as_posix() for path in there} <= written
    names = ("known-falls", "push-map", "baseline-walk", "baseline-stand", "sensors", "sabotage")
    made_of = {name: every[name].digests() for name in names}
    assert all(made_of.values())
    walk, stand = (made_of[name] for name in ("baseline-walk", "baseline-stand"))
    assert walk["code"] == stand["code"]
    assert walk["inputs"] != stand["inputs"]


def test_the_code_of_a_campaign_is_its_runs_and_no_page_to_drive(results):
    code = {path.as_posix() for path in results.made_of.code(results.RUN)}
    assert {"planner/rules.py", "wbc/controller.pxd", "sim/world.py", "studies/campaigns/sweep.py"} <= code
    assert not any(path.startswith(("apps/", "tests/", "studies/tour", "studies/paper")) for path in code)
