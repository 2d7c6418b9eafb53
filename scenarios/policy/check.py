"""Says why a policy falls: what of its contract, mended alone, lets it walk."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from surefoot.models.types import RobotDescription
from surefoot.scenarios.policy.contract import Contract
from surefoot.scenarios.policy.mends import FAULTS, Fault, swapped
from surefoot.scenarios.policy.mirror import Mirror
from surefoot.scenarios.policy.network import Network
from surefoot.scenarios.policy.trial import Trial, trial_or_refusal

MUCH = 0.6
"""Share of the cost of the contract as given under which a mend that does not walk yet counts as a cause [-]."""

ALIKE = 1.15
"""Share of the least cost up to which mends do as well; the first of them counts [-]."""


@dataclass(frozen=True, slots=True)
class Tried:
    """A contract with one thing mended.

    Attributes:
        fault: that is mended.
        change: what was changed.
        trial: what it did.
    """

    fault: Fault
    change: str
    trial: Trial


@dataclass(frozen=True, slots=True)
class Checked:
    """The findings on a contract.

    Attributes:
        given: what it did as given.
        tried: what it did with one thing mended, in the order in which they were tried; empty where it walks.
        cause: the first cause; None where it walks, or nothing mended alone helps.
        asymmetry: how far the network is from treating left and right alike; None where that is not known [-].
    """

    given: Trial
    tried: tuple[Tried, ...]
    cause: Tried | None
    asymmetry: float | None = None


def check(
    contract: Contract, network: Path, robot: RobotDescription, on_trial: Callable[[Tried], None] = lambda _: None
) -> Checked:
    """Try a contract, and, where it does not walk, each with one thing mended.

    Args:
        contract: that is checked.
        network: path of its network.
        robot: that it is for.
        on_trial: called with each as it was tried.
    """
    given = trial_or_refusal(contract, network, robot.name)
    mirror = _mirror(contract, network)
    asymmetry = None if mirror is None else mirror.error(contract.joints)
    if given.sound:
        return Checked(given, (), None, asymmetry)
    tried = []
    for fault, change, mended in _mends(contract, robot, mirror):
        one = Tried(fault, change, trial_or_refusal(mended, network, robot.name))
        tried.append(one)
        on_trial(one)
    suspected = [one for one in tried if one.fault.suspects(contract, robot)]
    cause = cause_of(given, suspected, known=True) or cause_of(given, tried)
    return Checked(given, tuple(tried), cause, asymmetry)


def _mirror(contract: Contract, network: Path) -> Mirror | None:
    try:
        return Mirror(contract, Network(network))
    except ValueError:
        return None


def _mends(contract: Contract, robot: RobotDescription, mirror: Mirror | None) -> Iterator[tuple[Fault, str, Contract]]:
    for fault in FAULTS:
        for change, mended in fault.mends(contract, robot):
            yield fault, change, mended
        if fault.name == "joint order" and mirror is not None:
            for change, mended in swapped(contract, mirror.better()):
                yield fault, change, mended


def cause_of(given: Trial, tried: Sequence[Tried], known: bool = False) -> Tried | None:
    """The first of those mends that do as well as the best one, if that helps.

    Args:
        given: the contract as given.
        tried: mends of it.
        known: whether the contract itself shows that this is wrong, so that whatever makes a walk better helps.
    """
    if not tried:
        return None
    least = min(one.trial.cost for one in tried)
    best = next(one for one in tried if one.trial.cost <= ALIKE * least)
    better = known and best.trial.up and best.trial.cost < given.cost
    helps = better or best.trial.sound or best.trial.cost < MUCH * given.cost
    return best if helps else None
