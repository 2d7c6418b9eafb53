"""The profiles of the planner; their laws are imported when one is asked for."""

from typing import TYPE_CHECKING

from surefoot.parts.plugins import At, Declared

if TYPE_CHECKING:
    from surefoot.planner.laws.profiles import Profile

_HERE = "surefoot.planner.laws.profiles"

PROFILES: "Declared[Profile]" = Declared(
    "surefoot.profiles",
    f"{_HERE}:Profile",
    {
        "default": At("soft TVMPC with the footsteps in the QP", f"{_HERE}:DEFAULT"),
        "paper": At("the paper's TVMPC as printed", f"{_HERE}:PAPER"),
        "repaired": At("the paper's TVMPC with more moves and a terminal bound", f"{_HERE}:REPAIRED"),
        "lti": At("default without preview of the dynamics", f"{_HERE}:LTI"),
        "preview": At("ZMP preview control of a cart-table", f"{_HERE}:PREVIEW"),
        "dcm": At("instantaneous DCM feedback, without a QP", f"{_HERE}:DCM"),
    },
)
"""Every profile by its name: those of this package, and those of other packages (see `surefoot.parts.plugins`)."""
