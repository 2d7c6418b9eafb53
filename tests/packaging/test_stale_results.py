"""No result is taken over that other code has made: of packages that bring parts, installed in whatever way."""

import json
import sys

import pytest

from surefoot.scenarios.record.packages import packages_of

MODULE = "my_package/parts.py"


@pytest.fixture
def now(monkeypatch):
    """The packages of some sites, found anew."""

    def found(names, *sites):
        for made in sites:
            if str(made.folder) not in sys.path:
                monkeypatch.syspath_prepend(str(made.folder))
        packages_of.cache_clear()
        return dict(packages_of(frozenset(names)))

    yield found
    packages_of.cache_clear()


@pytest.fixture
def mine(site):
    """A package whose installer has written no list of its files."""
    made = site("my-package")
    made.write("my_package/__init__.py", "")
    made.write(MODULE, "X = 1\n")
    return made


@pytest.mark.unit
@pytest.mark.parametrize("kind", ["metrics", "robots", "profiles", "tasks", "estimators", "plants", "terrains"])
@pytest.mark.parametrize("file", [MODULE, "my_package/data/robot.xml"])
def test_any_file_of_a_package_that_brings_a_part_is_in_it(mine, now, kind, file):
    mine.register(f"surefoot.{kind}", part="my_package.parts:X")
    mine.write(file, "X = 1\n")
    (before,) = now({"part"}, mine).values()
    assert before.startswith("1.0 ")
    mine.write("my_package/__pycache__/parts.cpython-399.pyc", "written by Python itself")
    assert [*now({"part"}).values()] == [before]
    mine.write(file, "X = 2\n")
    assert [*now({"part"}).values()] != [before]


@pytest.mark.unit
def test_what_no_run_uses_is_not_in_it_and_metrics_are_in_every_run(mine, now):
    mine.register("surefoot.tasks", part="my_package.parts:X")
    assert now({"walk"}, mine) == {}
    mine.register("surefoot.metrics", sway="my_package.parts:X")
    assert list(now({"walk"})) == ["my-package"]


@pytest.mark.unit
def test_a_module_in_the_working_directory_counts_with_those_beside_it_that_it_imports(site, now):
    made = site("hand-made")
    made.write("mine.py", "import numpy\nfrom beside import X\nraise OSError('this is not executed')\n")
    made.write("beside.py", "import further\n")
    made.register("surefoot.metrics", sway="mine:X")
    seen = [now({}, made)]
    for name in ("further.py", "beside.py", "mine.py"):
        made.write(name, "X = 2\n")
        seen.append(now({}))
    assert len({one["hand-made"] for one in seen}) == 4
    made.write("nothing.py", "X = 2\n")
    assert now({}) == seen[-1]


@pytest.mark.unit
def test_files_beside_a_module_that_it_names_count_too(site, now):
    """Data that it reads, and a module that it finds by a name; not what others write there meanwhile."""
    made = site("hand-made")
    code = "TABLE = Path(__file__).with_name('table.csv')\nOTHER = import_module('found')\nDEEP = 'data/deep.csv'\n"
    made.write("mine.py", code)
    made.register("surefoot.metrics", sway="mine:X")
    seen = [now({}, made)]
    for name in ("table.csv", "found.py", "data/deep.csv", "table.csv"):
        made.write(name, f"of {len(seen)}\n")
        seen.append(now({}))
    assert len({one["hand-made"] for one in seen}) == 5
    made.write("runs/log.mcap", "a result\n")
    assert now({}) == seen[-1]


@pytest.mark.unit
def test_code_elsewhere_counts_where_it_is_installed_in_place_and_versions_of_all_that_is_required(site, mine, now):
    """An installation with -e leaves a list of files in which the code is not."""
    mine.register("surefoot.tasks", part="my_package.parts:X")
    listed = mine.folder / "my_package-1.0.dist-info"
    (listed / "RECORD").write_text("__editable__.my_package.pth,,\nmy_package-1.0.dist-info/METADATA,,\n")
    for made in (common := site("our-common"), copied := site("copied")):
        made.write(f"{made.folder.name.replace('-', '_')}.py", "X = 1\n")
    (copied.folder / "copied-1.0.dist-info" / "RECORD").write_text("copied.py,,\n")
    needs = "Requires-Dist: Our_Common>=1\nRequires-Dist: copied; extra == 'x'\nRequires-Dist: surefoot\n"
    with (listed / "METADATA").open("a") as file:
        file.write(needs + "Requires-Dist: nowhere\n")

    first = now({"part"}, mine, common, copied)
    assert set(first) == {"my-package", "our-common", "copied"}
    assert first["copied"] == "1.0"
    changed = []
    for made, name in ((mine, MODULE), (common, "our_common.py")):
        made.write(name, "X = 2\n")
        changed.append(now({"part"}))
    assert changed[0]["my-package"] != first["my-package"]
    assert changed[1]["our-common"] != first["our-common"]


METRIC = '''
from surefoot.scenarios.judge.metric import RunView, metric


@metric()
def sway(run: RunView) -> float:
    """How much it sways."""
    return {}
'''
CAMPAIGN = """
scenario: paper-walk
set: {fidelity: pendulum, gait.steps: 1, gait.single_support: 0.6, gait.initial_stand: 0.2, rates.control: 100,
      criteria: {sway: {max: 1.5}}}
seeds: 1
"""


@pytest.mark.physics
def test_a_metric_that_changes_is_asked_again(site):
    made = site("swaying")
    made.write("swaying.py", METRIC.format("1.0"))
    made.register("surefoot.metrics", sway="swaying:sway")
    (made.folder.parent / "short.yaml").write_text(CAMPAIGN)
    found = []
    # Of another length, since Python takes a source of the same second and size for the one that it has compiled.
    for value in ("1.0", "1.0", "20.0"):
        made.write("swaying.py", METRIC.format(value))
        done = made.run("sweep", "short.yaml", "--jobs", "1", "--json")
        found.append((json.loads(done.stdout)["pass"], "another code" in done.stderr, done.stderr))
    journal = (made.folder.parent / "runs" / "short" / "runs.jsonl").read_text().splitlines()
    assert [passed for passed, *_ in found] == [1, 1, 0], found
    assert [json.loads(line)["status"] for line in journal] == ["pass", "fail"]
    assert [said for _, said, _ in found] == [False, False, True]
    assert all("when the code of swaying changes" in said for *_, said in found), "it says what it does not follow"
