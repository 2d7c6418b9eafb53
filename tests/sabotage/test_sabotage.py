"""The criteria of the catalogue tell a worse controller from the sound one, and `surefoot check` all that is broken."""

from pathlib import Path

import pytest
from controllers import SABOTAGES
from sabotages import ALL
from table import first_that_catches, of_make_check, short_first

import surefoot
from surefoot.scenarios.catalogue import CONTROLS, OURS, OWN
from surefoot.scenarios.check.check import cases, run_case

EXPECTED = {
    "friction times 1.5": ("control-slide", "failed", "foot_slip_max is 0.0"),
    "no self-collision": ("control-push", "failed", "self_contact_time is 0 s, bound is at least"),
    "DCM gain 2.4 in place of 3": ("control-push", "moved", "balance: largest distance of the CoM along the ground"),
    "orientation gains halved": ("control-push", "moved", "largest tilt of the torso"),
    "motors 1.5 times as strong": ("control-fall", "moved", "the world's motor_force is 13818.0, 9212.0 in"),
    "fall detector never fires": ("control-fall", "failed", "fell is false, must be true"),
    "slip metric halved": ("control-slide", "failed", "foot_slip_max is 0.01"),
    "bounds of criteria 5 % wider": ("control-slide", "failed", "the judge lets foot_slip_max pass with a bound that"),
    "slip of the right foot not seen": ("control-slide", "moved", "largest way of the right foot on the ground"),
    "left foot's moment 2 % off": ("control-slide", "moved", "moment of the ground on the left sole about its"),
    "encoders' errors doubled": ("control-sensors", "failed", "tilt_estimation_error_rms is 0.0026"),
    "no reading is lost": ("control-sensors", "moved", "moment of the ground on the right sole about its"),
    "motors at once": ("control-motors", "failed", "foot_slip_max is 0.00"),
    "joints without friction": ("control-motors", "failed", "foot_slip_max is 0.002"),
}
"""Reasons of a control in a kinder world and with a blunt judge: which, how, and its first words."""


def reasons(name: str, sabotage: str | None, folder: Path) -> tuple[str, ...]:
    """Reasons why a scenario fails with a controller that was made worse, or with the sound one."""
    parts = surefoot.Parts(controller=SABOTAGES[sabotage]) if sabotage else None
    return surefoot.run(name, out=folder, parts=parts).verdict.reasons


@pytest.mark.physics
@pytest.mark.parametrize("sabotage", EXPECTED)
def test_a_control_sees_a_kinder_world_and_a_blunt_judge(sabotage, tmp_path):
    """Without one each control is the same as its baseline, to which `make check` holds it."""
    name, status, said = EXPECTED[sabotage]
    (case,) = cases([name])
    with ALL[sabotage].at_work():
        found = run_case(case, tmp_path)
    assert found.status == status
    told = [*found.reasons, *(one.text for one in found.partings), *(one.name for one in found.moves)]
    assert told[0].startswith(said)


@pytest.mark.long
@pytest.mark.parametrize("sabotage", ALL)
def test_nothing_broken_passes_the_whole_catalogue(sabotage):
    assert first_that_catches(sabotage, short_first(list(OURS))) != "-"


@pytest.mark.unit
def test_make_check_has_the_controls():
    assert set(CONTROLS) < set(of_make_check()) < set(OURS)


@pytest.mark.long
@pytest.mark.parametrize("name", OWN)
def test_every_scenario_passes_as_it_is_and_catches_a_worse_controller(name, tmp_path):
    assert reasons(name, None, tmp_path) == ()
    caught = [sabotage for sabotage in SABOTAGES if reasons(name, sabotage, tmp_path)]
    assert caught


@pytest.mark.long
@pytest.mark.parametrize("sabotage", SABOTAGES)
def test_every_sabotage_is_caught_where_the_robot_is_near_its_limits(sabotage, tmp_path):
    assert reasons("stairs-tall", sabotage, tmp_path)
