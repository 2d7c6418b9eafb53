"""The tasks that every controller has."""

from surefoot.wbc.parameters import WbcParameters
from surefoot.wbc.tasks.balance import SupportRegion
from surefoot.wbc.tasks.momentum import AngularMomentum, CentreOfMass
from surefoot.wbc.tasks.swing import AnkleStops, SwingFoot
from surefoot.wbc.tasks.task import Task
from surefoot.wbc.tasks.trunk import HipStops, Pelvis, Torso


def default_tasks(
    parameters: WbcParameters,
    region: SupportRegion,
    edges: tuple[float, float],
    ankles: AnkleStops | None = None,
    hips: HipStops | None = None,
    waist: bool = True,
    leaning: bool = False,
) -> tuple[Task, ...]:
    """The tasks in the order of their rows.

    Args:
        parameters: weights and gains.
        region: where the ZMP may lie; its owner keeps it up to date.
        edges: toe edge and side edge from the sole's centre [m].
        ankles: where they end; None for nowhere.
        hips: where they end; None for nowhere.
        waist: whether the torso can move against the pelvis. Without one, they are one body, which the task of the
            pelvis holds. Twice the weight would throw the CoM up for a friction about the vertical that its yaw is not
            worth.
        leaning: whether feet roll as their legs do (see `surefoot.wbc.body.leaning`).
    """
    weights, gains, length = parameters.weights, parameters.gains, parameters.size.length
    trunk = (Pelvis(weights, gains, hips), Torso(weights, gains))
    return (
        CentreOfMass(weights, parameters.balance, region),
        AngularMomentum(weights, gains),
        *(trunk if waist else trunk[:1]),
        SwingFoot(weights, gains, edges, length, ankles, leaning),
    )
