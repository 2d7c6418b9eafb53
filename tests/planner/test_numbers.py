"""Every number of the planner has a unit, a reason, and a test or a sweep that notices it."""

import ast
import csv
import re
from collections.abc import Iterator
from dataclasses import fields
from itertools import product
from pathlib import Path

import pytest

import surefoot.planner
from surefoot.planner.parameters import RecoveryParameters

pytestmark = pytest.mark.unit

PLANNER = Path(surefoot.planner.__file__).parent
ROOT = Path(__file__).parents[2]
REASON = re.compile(r"[:;]| (?:as|and|so|which|since|because|beyond|before|where|that|for|what|until|at which|as of) ")

NOTICED = {
    "ground.terrain._KEPT": "tests/planner/ground/test_room.py",
    "ground.terrain._SHANK": "tests/planner/ground/test_room.py",
    "laws.footstep_qps.EXTRA": "tests/planner/laws/test_tvmpc.py",
    "laws.footstep_qps.SHIFTS": "tests/planner/laws/test_tvmpc.py",
    "geometry.plane._STRAIGHT": "tests/planner/geometry/test_polygon.py",
    "laws.bounded_qp.TOLERANCE": "tests/planner/laws/test_bounded_qp.py",
    "model.jerk.BLOCK_STARTS": "tests/planner/laws/test_tvmpc.py",
    "model.leg_points.ANKLES": "tests/planner/model/test_leg_chain.py",
    "model.leg_points.BESIDE": "tests/planner/model/test_leg_chain.py",
    "model.leg_points.FEET": "tests/planner/model/test_leg_chain.py",
    "model.leg_points.HIPS": "tests/planner/model/test_leg_chain.py",
    "model.leg_points.KNEES": "tests/planner/model/test_leg_chain.py",
    "model.leg_points.TRUNK": "tests/planner/model/test_leg_chain.py",
    "model.leg_points.LEFT": "tests/planner/model/test_leg_chain.py",
    "model.leg_points.MIDDLE": "tests/planner/model/test_leg_chain.py",
    "model.leg_points.RIGHT": "tests/planner/model/test_leg_chain.py",
    "plan.sample.POINT": "tests/planner/plan/test_sampling.py",
    "recovery.step_adjustment.NO_GAIN": "tests/planner/recovery/test_step_adjustment.py",
    "references.nominal_feet._SUNK": "tests/planner/references/test_nominal_feet.py",
    "plan.sampling.BENDS": "tests/planner/plan/test_sampling.py",
    "plan.sampling.COLUMNS": "tests/planner/plan/test_sampling.py",
    "plan.sampling.HEIGHT": "tests/planner/plan/test_sampling.py",
    "plan.sampling.LINEAR": "tests/planner/plan/test_sampling.py",
    "plan.sampling.LOAD": "tests/planner/plan/test_sampling.py",
    "plan.sampling.MOTIONS": "tests/planner/plan/test_sampling.py",
    "plan.sampling.OMEGA": "tests/planner/plan/test_sampling.py",
    "plan.sampling.RATES": "tests/planner/plan/test_sampling.py",
    "plan.sampling.STIFFNESS": "tests/planner/plan/test_sampling.py",
    "plan.sampling.SWING": "tests/planner/plan/test_sampling.py",
    "plan.sampling.ROUNDING": "tests/planner/plan/test_sampling.py",
    "steps.adaptation._SLID": "tests/planner/steps/test_slid_feet.py",
    "steps.schedule._LAID_OUT": "tests/planner/steps/test_laid_out.py",
    "steps.schedule._STOP_AHEAD": "tests/planner/steps/test_schedule.py",
    "steps.speed._DOUBLE": "tests/planner/steps/test_speed.py",
    "steps.speed._EASY": "tests/planner/steps/test_speed.py",
    "steps.speed._FLAT": "tests/scenarios/setup/test_speed_keys.py",
    "steps.speed._HEEL_OFF": "tests/scenarios/run/test_speed_walks.py",
    "steps.speed._HEEL_STRIKE": "tests/scenarios/run/test_speed_walks.py",
    "swing.sway.SOONEST": "tests/planner/swing/test_sway.py",
    "steps.speed._LIST": "tests/scenarios/setup/test_speed_keys.py",
    "steps.speed._FADING": "tests/planner/steps/test_speed.py",
    "steps.speed._STEADY": "tests/planner/steps/test_speed.py",
    "steps.speed._YAW": "tests/scenarios/setup/test_speed_keys.py",
    "steps.speed._LONG": "tests/planner/steps/test_speed.py",
    "steps.speed._LOWER": "tests/planner/steps/test_speed.py",
    "steps.speed._MOST_OFF": "tests/planner/steps/test_speed.py",
    "steps.speed._ROLLING": "tests/planner/steps/test_speed.py",
    "steps.speed._RISING": "tests/planner/steps/test_speed.py",
    "steps.speed._WALK_RATIO": "tests/planner/steps/test_speed.py",
    "swing.leg_reach.STRIDE": "tests/studies/tour/test_turned.py",
    "swing.quintics.PEAK": "tests/planner/swing/test_swing_limits.py",
    "swing.quintics.BRAKING": "tests/planner/swing/test_swing_limits.py",
    "swing.quintics.GAINING": "tests/planner/swing/test_swing_limits.py",
    "recovery.reach.BOXES": "tests/planner/recovery/test_step_adjustment.py",
    "recovery.reach.SHARES": "tests/planner/swing/test_swing_limits.py",
    "recovery.outlook.COLUMNS": "tests/planner/recovery/test_step_adjustment.py",
    "recovery.capture_margin.EDGES": "tests/planner/recovery/test_capture_margin.py",
}
"""Test, or folder of tests, that notices a constant when it is changed."""

