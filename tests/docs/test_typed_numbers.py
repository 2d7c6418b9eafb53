"""Numbers of pages are generated or tested: what tables have else is named here with its reason, and becomes less."""

import ast
import csv
from pathlib import Path

import pytest
import yaml
from typed import Row, typed

from surefoot.apps.bridge import command, door, remote, serve
from surefoot.apps.drive.page import LIMITS
from surefoot.models.robot_file import document, files, quantities, shapes, urdf
from surefoot.planner.ground import terrain
from surefoot.planner.parameters import PlannerParameters
from surefoot.scenarios.judge import causes, computing_checks, motion_checks
from surefoot.scenarios.policy import mends, trial
from surefoot.scenarios.record.foxglove import drawing, views
from surefoot.scenarios.show.figures import ground, motion
from surefoot.scenarios.show.replay import content, video
from surefoot.studies.campaigns import against
from surefoot.studies.tour import rules, world
from surefoot.wbc.contact import external
from surefoot.wbc.contact.cone import Sole

pytestmark = pytest.mark.unit

ROOT = Path(__file__).parents[2]
PAGES = ["README.md", "CONTRIBUTING.md", *(path.relative_to(ROOT).as_posix() for path in (ROOT / "docs").rglob("*.md"))]


def _yaml(path):
    return yaml.safe_load((ROOT / f"{path}.yaml").read_text(encoding="utf-8"))


def _gaits():
    """Gaits of the push map."""
    natural = _yaml("studies/campaigns/campaigns/push-map")["grid"]["gait"]["natural"]
    feet = [100 * _yaml("scenarios/catalogue/walk")["robot_options"][f"foot_{side}"] for side in ("length", "width")]
    paper, small = (
        _yaml("scenarios/catalogue/diagonal-walk")["gait"],
        _yaml("scenarios/catalogue/stair-climbing")["robot_options"],
    )
    own = (natural[f"gait.{key}"] for key in ("step_length", "single_support", "double_support"))
    return (*own, *feet, paper["single_support"], paper["double_support"], 100 * small["foot_length"])


def _rigid():
    """Bounds in the other simulator, which need not be there."""
    tree = ast.parse((ROOT / "examples" / "other_simulator" / "compare.py").read_text(encoding="utf-8"))
    assigned = {ast.unparse(one.targets[0]): one.value for one in tree.body if isinstance(one, ast.Assign)}
    inside, error, flight = (next(iter(bound.values())) for bound in ast.literal_eval(assigned["RIGID"]).values())
    return {"zmp_inside_fraction": (inside,), "zmp_error_rms": (1e3 * error,), "unplanned_flight_time": (1e3 * flight,)}


def _size():
    """Size of an installation [GB]."""
    kept = (ROOT / "docs" / "results" / "pythons.csv").read_text(encoding="utf-8").splitlines()
    return round(max(float(row["MB"]) for row in csv.DictReader(kept[2:]) if row["MB"]) / 1e3, 1)


SHARE = 100 * Sole(0.1, 0.1, 0.8).cop_share
PLANNER = PlannerParameters()
FULL = world.RATE

