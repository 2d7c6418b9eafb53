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
    from surefoot.wbc.body.ik import PostureIk, PostureResult, PostureTarget
    from surefoot.wbc.body.limits import JointLimits
    from surefoot.wbc.body.model import BodyFrames, RobotTerms
    from surefoot.wbc.contact.cone import Sole
    from surefoot.wbc.controller import WholeBodyController
    from surefoot.wbc.parameters import WbcParameters
    from surefoot.wbc.qp.data import QpData, QpLayout
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
            "contact.cone": ("Sole",),
            "controller": ("WholeBodyController",),
            "body.ik": ("PostureIk", "PostureResult", "PostureTarget"),
            "body.limits": ("JointLimits",),
            "body.model": ("BodyFrames", "RobotTerms"),
            "parameters": ("WbcParameters",),
            "qp.data": ("QpData", "QpLayout"),
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
