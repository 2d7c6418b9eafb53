"""docs/architecture.md is true: names, rooms, links, and the way of a tick and of a push."""

import ast
import re
from pathlib import Path
from unittest.mock import MagicMock

import pytest
from dotted import named

from surefoot.planner.types import Foot, PhaseInfo, PhaseKind
from surefoot.scenarios.file.schema import PushSettings
from surefoot.scenarios.run.skeleton import ClosedLoop
from surefoot.scenarios.run.tick import Spent
from surefoot.scenarios.setup.load import load
from surefoot.scenarios.setup.walk import resolve

pytestmark = pytest.mark.unit

ROOT = Path(__file__).parents[2]
TEXT = (ROOT / "docs" / "architecture.md").read_text(encoding="utf-8")
PICTURE = re.search(r"(?s)```\n(Scenario .*?)```", TEXT)[1]
ROOMS = ("planner", "wbc", "sim", "models", "scenarios", "studies", "apps")


def classes():
    """Names of all classes of the code, each with those of its methods."""
    found = {}
    for files in ((ROOT / "surefoot").rglob("*.py"), *((ROOT / room).rglob("*.py") for room in ROOMS)):
        for file in files:
            for node in ast.parse(file.read_text(encoding="utf-8")).body:
                if isinstance(node, ast.ClassDef):
                    found.setdefault(node.name, set()).update(
                        e.name for e in node.body if isinstance(e, ast.FunctionDef)
                    )
    return found


@pytest.mark.parametrize(
    "name", sorted(set(re.findall(r"`((?:planner|wbc|sim|models|scenarios|studies|apps|surefoot)\.[\w.]+\w)`", TEXT)))
)
def test_code_is_there(name):
    assert named(name) is not None


STATIONS = {"RULES": "gone_through", "the law": "plan"}
"""Stations that a tick calls by another name."""


def called(function):
    """Names of what a function calls, in the order in which that happens."""

    class Calls(ast.NodeVisitor):
        names = ()

        def visit_Call(self, node):
            self.generic_visit(node)
            self.names += (ast.unparse(node.func).split(".")[-1],)

    calls = Calls()
    calls.visit(function)
    return calls.names


def test_a_measurement_goes_through_the_stations_in_their_order():
    rows = re.search(r"(?s)\| station \|.*?\n\n", TEXT)[0].splitlines()[2:]
    told = [re.findall(r"`(?:\w+\.)*(\w+)`", row.split("|")[1]) or ["the law"] for row in rows if row]
    stations = [STATIONS.get(name, name) for names in told for name in names]
    assert len(told) <= 10
    code = ast.parse((ROOT / "planner" / "planner.py").read_text(encoding="utf-8"))
    parts = {node.name: called(node) for node in ast.walk(code) if isinstance(node, ast.FunctionDef)}
    way = [part for name in parts["update"] for part in (*parts.get(name, ()), name)]
    way = [part for name in way for part in (*(parts[name] if name.startswith("_") else ()), name)]
    assert [name for name in way if name in stations] == stations


def test_a_name_that_is_not_there_is_found_out():
    assert named("scenarios.setup.walk.no_such_function") is None
    assert named("sim.world.World.shove") is None


def test_what_the_picture_names_is_there():
    known = classes()
    words = re.findall(
        r"\b([A-Z][a-z]\w*[A-Z]\w*|Scenario|Ground|Formulation|Walk|Walker|World|Planning|Measurement|Log)(?:\.(\w+))?",
        PICTURE,
    )
    assert len(words) > 30
    for word, method in words:
        assert word in known or word in {"MuJoCo", "CoM"}, word
        assert not method or method in known[word], f"{word}.{method}"


def test_the_picture_goes_through_a_tick_in_the_order_of_the_loop():
    calls = MagicMock()
    calls.walker.sense.side_effect = lambda tick, now: tick
    calls.walker.control.return_value, calls.walker.fallen.return_value = (None, Spent()), False
    ClosedLoop(calls.walker, calls.recorder, 500, 1.0).step()
    called = [name.split(".") for name, *_ in calls.mock_calls]
    drawn = re.findall(r"(?m)^ (\w+\.\w+) +\d+ Hz", PICTURE)
    assert drawn == [f"Walker.{part[1]}" for part in called if part[0] == "walker" and len(part) == 2]


def test_every_room_of_the_planner_is_on_the_page():
    rooms = {path.parent.name for path in (ROOT / "planner").glob("*/__init__.py")}
    assert set(re.findall(r"(?m)^\| `(\w+)/` \|", TEXT)) == rooms


def test_equation_12_is_where_the_page_says():
    files = [file for file in (ROOT / "planner").rglob("*.py") if "eq. (12)" in file.read_text(encoding="utf-8")]
    assert files == [ROOT / "planner" / "references" / "zmp_reference.py"]


def test_the_push_of_the_page_becomes_what_the_page_says():
    scenario = load("walk-level")
    step, fraction = 4, 0.5
    text = "{step: 4, phase: single, fraction: 0.5, force: [40, 0, 0]}"
    assert f"`pushes: [{text}]`" in TEXT
    keys = PushSettings(step=step, phase="single", fraction=fraction, force=[40.0, 0.0, 0.0])
    walk = resolve(scenario.model_copy(update={"pushes": (keys,)}))
    ((point, push),) = walk.gait_pushes
    middle = PhaseInfo(PhaseKind.SINGLE, Foot.RIGHT, step, 0.2, 0.5, step, 0.3)
    assert point.left(middle) == pytest.approx(fraction * 0.5 - 0.2)
    assert push.body == walk.robot.torso_body
    assert push.force.tolist() == [40.0, 0.0, 0.0]


def anchors(page):
    """Anchors to which a link may point in a page: its headings as GitHub names them."""
    heads = re.findall(r"(?m)^#+ (.*)$", page.read_text(encoding="utf-8"))
    return {re.sub(r"[^\w\- ]", "", head.lower()).replace(" ", "-") for head in heads}


@pytest.mark.parametrize(
    "page", ["README.md", "CONTRIBUTING.md", *(f"docs/{p.name}" for p in (ROOT / "docs").glob("*.md"))]
)
def test_links_lead_to_a_heading(page):
    path = ROOT / page
    for target, heading in re.findall(r"\]\(([^)#:]*)#([^)]+)\)", path.read_text(encoding="utf-8")):
        assert heading in anchors(path.parent / target if target else path), f"{target}#{heading}"
