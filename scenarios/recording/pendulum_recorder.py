"""Writes the pendulum's state and contacts into the channels that the whole body uses, as far as they apply."""

import math

import numpy as np
from numpy.typing import NDArray

from planner.frames import frame_rotation
from planner.sampling import PlanSample
from planner.types import GRAVITY, CentroidalState, FeetState
from scenarios.log import LogWriter, channels
from scenarios.log.channels import Sizes

Array = NDArray[np.float64]


class PendulumRecorder:
    """The channels of the pendulum."""

    def __init__(self, writer: LogWriter, sizes: Sizes, mass: float) -> None:
        """Open its channels; ``mass`` of the pendulum [kg]."""
        self._mass = mass
        self._truth = writer.channel(channels.point_truth(sizes))
        self._contact = writer.channel(channels.contact(sizes))

    def state(self, time_ns: int, state: CentroidalState, feet: FeetState, force: Array) -> None:
        """True state of a control tick and the push that follows it, shape (2,) [N]."""
        left, right = (_pose(position, float(yaw)) for position, yaw in zip(feet.position, feet.yaw, strict=True))
        self._truth.append(time_ns, state.com, state.com_velocity, left, right, (*force, 0.0))

    def contact(self, time_ns: int, zmp: Array, sample: PlanSample, feet: FeetState) -> None:
        """Contacts and the ZMP, shape (2,) [m]; as centre of pressure only where one foot has all the load."""
        weight = self._mass * (GRAVITY + float(sample.com_acceleration[2]))
        contacts, share = sample.contacts, sample.load_left
        height = share * feet.position[0, 2] + (1.0 - share) * feet.position[1, 2]
        cops = [(math.nan, math.nan), (math.nan, math.nan)]
        if not all(contacts):
            foot = int(contacts[1])
            cops[foot] = tuple((zmp - feet.position[foot, :2]) @ frame_rotation(float(feet.yaw[foot])))
        self._contact.append(
            time_ns, (*zmp, height), (share * weight, (1.0 - share) * weight), contacts, contacts, contacts, *cops
        )


def _pose(position: Array, yaw: float) -> tuple[float, ...]:
    return (*position.tolist(), 0.0, 0.0, math.sin(0.5 * yaw), math.cos(0.5 * yaw))
