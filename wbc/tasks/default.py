"""The tasks that every controller has."""

from surefoot.wbc.parameters import BalanceGains, TaskGains, TaskWeights
from surefoot.wbc.tasks.balance import SupportRegion
from surefoot.wbc.tasks.momentum import AngularMomentum, CentreOfMass
from surefoot.wbc.tasks.swing import AnkleStops, SwingFoot
from surefoot.wbc.tasks.task import Task
from surefoot.wbc.tasks.trunk import HipStops, Pelvis, Torso


def default_tasks(
    weights: TaskWeights,
    gains: TaskGains,
    balance: BalanceGains,
    region: SupportRegion,
    edges: tuple[float, float],
    length: float,
    ankles: AnkleStops | None = None,
    hips: HipStops | None = None,
    waist: bool = True,
    leaning: bool = False,
) -> tuple[Task, ...]:
    """The tasks in the order of their rows.

    Args:
        weights: of the tasks.
        gains: of the tasks.
        balance: gains of the CoM law.
        region: where the ZMP may lie; its owner keeps it up to date.
        edges: toe edge and side edge from the sole's centre [m].
        length: size of the robot (see `surefoot.similarity`) [-].
        ankles: where they end; None for nowhere.
        hips: where they end; None for nowhere.
        waist: whether the torso can move against the pelvis. Without, they are one body, which the pelvis's task holds:
            twice the weight would throw the CoM up for a friction about the vertical that its yaw is not worth.
        leaning: whether feet roll as their legs do (see `surefoot.wbc.body.leaning`).
    """
    trunk = (Pelvis(weights, gains, hips), Torso(weights, gains))
    return (
        CentreOfMass(weights, balance, region),
        AngularMomentum(weights, gains),
        *(trunk if waist else trunk[:1]),
        SwingFoot(weights, gains, edges, length, ankles, leaning),
    )