CODED = {
    "CONTRIBUTING.md": {"make dist": (_size(),)},
    "docs/architecture.md": {
        "0.08 s before": (PLANNER.freeze_time, PLANNER.freeze_catching),
        "read_input": (LIMITS.x, LIMITS.y, LIMITS.yaw),
    },
    "docs/benchmark-g1.md": {
        "places": (rules.DURATION / rules.SLOT, rules.RADIUS, rules.CENTRE[0], rules.SLOT),
        "punch": (rules.DELAY, rules.PUNCH_TIME, 29),
        "its force": (round(rules.STRONGEST * rules.WEAKEST), rules.STRONGEST, rules.RAMP),
        "arms": (rules.ARM_SLOT, rules.ARM_STEPS, rules.ARM_STEP),
        "fall": (rules.LOWEST,),
        "physics": (1e3 / FULL,),
    },
    "docs/campaigns.md": {
        "1 | a run gave no result": (1, 100 * against.FALLEN),
        "timing": (PLANNER.recovery.longer,),
        "gait": _gaits(),
    },
    "docs/falling.md": {
        "push": (causes.LEAST_PUSH,),
        "ground": (1e3 * causes.LEAST_STEP,),
        "sensors": (1e3 * computing_checks.DRIFT,),
    },
    "docs/glossary.md": {"sole margin": (100 * PLANNER.foot_margin,)},
    "docs/other-simulator.md": _rigid(),
    "docs/reading-logs.md": {
        "contact_forces": (100 * motion_checks.FORCE_TOLERANCE,),
        "foot_slip": (1e3 * motion_checks.SLIP,),
        "touchdowns": (1e3 * motion_checks.LATE,),
        "zmp_margin": (SHARE, 100 * motion_checks.OUTSIDE),
        "joint_stops": (motion_checks.PAST_STOP,),
        "estimator": (1e3 * computing_checks.DRIFT,),
        "overruns": (100 * computing_checks.OVERRUNS,),
    },
    "docs/recovery.md": {
        "a step stays": (100 * terrain._KEPT,),
        "the last three alone, up": (external.BOUND[0],),
        "the last three alone, above": (external.PUSH[1],),
        "below 4 N": (external.KEPT[0], external.KEPT[0], 100 * external.WEIGHT[0]),
    },
    "docs/policies.md": {
        "error of the mean velocity": (trial.ASTRAY,),
        "mean tilt": (trial.LEANS,),
        "change of the targets": (trial.JUMPS,),
        "sign or scale of actions": (
            min(map(abs, mends.ACTION_FACTORS)),
            max(mends.ACTION_FACTORS),
            -min(mends.ACTION_FACTORS),
        ),
        "gains": (min(mends.GAIN_FACTORS), max(mends.GAIN_FACTORS)),
    },
    "docs/replay.md": {
        "Contact forces": (1000, 1000 * content.CONTACT_SCALE),
        "Pushes": (200, 200 * content.PUSH_SCALE, content.PUSH_SHOWN),
        "--speed": (video.SLOWEST, video.FASTEST, video.Film().speed),
    },
    "docs/reports.md": {"balance": (motion.STRIP,), "top-view": (ground.ROW,), "soles": (SHARE,)},
    "docs/robot-files.md": {
        "model": (document.MODEL.most >> 20, document.MOST_ELEMENTS, document.DEEPEST),
        "robot file": (document.ROBOT_FILE.most / 1e3,),
        "mesh": (
            document.MESH.most >> 20,
            document.MESH_TEXT.most >> 20,
            files.MOST_TEXT >> 20,
            files.MOST_COMPILED >> 20,
        ),
        "links": (urdf.MOST_LINKS, urdf.MOST_SHAPES),
        "triangles": (shapes.MOST_TRIANGLES / 1e6,),
        "numbers, decimal": (quantities.LENGTH / 1e3, quantities.MASS / 1e3, 10, 0.01, 100),
    },
    "docs/scenarios.md": {"stops of a joint": (motion_checks.PAST_STOP,)},
    "docs/serve.md": {
        "--watchdog": (0.1,),
        "--soft-start": (command.SOFT_START, 0),
        "the controller is killed": (serve.PATIENCE, serve.LET_DOWN, 1),
        "the plant is killed": (remote.PATIENCE, remote.SILENCE, 1),
        "a stranger": (door.PATIENCE,),
    },
    "docs/viewers.md": {
        "/scene/world": (0, views.SCENE_PERIOD),
        "/scene/forces": (1, 1 / drawing.METRES_PER_NEWTON, 20),
    },
}
"""Rows by the page and the beginning of the row: its numbers, in order, as the code has them."""

HELD = {
    ("README.md", "What walks"): "test_readme.py",
    ("docs/campaigns.md", "Campaigns"): "../studies/campaigns/test_against.py",
    ("docs/recovery.md", "Step adjustment"): "test_recovery_doc.py",
    ("docs/recovery.md", "The boxes of `LegReach.allowed`"): "test_recovery_doc.py",
    ("docs/robots.md", "Gallery"): "test_robots_doc.py",
    ("docs/robots.md", "How a scenario fits every robot"): "test_robots_doc.py",
    ("docs/whole-body.md", "Numbers"): "test_whole_body_doc.py",
}
"""Tables by the page and the heading: the module of tests that reads its tables."""

