"""Reasons why a policy falls: trials, mirror images, and the mend that lets it stand."""

import pytest

from surefoot.scenarios.policy.check import Tried, cause_of, check
from surefoot.scenarios.policy.contract import Contract
from surefoot.scenarios.policy.files import read
from surefoot.scenarios.policy.mends import FAULTS, reordered
from surefoot.scenarios.policy.mirror import Mirror
from surefoot.scenarios.policy.network import Network
from surefoot.scenarios.policy.trial import Trial, trial_of, trial_or_refusal


@pytest.fixture
def robot(policies):
    return policies.robot_of("g1")


@pytest.fixture
def held(policies, tmp_path, robot):
    """Contract and network of a policy that only stands."""
    still = {"v_x": [0, 0], "v_y": [0, 0], "yaw_rate": [0, 0]}
    files = read(policies.stander(tmp_path / "held", command=still), robot.joint_names)
    return files.contract, files.network


def swapped(contract: Contract, one: str, other: str) -> Contract:
    names = list(contract.joints)
    i, j = names.index(one), names.index(other)
    names[i], names[j] = names[j], names[i]
    return reordered(contract, names)


@pytest.mark.unit
def test_a_network_is_alike_on_both_sides_under_its_own_names_alone(held):
    contract, path = held
    network = Network(path)
    assert Mirror(contract, network).error(contract.joints) < 1e-9
    wrong = swapped(contract, "left_ankle_pitch_joint", "left_knee_joint")
    mirror = Mirror(wrong, network)
    assert mirror.error(wrong.joints) > 0.1
    i, j = (wrong.joints.index(name) for name in ("left_ankle_pitch_joint", "left_knee_joint"))
    assert mirror.better()[0] == (min(i, j), max(i, j))


@pytest.mark.unit
def test_every_mend_changes_one_thing_and_is_a_contract(held, robot):
    contract, _ = held
    seen = set()
    for fault in FAULTS:
        for change, mended in fault.mends(contract, robot):
            assert mended != contract, change
            Contract.model_validate(mended.model_dump())
            seen.add(fault.name)
    assert seen == {fault.name for fault in FAULTS} - {"history backward", "quaternion order"}


def tried(fault: str, **trial: float) -> Tried:
    values = {"stood": 4.0, "lasted": 4.0, "astray": 0.9, "leaned": 0.05, "jumped": 0.03, **trial}
    return Tried(next(one for one in FAULTS if one.name == fault), "", Trial(**values))


@pytest.mark.unit
def test_what_the_contract_shows_to_be_wrong_is_the_cause_where_mending_it_helps_at_all():
    given = tried("rate").trial
    better, other = tried("default posture", astray=0.6), tried("unit of the command", astray=0.1)
    assert cause_of(given, [better], known=True) is better
    assert cause_of(given, [better]) is None  # a mend that is guessed must do more
    assert cause_of(given, [better, other]) is other
    for worse in (tried("default posture", astray=0.95), tried("default posture", stood=3.9)):
        assert cause_of(given, [worse], known=True) is None
    assert cause_of(given, [], known=True) is None


@pytest.mark.physics
def test_a_trial_tells_a_contract_that_stands_from_one_that_falls(held, robot):
    contract, network = held
    assert trial_of(contract, network, "g1").sound
    action = contract.action.model_copy(update={"scale": -3.0})
    falls = trial_of(contract.model_copy(update={"action": action}), network, "g1")
    assert not falls.sound and falls.stood < falls.lasted and falls.cost > 10.0
    misfit = trial_or_refusal(contract.model_copy(update={"stiffness": (1.0,)}), network, "g1")
    assert not misfit.sound and "stiffness" in misfit.fault


@pytest.mark.long
@pytest.mark.physics
@pytest.mark.parametrize("wanted", ["gains", ""])
def test_a_planted_fault_is_named_and_none_where_there_is_none(held, robot, wanted):
    contract, network = held
    planted = {
        "gains": contract.model_copy(update={"stiffness": tuple(0.1 * k for k in contract.stiffness)}),
        "": contract,
    }[wanted]
    found = check(planted, network, robot)
    assert (found.cause.fault.name if found.cause else "") == wanted
    assert found.given.sound is not bool(wanted)
