"""What sensors say by compiled kernels, which work in the arrays of their plain counterparts in `sim.readings`."""

from collections.abc import Sequence
from itertools import accumulate
from operator import attrgetter
from typing import TYPE_CHECKING, Any

import numpy as np

from surefoot.native.library import Bound, Library, place_of
from surefoot.sim.imu_motion import SMALL, ImuChain
from surefoot.sim.measurement import Array, Measurement

if TYPE_CHECKING:
    from surefoot.sim.readings import Drift, Encoders, Feet, Imu, Noise

_SEEN = ("joint_position", "joint_torque", "joint_velocity", "q", "v", "wrench")
_seen = attrgetter(*_SEEN)
"""What sensors see of a measurement."""


class CompiledSensors:
    """What all sensors say of a tick, in one call of kernels.

    The kernels write into memory of this object, of which each sample is a copy: it may be kept.

    Args:
        kernels: the library.
        imu: whose errors are added.
        encoders: likewise.
        feet: likewise; None of feet without sensors.
        block: ticks for which noise is drawn at once.
    """

    def __init__(self, kernels: Library, imu: "Imu", encoders: "Encoders", feet: "Feet | None", block: int) -> None:
        self._fill, self._block, self._row, joints = kernels.fill, block, 0, len(encoders.offset)
        self._noises: list[Noise] = []
        self._steps: list[Noise] = []
        self._drawn = self._fill("DrawnRows", noise=0, drift=-1)
        self._truth: Sequence[Array] = [np.zeros(size) for size in (joints, joints, joints, 7 + joints, 6 + joints, 12)]
        sizes = (3, 3, 3, joints, joints, *((joints,) if encoders.say_velocity else ()), *((12,) if feet else ()))
        self._memory = np.zeros(sum(sizes))
        self._parts = [slice(end - size, end) for end, size in zip(accumulate(sizes), sizes, strict=True)]
        out = [self._memory[part] for part in self._parts]
        self._encoders, self._chain = self._angles(encoders, out[3:6]), self._way(imu.chain)
        self._feet = None if feet is None else self._wrenches(feet, out[-1])
        bound = {"encoders_sample": self._encoders, "imu_sample": self._motion(imu, out[:3])}
        if self._feet is not None:
            bound["feet_sample"] = self._feet
        self._run = kernels.sequence([kernels.bind(name, struct) for name, struct in bound.items()])

    def __call__(self, truth: Measurement) -> list[Array]:
        """What IMU, encoders and feet say of the truth of the next tick."""
        position, torque, speed, q, v, wrench = self._truth
        # One by one: tuples of them take four times as long.
        if not (
            truth.joint_position is position
            and truth.joint_torque is torque
            and truth.joint_velocity is speed
            and truth.q is q
            and truth.v is v
            and truth.wrench is wrench
        ):
            self._look(truth)
        row, drawn = self._row, self._drawn.struct
        if row < 2:
            for noise in self._steps if row else self._noises:
                noise.refill()
        drawn.noise = row
        self._run()
        drawn.drift = row  # a bias has no step at the first tick
        self._row = (row + 1) % self._block
        memory = self._memory.copy()
        found = [memory[part] for part in self._parts]
        if self._feet is not None:
            found[-1] = found[-1].reshape(2, 6)
        return found

    def _look(self, truth: Measurement) -> None:
        """Look where the truth is; worlds measure into the same arrays at each tick, and kernels read them there."""
        arrays = [np.ascontiguousarray(array, dtype=np.float64) for array in _seen(truth)]
        for name, array, before in zip(_SEEN, arrays, self._truth, strict=True):
            if array.size != before.size:
                raise ValueError(f"{name} of a measurement has {array.size} numbers, where there are {before.size}")
        self._truth, encoders, chain = arrays, self._encoders.struct, self._chain.struct
        places = map(place_of, arrays)
        encoders.true_position, encoders.true_torque, encoders.true_velocity, chain.q, chain.v, wrench = places
        if self._feet is not None:
            self._feet.struct.true_wrench = wrench

    def _noise(self, noise: "Noise", of: "list[Noise] | None" = None) -> Bound:
        if not noise.silent:
            (self._noises if of is None else of).append(noise)
        return self._fill("Noise", size=noise.drawn[0].size, silent=noise.silent, drawn=noise.drawn)

    def _drift(self, drift: "Drift") -> Bound:
        return self._fill("Drift", steps=self._noise(drift.steps, self._steps), value=drift.value)

    def _angles(self, encoders: "Encoders", out: Sequence[Array]) -> Bound:
        position, torque, velocity = self._truth[:3]
        return self._fill(
            "Encoders",
            drawn=self._drawn,
            joints=len(encoders.offset),
            say_velocity=encoders.say_velocity,
            step=encoders.step,
            offset=encoders.offset,
            noise=self._noise(encoders.noise),
            # What is not said is not drawn either.
            velocity_noise=self._noise(encoders.velocity_noise, None if encoders.say_velocity else []),
            torque_noise=self._noise(encoders.torque_noise),
            true_position=position,
            true_velocity=velocity,
            true_torque=torque,
            position=out[0],
            torque=out[1],
            velocity=out[-1],  # which nothing is written to where none is said
        )

    def _way(self, chain: ImuChain) -> Bound:
        links = chain.links

        def side_by_side(name: str, dtype: Any = np.float64) -> Any:
            return np.array([getattr(link, name) for link in links], dtype=dtype).reshape(-1)

        return self._fill(
            "ImuChain",
            links=len(links),
            joint=side_by_side("joint", np.int64),
            beside=np.array([link.point is not None for link in links], dtype=np.int64),
            rotation=side_by_side("rotation"),
            lever=side_by_side("lever"),
            axis=side_by_side("axis"),
            twist=np.array([link.twist[0] for link in links]).reshape(-1),
            square=np.array([link.twist[1] for link in links]).reshape(-1),
            point=np.array([np.zeros(3) if link.point is None else link.point for link in links]).reshape(-1),
            mount=chain.mount,
            place=chain.lever,
            q=self._truth[3],
            v=self._truth[4],
        )

    def _motion(self, imu: "Imu", out: Sequence[Array]) -> Bound:
        return self._fill(
            "Imu",
            drawn=self._drawn,
            chain=self._chain,
            period=imu.period,
            small=SMALL,
            gravity=imu.gravity,
            rotation=np.zeros((3, 3)),
            velocity=np.zeros(3),
            gyro_bias=self._drift(imu.gyro_bias),
            gyro_noise=self._noise(imu.gyro_noise),
            force_bias=self._drift(imu.force_bias),
            force_noise=self._noise(imu.force_noise),
            most_rate=imu.most_rate,
            most_force=imu.most_force,
            rate=out[0],
            mean_rate=out[1],
            force=out[2],
        )

    def _wrenches(self, feet: "Feet", out: Array) -> Bound:
        return self._fill(
            "Feet",
            drawn=self._drawn,
            bias=self._drift(feet.bias),
            noise=self._noise(feet.noise),
            true_wrench=self._truth[5],
            wrench=out,
        )
