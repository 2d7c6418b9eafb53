"""The warning of a fall: some plans on end have no margin, whatever steps are made."""

from surefoot.planner.parameters import RecoveryParameters
from surefoot.planner.types import Balance


def counted(before: Balance, movable: float, numbers: RecoveryParameters, uncertainty: float = 0.0) -> tuple[int, int]:
    """`Balance.lost` and `Balance.safe` of a plan with a margin after another plan.

    Args:
        before: of that other one.
        movable: how far the DCM is inside what steps that are moved capture [m].
        numbers: of the planner.
        uncertainty: how far the DCM may be from where it is estimated [m].
    """
    lost = before.lost + 1 if movable < -numbers.fall_margin else 0
    return lost, before.safe + 1 if movable >= uncertainty else 0


def falling(balance: Balance, before: bool, numbers: RecoveryParameters) -> bool:
    """Return true if a fall is coming: some plans on end show it, and some that have margin again take it back.

    Args:
        balance: of this plan.
        before: whether it was coming in the plan before.
        numbers: of the planner.
    """
    return balance.safe < numbers.regained_plans if before else balance.lost >= numbers.fall_plans
