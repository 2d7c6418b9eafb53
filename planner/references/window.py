"""The references over horizon and preview, before the motion is planned."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from surefoot.forces import ExternalLoad
from surefoot.planner.references.com_height import HeightPreview
from surefoot.planner.references.zmp_reference import ZmpReference
from surefoot.planner.types import GRAVITY, Array


@dataclass(frozen=True)
class Window:
    """References over the window of one tick, in the plan frame.

    Attributes:
        reference: ZMP reference that the footsteps define.
        driving: what of it drives the pendulum: the reference less `offset`.
        offset: what the swing leg and a lasting force add to the ZMP, shape (n, 2) [m].
        height: CoM height.
        stiffness: λ of the pendulum, softened by the legs' masses, shape (n,) [1/s^2].
        omega: ω of its DCM, shape (n,) [1/s].
        load_left: planned share of the weight on the left foot, shape (n,) [-].
        contacts: planned contacts (left, right), shape (n, 2).
    """

    reference: ZmpReference
    driving: ZmpReference
    offset: Array
    height: HeightPreview
    stiffness: Array
    omega: Array
    load_left: Array
    contacts: NDArray[np.bool_]


def lean(lasting: ExternalLoad, rotation: Array, height: HeightPreview) -> Array:
    """ZMP that a lasting force adds, by which the body has to lean into it, in the plan frame.

    The moment balance about the ZMP (see `planner.references.leg_offset`) with a force m f on the body and its moment
    m n about the CoM has, with h = c_z - p_z and λ = (g + z'') / h,

        p_x = c_x - c_x'' / λ + f_x / λ + n_y / (g + z''),      p_y = c_y - c_y'' / λ + f_y / λ - n_x / (g + z'').

    Args:
        lasting: the force, per mass.
        rotation: plan frame to world, shape (2, 2).
        height: CoM height over n samples.

    Returns:
        Shape (n, 2) [m].
    """
    x, y = lasting.moment[:2].tolist()
    turning = np.array([y, -x]) @ rotation
    pressing = GRAVITY + height.height[2]
    return np.asarray(lasting.force[:2] @ rotation / height.stiffness[:, None] + turning / pressing[:, None])
