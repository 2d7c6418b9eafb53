"""Whole-body control on a Pinocchio model: tasks, contacts, limits and the inverse-dynamics QP.

A `WholeBodyController` turns a `RobotState`, a `WbcReference` and a `FootSensing` into joint torques:

    terms = controller.observe(state)
    report = controller.update(reference, sensing)

A stranger's `Task` (see `surefoot.wbc.tasks`) goes beside its own.
"""

from typing import TYPE_CHECKING

from surefoot.lazy import face

if TYPE_CHECKING:
    from surefoot.forces import ExternalLoad
    from surefoot.wbc.cone import Sole
    from surefoot.wbc.controller import WholeBodyController
    from surefoot.wbc.ik import PostureIk, PostureResult, PostureTarget
    from surefoot.wbc.limits import JointLimits
    from surefoot.wbc.model import BodyFrames, RobotTerms
    from surefoot.wbc.parameters import WbcParameters
    from surefoot.wbc.qp import QpData, QpLayout
    from surefoot.wbc.reference import WbcReference
    from surefoot.wbc.types import FootSensing, RobotState, SolveStatus, WbcAnswer, WbcReport

__all__ = [
    "BodyFrames",
    "ExternalLoad",
    "FootSensing",
    "JointLimits",
    "PostureIk",
    "PostureResult",
    "PostureTarget",
    "QpData",
    "QpLayout",
    "RobotState",
    "RobotTerms",
    "Sole",
    "SolveStatus",
    "WbcAnswer",
    "WbcParameters",
    "WbcReference",
    "WbcReport",
    "WholeBodyController",
]

if not TYPE_CHECKING:  # a type checker shall still refuse names that are not there
    __getattr__, __dir__ = face(
        __name__,
        {
            "cone": ("Sole",),
            "controller": ("WholeBodyController",),
            "ik": ("PostureIk", "PostureResult", "PostureTarget"),
            "limits": ("JointLimits",),
            "model": ("BodyFrames", "RobotTerms"),
            "parameters": ("WbcParameters",),
            "qp": ("QpData", "QpLayout"),
            "reference": ("WbcReference",),
            "types": (
                "ExternalLoad",
                "FootSensing",
                "RobotState",
                "SolveStatus",
                "WbcAnswer",
                "WbcReport",
            ),
        },
    )