UNNOTICED = {
    "check._AT_ONCE",
    "check._DISTINCT",
    "ground.blocks.LEVEL_STEPS",
    "references.zmp_reference._STRIP",
    "ground.terrain.DEEPER",
    "ground.terrain._ABOVE",
    "ground.terrain.HALF_WIDTH",
    "ground.tiles.AROUND",
    "ground.tiles.TILE",
    "ground.tiles._MIDDLE",
    "ground.tilt.FAR",
    "ground.tilt._THICK",
    "laws.dcm_feedback._GAIN",
    "laws.bounded_qp.DEPENDENT",
    "laws.bounded_qp.MOST_ROUNDS",
    "laws.qp._UNBOUNDED",
    "laws.zmp_preview._JERK_WEIGHT",
    "laws.zmp_preview._PREVIEW",
    "model.filter.DESIGN_SAMPLE",
    "model.leg_body._BEND",
    "model.leg_chain._REST",
    "model.time_scaling.CLOCK_ROUNDING",
    "model.time_scaling._LOOKED_AT",
    "model.time_scaling._SLOWEST",
    "recovery.capturability._ROUNDING",
    "references.com_height.BENT_KNEES",
    "references.com_height.DESCENT_SHARE",
    "references.com_height._FALL_LIMIT",
    "references.com_height._IMPULSE_LIMIT",
    "references.com_height._LEAST_HEIGHT",
    "references.height_transition._LOOKED_AT",
    "swing.sway._SAME_ANGLE",
    "swing.sway._SAME_TIME",
    "references.height_transition._ROUNDING",
    "model.leg_body._GUESS",
    "steps.commands.MOST_STEPS",
    "steps.commands._HALVINGS",
    "steps.commands._SAME_TIME",
    "steps.gait.WEIGHT_SHIFT",
    "flight._SAME_GROUND",
    "flight._LEAST_LEFT",
    "flight._SAME_PITCH",
    "flight._SAME_TARGET",
    "flight._IN_PLAN",
    "state._SAME_TIME",
    "track._LEAST_LEFT",
    "steps.schedule._MORE_STEPS",
    "steps.source.AWAY",
    "steps.source._ASTRAY",
    "steps.source._FAR",
    "steps.source._LESS",
    "steps.source._MOST_EQUAL",
    "steps.source._SHARE",
    "steps.source._SOFTLY",
    "steps.source._STRAIGHT",
    "steps.source._THERE",
    "steps.speed._MOST_STRIKE",
    "steps.speed._ROUNDED",
    "steps.step._LOOKED_AT",
    "steps.step._MEASURED",
    "swing.course.EDGE_CLEARANCE",
    "swing.course.EDGE_DISTANCE",
    "swing.course._APEXES",
    "swing.course._ENDS",
    "swing.course._INSTANTS",
    "swing.course._LEVEL",
    "swing.course._STARTS",
    "swing.rolling.LEVEL_AGAIN",
    "swing.rolling.BRAKING",
    "swing.rolling.LEAD",
    "swing.rolling.SINKING",
    "swing.rolling._BEGIN",
    "swing.rolling._END",
    "swing.rolling._FLAT",
    "swing.rolling._LEAST_STEP",
    "swing.rolling._LOOKED_AT",
    "swing.rolling._MOST",
    "swing.rolling._PER_WAY",
    "swing.rolling._DECIMALS",
    "swing.rolling._SAME_WAY",
    "swing.rolling._SHORT",
    "swing.step_region.LANDING_ROUNDING",
    "swing.step_region._UNUSED",
    "swing.trajectory.FEWEST_SWING_SAMPLES",
    "swing.trajectory.LEAST_GLIDE",
    "swing.trajectory.TOUCHING",
    "swing.trajectory._GLIDING",
    "swing.trajectory._MOST_LEAD",
}
"""Constants that no test is known to notice; a new one needs a test."""


