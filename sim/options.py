"""The contents of a simulated world, in the few numbers by which two worlds are distinguished."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from surefoot.engines.windowless import mujoco

Option = float | str | list[float] | list[str]

_ROBOT, _GROUND = "robot", "ground"

_BODY_BITS = 16
"""Bits of the higher body in the signature of two whose contacts are excluded."""


def world_options(mjcf: str) -> Mapping[str, Option]:
    """The options of a world as MuJoCo has compiled it, by name.

    They are solver and medium one by one, and for ground and robot the distinct values of what shapes a contact, row
    after row. Then come the numbers of pairs of geoms that may touch. Of what is there once for each body, joint or
    motor they have the sum of the magnitudes.

    Args:
        mjcf: text of the world.

    Raises:
        ValueError: it cannot be compiled.
    """
    model = mujoco.MjModel.from_xml_string(mjcf)
    return {**_solver(model), **_contacts(model), **_body(model)}


def _solver(model: mujoco.MjModel) -> dict[str, Option]:
    option = model.opt
    return {
        "gravity": option.gravity.tolist(),
        "wind": option.wind.tolist(),
        "density": option.density,
        "viscosity": option.viscosity,
        "timestep": option.timestep,
        "integrator": mujoco.mjtIntegrator(option.integrator).name,
        "cone": mujoco.mjtCone(option.cone).name,
        "solver": mujoco.mjtSolver(option.solver).name,
        "iterations": option.iterations,
        "tolerance": option.tolerance,
        "impratio": option.impratio,
        "disabled": _flags(mujoco.mjtDisableBit, option.disableflags),
        "enabled": _flags(mujoco.mjtEnableBit, option.enableflags),
    }


def _flags(kind: Any, bits: int) -> list[str]:
    """Names of the flags that are set; the last member of a kind counts them."""
    return [name for name, flag in kind.__members__.items() if bits & flag.value and not name.startswith("mjN")]


def _contacts(model: mujoco.MjModel) -> dict[str, Option]:
    touching = (model.geom_contype | model.geom_conaffinity) != 0
    found: dict[str, Option] = {}
    for name, geoms in ((_GROUND, touching & (model.geom_bodyid == 0)), (_ROBOT, touching & (model.geom_bodyid != 0))):
        places = np.concatenate((model.geom_size, model.geom_pos, model.geom_quat), axis=1)
        found |= {
            f"{name}_geoms": int(geoms.sum()),
            f"{name}_shapes": float(np.abs(places[geoms]).sum()),
            f"{name}_friction": _distinct(model.geom_friction[geoms]),
            f"{name}_solref": _distinct(model.geom_solref[geoms]),
            f"{name}_solimp": _distinct(model.geom_solimp[geoms]),
            f"{name}_margin": _distinct(np.column_stack((model.geom_margin, model.geom_gap))[geoms]),
            f"{name}_priority": _distinct(np.column_stack((model.geom_priority, model.geom_condim))[geoms]),
        }
    return {**found, **_pairs(model)}


def _pairs(model: mujoco.MjModel) -> dict[str, Option]:
    """Numbers of pairs of geoms that may touch, of the robot with the ground and with itself; named pairs beside."""
    one, other = np.triu_indices(model.ngeom, 1)
    kinds, accepted = model.geom_contype, model.geom_conaffinity
    may = ((kinds[one] & accepted[other]) | (kinds[other] & accepted[one])) != 0
    pairs = np.sort(np.column_stack((model.geom_bodyid[one], model.geom_bodyid[other])), axis=1)[may]
    low, high = pairs[:, 0], pairs[:, 1]
    kin = (low == high) | ((low > 0) & (model.body_parentid[high] == low))
    apart = kin | np.isin((low << _BODY_BITS) + high, model.exclude_signature)
    return {
        "pairs_ground": int((~apart & (low == 0)).sum()),
        "pairs_self": int((~apart & (low > 0)).sum()),
        "pairs_named": model.npair,
    }


def _body(model: mujoco.MjModel) -> dict[str, Option]:
    sums = {
        "mass": model.body_mass,
        "inertia": model.body_inertia,
        "mass_places": model.body_ipos,
        "body_places": model.body_pos,
        "joint_damping": model.dof_damping,
        "joint_armature": model.dof_armature,
        "joint_friction": model.dof_frictionloss,
        "joint_stiffness": model.jnt_stiffness,
        "joint_range": model.jnt_range,
        "motor_force": model.actuator_forcerange,
        "motor_control": model.actuator_ctrlrange,
        "motor_gear": model.actuator_gear,
        "motor_gain": model.actuator_gainprm,
        "motor_bias": model.actuator_biasprm,
        "joint_force": model.jnt_actfrcrange,
    }
    counts: dict[str, Option] = {"joints": model.njnt, "motors": model.nu, "constraints": model.neq}
    if model.neq:
        sums |= {
            "constraint_laws": model.eq_data,
            "constraint_solref": model.eq_solref,
            "constraint_solimp": model.eq_solimp,
        }
    return {**counts, **{name: float(np.abs(values).sum()) for name, values in sums.items()}}


def _distinct(rows: NDArray[np.float64]) -> list[float]:
    """The distinct rows in order, one after another."""
    return [float(value) for value in np.unique(rows, axis=0).ravel()] if len(rows) else []
