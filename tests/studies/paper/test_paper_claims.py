"""Verdicts follow from the numbers by the written rules, both ways."""

import pytest
from paper_samples import FALL, outcome, results

from surefoot.scenarios.setup.load import load
from surefoot.scenarios.setup.walk import resolve
from surefoot.studies.paper import studies
from surefoot.studies.paper.claims import JUDGES as RULES
from surefoot.studies.paper.claims import any_of, claims, grade, stable
from surefoot.studies.paper.studies import (
    HEIGHTS,
    NOISE_ALONE,
    NOISE_WALK,
    STAIRS,
    STEP_LAW,
    WALK,
    ZMP_ONLY,
    Experiment,
    knee_study,
    shove,
)

pytestmark = pytest.mark.unit

JUDGES = {claim.name: claim.judge for claim in claims()}


def verdict(name, *outcomes):
    return JUDGES[name](results(*outcomes)).verdict


@pytest.mark.parametrize(
    ("printed", "changed", "full", "expected"),
    [
        (True, True, True, "holds"),
        (True, None, None, "holds"),
        (False, True, True, "holds with a change"),
        (False, True, None, "holds with a change"),
        (False, True, False, "does not hold"),
        (True, True, False, "does not hold"),
        (False, False, True, "does not hold"),
        (None, True, True, "not measured"),
        (False, None, True, "not measured"),
    ],
)
def test_grade(printed, changed, full, expected):
    assert grade(printed, changed, full) == expected


def test_stable_needs_every_run_and_every_zmp_inside():
    def sample(*outcomes):
        return results(*outcomes).sample(WALK, "default", "pendulum")

    assert stable([sample(outcome(WALK))], 0.0)
    assert stable([sample(outcome(WALK, zmp_excursion_max=0.001))], 0.0) is False
    assert stable([sample(outcome(WALK, zmp_excursion_max=0.001))])
    assert stable([sample(outcome(WALK), outcome(WALK, seed=1, **FALL))]) is False
    assert stable([sample(outcome(WALK), outcome(WALK, seed=1, failure="no"))]) is None
    assert stable([sample()]) is None


def test_any_of():
    assert any_of([False, True, None])
    assert any_of([False, None]) is None
    assert any_of([False, False]) is False


def walks(paper, repaired, default, full):
    return (
        outcome(WALK, "paper", **paper),
        outcome(WALK, "repaired", **repaired),
        outcome(WALK, "default", **default),
        outcome(WALK, "default", "full", **full),
    )


def test_walking():
    assert verdict("claim-walk", *walks({}, {}, {}, {})) == "holds"
    assert verdict("claim-walk", *walks(FALL, {}, FALL, {})) == "holds with a change"
    assert verdict("claim-walk", *walks(FALL, FALL, FALL, {})) == "does not hold"
    assert verdict("claim-walk", *walks({}, {}, {}, FALL)) == "does not hold"
    assert verdict("claim-walk", *walks({"zmp_excursion_max": 0.001}, {}, {}, {})) == "holds with a change"
    assert verdict("claim-walk") == "not measured"


def test_hard_constraint():
    def both(paper, repaired):
        return (
            outcome(WALK, "paper", planner_infeasible_fraction=paper),
            outcome(WALK, "repaired", planner_infeasible_fraction=repaired),
        )

    assert verdict("claim-hard", *both(0.0, 0.0)) == "holds"
    assert verdict("claim-hard", *both(0.4, 0.0)) == "holds with a change"
    assert verdict("claim-hard", *both(0.4, 0.001)) == "does not hold"


def previews(flat, stairs):
    for study, ratio in ((WALK, flat), *((study, stairs) for study in STAIRS)):
        yield outcome(study, "lti", zmp_error_rms=[0.003 * ratio, 0.004 * ratio])
        yield outcome(study, "default")


def test_preview():
    assert verdict("claim-preview", *previews(2.0, 2.0)) == "holds"
    assert verdict("claim-preview", *previews(1.0, 2.0)) == "holds with a change"
    assert verdict("claim-preview", *previews(1.0, 1.0)) == "does not hold"
    lucky = outcome(WALK, "lti", seed=1, zmp_error_rms=[0.001, 0.001])
    assert verdict("claim-preview", lucky, *previews(3.0, 2.0)) == "holds with a change"
    assert verdict("claim-preview", *list(previews(1.0, 1.0))[:-1]) == "not measured"