IN_BODIES = {
    "check": {1e-9},
    "ground.terrain": {0.8},
    "laws.dcm_feedback": {6.0},
    "model.jerk": {6.0},
    "model.leg_body": {1e-6, 12.0},
    "model.nominal": {4.0, 6.0},
    "geometry.quintic": {3.0, 4.0, 5.0, 6.0, 7.0, 10.0, 12.0, 15.0, 20.0},
    "model.world_motion": {6.0},
    "recovery.capturability": {0.25},
    "recovery.capture_margin": {1e-9},
    "recovery.step_adjustment": {1e-9},
    "references.com_height": {3.0, 6.0, 10.0, 15.0, 30.0, 60.0},
    "references.height_transition": {6.0},
    "references.leg_offset": {6.0},
    "references.zmp_reference": {1e-12},
    "plan.sampling": {6.0},
    "steps.gait": {1e-9},
    "steps.step": {1e-9},
    "swing.rolling": {64.0, 192.0, 384.0},
    "recovery.reach": {6.0},
    "swing.quintics": {4.0, 9.0, 16.0, 20.0, 36.0, 60.0, 192.0, 360.0},
}
"""Bare numbers in functions: coefficients of polynomials and of differences, roundings, and defaults of arguments."""

PLAIN, LARGEST_SIZE = {0.0, 1.0, 2.0, 0.5}, 7
"""Numbers that say nothing by themselves, and the largest whole one that is the size of an array."""


def bare(node: ast.AST, inside: bool = False) -> Iterator[float]:
    """Numbers in the functions below a node, without indices, exponents, sizes and plain ones."""
    if isinstance(node, ast.Constant):
        value = node.value
        if inside and type(value) in (int, float) and value not in PLAIN:
            yield from () if isinstance(value, int) and value <= LARGEST_SIZE else (value,)
        return
    inside = inside or isinstance(node, ast.FunctionDef | ast.Lambda)
    for name, part in ast.iter_fields(node):
        index = isinstance(node, ast.Subscript) and name == "slice"
        exponent = isinstance(node, ast.BinOp) and isinstance(node.op, ast.Pow) and name == "right"
        for child in () if index or exponent else part if isinstance(part, list) else (part,):
            if isinstance(child, ast.AST):
                yield from bare(child, inside)


def is_number(value: ast.expr) -> bool:
    """Return true if an expression is made of numbers alone."""
    if isinstance(value, ast.Constant):
        return isinstance(value.value, int | float) and not isinstance(value.value, bool)
    if isinstance(value, ast.Tuple | ast.List):
        return bool(value.elts) and all(map(is_number, value.elts))
    if isinstance(value, ast.BinOp):
        return is_number(value.left) and is_number(value.right)
    return isinstance(value, ast.UnaryOp) and is_number(value.operand)


