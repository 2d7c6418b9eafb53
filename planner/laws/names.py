"""The profiles of the planner; their laws are imported when one is asked for."""

from typing import TYPE_CHECKING

from surefoot.parts.plugins import Declared

if TYPE_CHECKING:
    from surefoot.planner.laws.profiles import Profile

PROFILES: "Declared[Profile]" = Declared(
    "surefoot.profiles",
    {
        "default": "soft TVMPC with the footsteps in the QP",
        "paper": "the paper's TVMPC as printed",
        "repaired": "the paper's TVMPC with more moves and a terminal bound",
        "lti": "default without preview of the dynamics",
        "preview": "ZMP preview control of a cart-table",
        "dcm": "instantaneous DCM feedback, without a QP",
    },
    "surefoot.planner.laws.profiles",
)
"""Every profile by its name: those of this package, and those of other packages (see `surefoot.parts.plugins`)."""