def test_filter():
    def runs(alone, both):
        for profile in ("repaired", "default"):
            yield outcome(ZMP_ONLY, profile, **alone)
            yield outcome(NOISE_ALONE, profile, **both)
        yield outcome(NOISE_WALK, "default", "full")

    assert verdict("claim-filter", *runs({}, {})) == "holds"
    assert verdict("claim-filter", *runs(FALL, {})) == "holds with a change"
    assert verdict("claim-filter", *runs(FALL, FALL)) == "does not hold"


def test_frontal_effect():
    def runs(rms):
        for profile, world in (("repaired", "pendulum"), ("default", "pendulum"), ("default", "full")):
            yield outcome(WALK, profile, world, zmp_error_rms=[0.001, 0.001])
            yield from (outcome(study, profile, world, zmp_error_rms=rms) for study in HEIGHTS)

    assert verdict("claim-frontal", *runs([0.002, 0.004])) == "holds"
    assert verdict("claim-frontal", *runs([0.002, 0.002])) == "does not hold"


def shoves(fixed, moved, law):
    yield outcome(STEP_LAW, "paper", **law)
    for kind, largest in (("none", fixed), ("location", moved)):
        for direction in studies.SHOVE_DIRECTIONS:
            for impulse in studies.SHOVE_IMPULSES:
                yield outcome(shove(impulse, direction, kind), **({} if impulse <= largest else FALL))


def test_adaptation():
    assert verdict("claim-adaptation", *shoves(11, 14, FALL)) == "holds with a change"
    assert verdict("claim-adaptation", *shoves(12, 13, FALL)) == "does not hold"
    assert verdict("claim-adaptation", *shoves(12, 13, {})) == "holds"
    assert verdict("claim-adaptation", *list(shoves(11, 14, FALL))[:-1]) == "not measured"


def test_online():
    def slow(median):
        return {"planner_time": {"median": median, "p99": 2 * median}}

    assert verdict("claim-online", *walks(slow(0.001), {}, {}, slow(0.001))) == "holds"
    assert verdict("claim-online", *walks(slow(0.03), {}, {}, slow(0.001))) == "does not hold"


def knees(stretched, bent):
    for gait in studies.GAITS:
        for knee, metrics in (("stretched", stretched), ("bent", bent)):
            yield outcome(knee_study(gait, knee), "default", "full", **metrics)


@pytest.mark.parametrize(
    ("name", "metric"), [("claim-energy", "cost_of_transport"), ("claim-torque", "knee_torque_rms")]
)
def test_effort(name, metric):
    assert verdict(name, *knees({metric: 1.0}, {metric: 2.0})) == "holds"
    assert verdict(name, *knees({metric: 1.0}, {metric: 1.04})) == "does not hold"
    assert verdict(name, *knees({metric: 1.0}, {metric: 2.0, "speed_mean": 0.2})) == "not measured"
    assert verdict(name, *knees({}, FALL)) == "not measured"
    slow, fast = list(knees({metric: 1.0}, {metric: 2.0}))[:2], list(knees({metric: 2.0}, {metric: 1.0}))[2:]
    assert verdict(name, *slow, *fast) == "holds with a change"


@pytest.mark.parametrize("gait", studies.GAITS)
def test_knees_are_compared_with_equal_steps_and_equal_feet(gait):
    found = [Experiment(knee_study(gait, knee), "default", "full") for knee in studies.KNEES]
    stretched, bent = (load(one.study.base, list(one.overrides)) for one in found)
    assert stretched.gait == bent.gait
    assert stretched.gait.heel_strike > 0.0
    assert stretched.gait.heel_off > 0.0
    assert stretched.robot_options == bent.robot_options
    high, low = (resolve(keys) for keys in (stretched, bent))
    assert high.controller.knees.weight > 0.0
    assert low.controller.knees.weight == 0.0


def test_the_gait_of_0_8_is_measured():
    assert 0.8 in studies.GAITS.values()


def test_stretched_knees():
    assert verdict("claim-stretched", *knees({"knee_angle_mean": 0.3}, {})) == "holds"
    assert verdict("claim-stretched", *knees({"knee_angle_mean": 0.6}, {})) == "does not hold"


def test_every_claim_has_a_section_a_rule_and_an_anchor_of_its_own():
    every = claims()
    assert len({claim.name for claim in every}) == len(every)
    assert all(claim.section and claim.rule and claim.text for claim in every)
    assert {claim.name for claim in every} == {f"claim-{name}" for name in RULES}
    assert not any("{" in claim.rule for claim in every)
