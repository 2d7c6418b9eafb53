"""The filter of the estimator on a log of other authors, and beside what another filter made of it.

    python -m benchmarks.foreign LOG TRUTH [--beside STATES] [--every TICKS]

LOG is text in the form of the published invariant filter (Hartley et al., github.com/RossHartley/invariant-ekf): lines
`IMU t w a`, `CONTACT t id c id c`, and `KINEMATIC t` with id, quaternion (w first), place and covariance (6 x 6, turn
first) of each foot in the frame of the IMU. TRUTH and STATES have a line per IMU reading: time, rotation by rows,
velocity, position. The first line of TRUTH is where the filter starts.
"""

import argparse
import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from benchmarks.table import Section
from surefoot.wbc.estimation.invariant_filter import GATES, InvariantFilter
from surefoot.wbc.estimation.parameters import GroundNoise, SensorNoise
from surefoot.wbc.estimation.stand import AXES, TURN, VELOCITY, Stand

Array = NDArray[np.float64]

IMU = {"gyro_density": 0.01, "accelerometer_density": 0.1, "gyro_walk": 1e-5, "accelerometer_walk": 1e-4}
"""Noise of the IMU, as the published example has it; that of a standing foot is `CREEP`."""

CREEP = 0.01

TURNING = 1.0
"""A foot that rocks tells nothing by its orientation [rad]."""

_GATES = (math.inf, GATES[1])
"""Gates for one foot of which the log says that it stands, as the published filter does."""

START = (1e-3, 1e-2)
"""Deviations of attitude and velocity at the start [rad, m/s]."""


@dataclass(frozen=True)
class ForeignLog:
    """A log: IMU rows (t, w, a), shape (n, 7); contacts, shape (n, 2); kinematics, shape (n, 2, 44)."""

    imu: Array
    contact: NDArray[np.bool_]
    kinematics: Array

    @classmethod
    def of(cls, path: Path) -> "ForeignLog":
        """Read a log of two feet, whose ids are 0 and 1."""
        rows: dict[str, list[list[float]]] = {"IMU": [], "CONTACT": [], "KINEMATIC": []}
        for line in path.read_text().splitlines():
            kind, *values = line.split()
            rows[kind].append([float(value) for value in values])
        contact = np.array(rows["CONTACT"])[:, [2, 4]] > 0.5
        return cls(np.array(rows["IMU"]), contact, np.array(rows["KINEMATIC"])[:, 1:].reshape(-1, 2, 44))

    def sole(self, tick: int) -> tuple[Array, Array]:
        """Places, shape (2, 3) [m], and orientations, shape (2, 3, 3), of the feet in the frame of the IMU."""
        row = self.kinematics[tick]
        turned = [pin.Quaternion(*row[k, 1:5].tolist()).normalized().matrix() for k in (0, 1)]
        return row[:, 5:8], np.stack(turned)


def states(log: ForeignLog, start: Array, every: int) -> Array:
    """States of the filter, rows as of TRUTH; covariance and gain are computed each `every` ticks."""
    time = log.imu[:, 0]
    place = float(np.sqrt(np.mean(np.diagonal(log.kinematics[:, :, 8:].reshape(-1, 6, 6)[:, 3:, 3:], 0, 1, 2))))
    sensors = SensorNoise(**IMU, accelerometer_bias=1e-2, mounting=0.0, encoder=0.0, encoder_offset=0.0)
    ground = GroundNoise(
        kinematics=place, turning=TURNING, creep=CREEP, sinking=CREEP, rocking=TURNING, light=1.0, model=0.0
    )
    R, v, p = start[1:10].reshape(3, 3), start[10:13], start[13:16]
    y, Y = log.sole(0)
    stand = Stand(R.copy(), np.vstack((v, p, p + y @ R.T)), R @ Y, np.zeros(3), np.zeros(3), np.zeros(AXES))
    filter_ = InvariantFilter(stand, sensors, ground)
    filter_.P[TURN, TURN] = START[0] ** 2 * np.eye(3)
    filter_.P[VELOCITY, VELOCITY] = START[1] ** 2 * np.eye(3)
    for k in (0, 1):
        filter_.lift(k)
    J = np.zeros((2, 6, AXES))
    found = np.empty((len(time), 16))
    for i in range(len(time)):
        if i:
            filter_.propagate(log.imu[i - 1, 1:4], log.imu[i - 1, 4:7], time[i] - time[i - 1])
        y, Y = log.sole(i)
        stands = log.contact[i].tolist()
        if i % every == 0 or stands != filter_.standing:
            filter_.spread((0.5, 0.5))
            for k in (0, 1):
                if filter_.standing[k] and not stands[k]:
                    filter_.lift(k)
                elif stands[k] and not filter_.standing[k]:
                    filter_.land(k, y[k], Y[k], J[k], None, place, TURNING)
            filter_.weigh(J)
        filter_.correct(y, Y, _GATES)
        found[i] = np.concatenate(([time[i]], stand.R.ravel(), stand.v, stand.p))
    return found


def errors(found: Array, truth: Array) -> tuple[float, float, float, float]:
    """RMS of position [mm], velocity [mm/s] and tilt, and yaw at the end [deg]."""
    apart = found - truth
    E = np.einsum("nij,nkj->nik", found[:, 1:10].reshape(-1, 3, 3), truth[:, 1:10].reshape(-1, 3, 3))
    turn = np.degrees([pin.log3(e) for e in E])
    place, speed = (1e3 * float(np.sqrt((apart[:, a : a + 3] ** 2).sum(axis=1).mean())) for a in (13, 10))
    return place, speed, float(np.sqrt((turn[:, :2] ** 2).sum(axis=1).mean())), float(turn[-1, 2])


def compared(log: ForeignLog, truth: Array, beside: Array | None, every: int) -> Section:
    """The table of both filters."""
    rows = [("of Surefoot, gain each tick", states(log, truth[0], 1))]
    rows.append((f"of Surefoot, gain each {every} ticks", states(log, truth[0], every)))
    if beside is not None:
        rows.append(("the other", beside))
    way = float(np.linalg.norm(truth[-1, 13:] - truth[0, 13:]))
    table = tuple((name, *errors(found, truth), 100.0 * _end(found, truth) / way) for name, found in rows)
    head = ("filter", "position mm", "velocity mm/s", "tilt deg", "yaw at the end deg", "drift %")
    note = f"{len(truth)} readings, {way:.2f} m of way"
    return Section("a log of other authors", head, table, note, {})


def _end(found: Array, truth: Array) -> float:
    return float(np.linalg.norm((found - truth)[-1, 13:]))


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("log", type=Path)
    parser.add_argument("truth", type=Path)
    parser.add_argument("--beside", type=Path, help="states that another filter made of the same log")
    parser.add_argument("--every", type=int, default=20, help="ticks from gain to gain in the second row")
    given = parser.parse_args()
    beside = np.loadtxt(given.beside) if given.beside else None
    print(compared(ForeignLog.of(given.log), np.loadtxt(given.truth), beside, given.every).text())


if __name__ == "__main__":
    main()