TYPED = {
    ("README.md", "Limits"): (1, "the speed is a range over machines"),
    ("docs/benchmark-g1.md", "The rules"): (2, "what the benchmark of others gives: its robot and its drives"),
    ("docs/decisions/blocked-moves-and-slack.md", "What else was considered"): (4, "a record of its time"),
    ("docs/decisions/compiled-values.md", "What else was considered"): (4, "a record of its time"),
    ("docs/decisions/feet-that-may-slide.md", "What else was considered"): (3, "a record of its time"),
    ("docs/decisions/kept-values.md", "What else was considered"): (18, "a record of its time"),
    ("docs/decisions/compiled-values.md", "Why"): (3, "a record of its time"),
    ("docs/decisions/legs-as-links.md", "What else was considered"): (3, "a record of its time"),
    ("docs/decisions/one-description.md", "What else was considered"): (1, "a record of its time"),
    ("docs/decisions/one-source.md", "What else was considered"): (18, "a record of its time"),
    ("docs/decisions/own-code-kept.md", "What else was considered"): (3, "a record of its time"),
    ("docs/decisions/place-and-time.md", "What else was considered"): (3, "a record of its time"),
    ("docs/decisions/two-solvers.md", "What else was considered"): (2, "a record of its time"),
    ("docs/drive.md", "The page"): (1, "how an arrow is drawn"),
    ("docs/paper.md", "The model"): (1, "numbers of errata"),
    ("docs/paper.md", "Planner profiles"): (1, "what the paper gives"),
    ("docs/paper.md", "Errata, with their evidence"): (5, "what the paper gives"),
    ("docs/paper.md", "The experiments"): (1, "what is walked"),
    ("docs/recovery.md", "From the solution to the plan"): (3, "how a number was chosen, of the walks of its time"),
    ("docs/recovery.md", "When nothing is left"): (6, "how a number was chosen, of the walks of its time"),
    ("docs/replay.md", "What is drawn"): (1, "how a path is drawn"),
    ("docs/robot-files.md", "What is derived"): (2, "how a model is read"),
    ("docs/sensors.md", "Presets"): (2, "data sheets and models of others"),
    ("docs/sensors.md", "Motors"): (1, "a model of others"),
    ("docs/recovery-results.md", "What each mechanism gives"): (8, "what was left out or changed, compared once"),
}
"""Exceptions by the page and the heading: how many rows, and why they are typed."""


def rows(page: str) -> list[Row]:
    return list(typed((ROOT / page).read_text(encoding="utf-8")))


def begins(row: Row, name: str) -> bool:
    """Return true if the first cell of a row begins so."""
    return row.text.lstrip("| `").startswith(name)


def loose(page: str) -> list[Row]:
    """Rows whose numbers nothing holds."""
    coded = CODED.get(page, {})
    return [
        row for row in rows(page) if (page, row.heading) not in HELD and not any(begins(row, name) for name in coded)
    ]


@pytest.mark.parametrize(("page", "name"), [(page, name) for page, names in CODED.items() for name in names])
def test_a_number_is_that_of_the_code(page, name):
    (row,) = [row for row in rows(page) if begins(row, name)]
    assert row.numbers == pytest.approx(CODED[page][name])


def test_every_typed_row_has_a_reason_and_there_are_no_more_of_them(capsys):
    found: dict[tuple[str, str], int] = {}
    for page in PAGES:
        for row in loose(page):
            found[page, row.heading] = found.get((page, row.heading), 0) + 1
    with capsys.disabled():
        print(f"\n{sum(found.values())} rows of tables have typed numbers")
    wanted = {place: count for place, (count, _) in TYPED.items()}
    assert found == wanted, "generate it, test it, or say why it is typed"


def test_what_holds_a_table_reads_its_page():
    for (page, heading), module in HELD.items():
        assert any(row.heading == heading for row in rows(page)), heading
        assert Path(page).name in (Path(__file__).parent / module).read_text(encoding="utf-8")


def test_a_typed_number_is_found():
    page = "# Page\n\n| a | b |\n|---|---|\n| walks | {} |\n"
    for number in ("0.62 m/s", "12 mm", "3 of 5", "44 %", "1.5 to 2", "0.7"):
        assert len(list(typed(page.format(number)))) == 1, number
        assert not list(typed(page.format(f"`{number}`")))
        assert not list(typed(page.replace("| a", "<!-- table: x -->\n| a").format(number) + "<!-- end -->\n"))
    for told in ("eq. (12)", "step 4", "LGPL-3.0", "<!-- value: x -->0.7 mm<!-- end -->", "exit code 2"):
        assert not list(typed(page.format(told))), told


def test_a_number_that_the_code_has_not_is_found():
    text = (ROOT / "docs/reading-logs.md").read_text(encoding="utf-8").replace("| 5 mm |", "| 6 mm |")
    (row,) = [row for row in typed(text) if begins(row, "foot_slip")]
    assert row.numbers != pytest.approx(CODED["docs/reading-logs.md"]["foot_slip"])