def constants() -> Iterator[tuple[str, str]]:
    """Names of the modules' numbers, from the planner on, and the text below each."""
    for path in sorted(PLANNER.rglob("*.py")):
        module = ".".join(path.relative_to(PLANNER).with_suffix("").parts)
        body = ast.parse(path.read_text()).body
        for line, following in zip(body, [*body[1:], None], strict=True):
            if not isinstance(line, ast.Assign) or not is_number(line.value):
                continue
            text = following.value if isinstance(following, ast.Expr) else None
            told = str(text.value) if isinstance(text, ast.Constant) else ""
            for name in (node.id for target in line.targets for node in ast.walk(target) if isinstance(node, ast.Name)):
                if name.isupper():
                    yield f"{module}.{name}", " ".join(told.split())


CONSTANTS = dict(constants())


def wanting(told: str) -> str:
    """Part that a constant's text lacks."""
    return "a unit" if not re.search(r"\[[^\]]+\]", told) else "" if REASON.search(told) else "a reason"


@pytest.mark.parametrize("name", CONSTANTS)
def test_a_constant_has_a_unit_and_a_reason(name):
    assert not wanting(CONSTANTS[name]), f"{name} lacks {wanting(CONSTANTS[name])}: {CONSTANTS[name]!r}"


def test_a_text_without_unit_or_reason_is_seen():
    assert wanting("Length of a step.") == "a unit"
    assert wanting("Length of a step [m].") == "a reason"
    assert not wanting("Length of a step, as the leg spans it [m].")


def test_no_number_hides_in_a_function():
    """A new one is a constant, with unit and reason, or a field of the parameters; or it is told above why not."""
    found = {}
    for path in sorted(PLANNER.rglob("*.py")):
        numbers = set(bare(ast.parse(path.read_text())))
        if numbers:
            found[".".join(path.relative_to(PLANNER).with_suffix("").parts)] = numbers
    assert found == IN_BODIES


def test_a_number_in_a_function_is_seen():
    text = "def reach(way, gain=0.3):\n    return way[12] ** 4 + 0.07 * np.zeros(6) - 2.0 * (0.5 + 40)"
    assert set(bare(ast.parse(text))) == {0.3, 0.07, 40}


def test_every_constant_has_a_witness():
    assert set(CONSTANTS) <= set(NOTICED) | UNNOTICED
    assert not set(NOTICED) & UNNOTICED
    missing = {name for name, test in NOTICED.items() if not (ROOT / test).exists()}
    assert not missing


def test_every_number_of_recovery_is_measured():
    """The campaign halves and doubles each, and the page shows the result; what moves nothing is noticed otherwise."""
    lines = (ROOT / "docs" / "results" / "recovery-numbers.csv").read_text().splitlines()
    kept = list(csv.DictReader(line for line in lines if not line.startswith("#")))
    names = [entry.name for entry in fields(RecoveryParameters)]
    wanted = {f"{name} {change}" for name in names for change in ("halved", "doubled")} | {"as they are"}
    cases = {row["case"] for row in kept}
    assert {(row["case"], row["number"]) for row in kept} == set(product(cases, wanted))
    page = (ROOT / "docs" / "recovery-results.md").read_text().split("## What each number moves")[1].split("\n#")[0]
    moved, still = page.split("No threshold is moved by")
    noticed = set(re.findall(r"`(\w+)`", still.split("<!-- end -->")[1]))
    unmoved = set(re.findall(r"`(\w+)`", still.split("<!-- end -->")[0]))
    assert unmoved <= noticed
    assert set(re.findall(r"`(\w+)` \|", moved)) | unmoved == set(names)


def test_the_page_tells_the_changes_of_time_that_are_tried():
    page = (ROOT / "docs" / "recovery.md").read_text()
    told = re.search(r"^-0\.6, .*\.$", page, flags=re.M)[0].rstrip(".")
    assert [float(value) for value in told.split(", ")] == pytest.approx(RecoveryParameters().time_changes)
