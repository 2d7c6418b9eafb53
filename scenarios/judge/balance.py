"""Metrics of balance: ZMP, centre of pressure, CoM and DCM against what was planned."""

import numpy as np

from surefoot.planner.model.dcm import dcm
from surefoot.scenarios.columns import Reads
from surefoot.scenarios.judge.body import feet_lean
from surefoot.scenarios.judge.digest import GAIT, SENSED, Array, Mask, Rows, RunView
from surefoot.scenarios.judge.metric import MM, OF_HALF_THE_FOOT, OF_THE_TIME, SHARE, metric, reduction
from surefoot.scenarios.judge.placed import to_truth

MARGIN = 0.9
"""Share of each foot that the planned ZMP may use, the paper's margin."""

PREDICTION = 0.2
"""Age of the plan that the true state is compared with [s]."""

_COP_READS: Reads = {"/contact": ("cop_left", "cop_right"), GAIT: ("phase", "stance")}
_ZMP_READS: Reads = {"/contact": ("zmp",), "/reference": ("zmp_reference",)}


_SUPPORTED = ("/truth", "/contact", "/reference")


@reduction(*_SUPPORTED)
def zmp_edge(run: RunView) -> Array:
    """Distance of the measured ZMP to the nearest edge of the planned support polygon, shape (n,) [m].

    Negative outside, NaN in flight.
    """
    return _to_edge(run, 0.0)


@reduction(*_SUPPORTED)
def zmp_depth(run: RunView) -> Array:
    """Depth of the measured ZMP inside the polygon of feet shrunk to 90 %, shape (n,) [m].

    A hull of shrunk feet is the hull of the feet with each edge moved in by a tenth of the foot's half extent along the
    edge's normal. That is exact for parallel feet, and on the safe side for others.
    """
    return _to_edge(run, 1 - MARGIN)


def _to_edge(run: RunView, cut: float) -> Array:
    """Distance to the nearest edge of the polygon, each edge moved in by a share of the foot's half extent [m]."""
    zmp = run.field("/contact", "zmp")[:, None, :2]
    vertices = to_truth(run, run.field("/reference", "support"))
    edges = _following(vertices) - vertices
    lengths = np.sqrt(np.add.reduce(edges * edges, axis=2))
    normals = np.stack([-edges[..., 1], edges[..., 0]], axis=2) / np.where(lengths > 0, lengths, 1.0)[..., None]
    normals *= np.sign(_signed_area(vertices))[:, None, None]
    depth = np.sum(normals * (zmp - vertices), axis=2)
    if cut:
        depth -= cut * _half_extent(run, normals)
    return np.asarray(np.where(lengths < 1e-9, np.inf, depth).min(axis=1))


def zmp_inside(run: RunView) -> Mask:
    """Mark ticks with the ZMP inside the planned support polygon of feet shrunk to 90 %, shape (n,); none in flight."""
    return np.asarray(run.reduced(zmp_depth) >= -1e-9)


@metric(shown=OF_THE_TIME, reduces=(zmp_depth,), least=0.0, most=1.0, tolerance=(0.002, 0.0))
def zmp_inside_fraction(run: RunView) -> float:
    """Share of ticks at which `zmp_inside` holds."""
    return float(np.mean(zmp_inside(run)))


@metric(unit="m", shown=MM, reduces=(zmp_depth,), tolerance=(0.001, 0.0))
def zmp_excursion_max(run: RunView) -> float | None:
    """Farthest that the ZMP came out of the planned support polygon of feet shrunk to 90 %, negative inside [m]."""
    depth = run.reduced(zmp_depth)
    depth = depth[np.isfinite(depth)]
    return float(-depth.min()) if len(depth) else None


def cop_ratios(run: RunView) -> Array:
    """Centre of pressure of the stance foot over its half size in single support, the worse axis, shape (k,).

    Of a foot that leans, the axis ahead: sideways it stands on an edge.
    """
    size = np.array([run.constants.foot_length, run.constants.foot_width]) / 2
    stance = run.field(GAIT, "stance")
    cops = np.where((stance == 0)[:, None], run.field("/contact", "cop_left"), run.field("/contact", "cop_right"))
    axes = slice(0, 1 if feet_lean(run.constants.roles) else 2)
    ratios = np.max(np.abs(cops[run.single_support & (stance >= 0), axes]) / size[axes], axis=1)
    return np.asarray(ratios[np.isfinite(ratios)])


@metric(shown=OF_HALF_THE_FOOT, reads=_COP_READS, least=0.0)
def cop_ratio_p99(run: RunView) -> float | None:
    """Centre of pressure of the stance foot over its half size in single support: 99th percentile [-]."""
    ratios = cop_ratios(run)
    return float(np.percentile(ratios, 99)) if len(ratios) else None


@metric(shown=OF_HALF_THE_FOOT, reads=_COP_READS, least=0.0)
def cop_ratio_max(run: RunView) -> float | None:
    """The same: largest [-]."""
    ratios = cop_ratios(run)
    return float(ratios.max()) if len(ratios) else None


@metric(unit="m", shown=MM, size=2, reads=_ZMP_READS, least=0.0)
def zmp_error_rms(run: RunView) -> list[float] | None:
    """Measured ZMP minus the ZMP reference that the footsteps define, RMS, x and y [m]."""
    return rms(run.field("/contact", "zmp")[:, :2] - to_truth(run, run.field("/reference", "zmp_reference")))


@metric(unit="m", shown=MM, size=2, reads=_ZMP_READS, least=0.0)
def zmp_error_max(run: RunView) -> list[float] | None:
    """Measured ZMP minus the ZMP reference that the footsteps define, largest in size, x and y [m]."""
    error = np.abs(run.field("/contact", "zmp")[:, :2] - to_truth(run, run.field("/reference", "zmp_reference")))
    error = error[np.isfinite(error).all(axis=1)]
    return [float(value) for value in error.max(axis=0)] if len(error) else None


@reduction("/plan")
def predicted(run: RunView) -> Array:
    """Prediction of each plan for 0.2 s later, shape (plans, 6): CoM, its velocity x y, ω; NaN beyond its horizon."""
    plan, sample = run.log["/plan"], round(PREDICTION * run.constants.similarity.time / run.constants.sample_time)
    com, velocity, omega = (plan.field(name) for name in ("com", "com_velocity", "omega"))
    if sample >= com.shape[1]:
        return np.full((len(com), 6), np.nan)
    return np.column_stack((com[:, sample], velocity[:, sample, :2], omega[:, sample]))


@metric(unit="m", shown=MM, size=3, reads={"/truth": ("com",), "/plan": ("held",)}, reduces=(predicted,), least=0.0)
def com_error_rms(run: RunView) -> list[float] | None:
    """True CoM minus what the plan of 0.2 s earlier predicted for this instant, RMS, x, y and z [m]."""
    rows, prediction = _predictions(run)
    return rms(run.log["/truth"].field("com")[rows] - to_truth(run, prediction[:, :3], rows))


@metric(
    unit="m",
    shown=MM,
    size=2,
    reads={"/truth": ("com", "com_velocity"), "/plan": ("held",)},
    reduces=(predicted,),
    least=0.0,
)
def dcm_error_rms(run: RunView) -> list[float] | None:
    """True DCM minus what the plan of 0.2 s earlier predicted, both by the predicted frequency, RMS, x and y [m]."""
    rows, prediction = _predictions(run)
    truth = run.log["/truth"]
    omega = prediction[:, 5:]
    position, velocity = truth.field("com")[rows, :2], truth.field("com_velocity")[rows, :2]
    if not run.has(SENSED):
        return rms(dcm(position - prediction[:, :2], velocity - prediction[:, 3:5], omega))
    predicted_dcm = to_truth(run, dcm(prediction[:, :2], prediction[:, 3:5], omega), rows)
    return rms(dcm(position, velocity, omega) - predicted_dcm)


@metric(unit="m", shown=MM, reads={"/plan": ("capture_margin",)})
def capture_margin_min(run: RunView) -> float | None:
    """Least that the DCM was inside what the steps to come could capture, moved as far as they may be [m]."""
    return _least(run.log["/plan"].field("capture_margin")[:, 1])


@metric(unit="m", shown=MM, reads={"/plan": ("step_shift",)}, least=0.0)
def step_shift(run: RunView) -> float | None:
    """Farthest that a plan moved the next landing from where it nominally was [m]."""
    return _most(np.linalg.norm(run.log["/plan"].field("step_shift"), axis=1))


@metric(unit="s", reads={"/plan": ("step_delay",)}, least=0.0, tolerance=(0.001, SHARE))
def step_timing(run: RunView) -> float | None:
    """Most by which a plan made the next landing come sooner or later than nominally [s]."""
    return _most(np.abs(run.log["/plan"].field("step_delay")))


def _least(values: Array) -> float | None:
    """The least of those that a planner has reported; None where it reports none."""
    known = values[np.isfinite(values)]
    return float(known.min()) if len(known) else None


def _most(values: Array) -> float | None:
    least = _least(-values)
    return None if least is None else -least


def rms(error: Array) -> list[float] | None:
    """Root mean square of each column over the rows that are finite; None when there is none."""
    sound = error[np.isfinite(error).all(axis=1)]
    return [float(value) for value in np.sqrt(np.mean(sound**2, axis=0))] if len(sound) else None


def _predictions(run: RunView) -> tuple[Rows, Array]:
    """Rows of /truth and what was predicted for them; held plans predict nothing."""
    plan = run.log["/plan"]
    sample = round(PREDICTION * run.constants.similarity.time / run.constants.sample_time)
    ahead = round(sample * run.constants.sample_time * 1e9)
    rows, near = run.rows_at("/truth", plan.time_ns + ahead)
    plans = np.flatnonzero(near & (plan.field("held") == 0))
    return rows[plans], run.reduced(predicted)[plans]


def _signed_area(vertices: Array) -> Array:
    """Signed area of polygons, counter-clockwise positive, shape (n,)."""
    x, y = vertices[..., 0], vertices[..., 1]
    return np.asarray(0.5 * np.sum(x * _following(y) - _following(x) * y, axis=1))


def _following(corners: Array) -> Array:
    """The next corner of each, shape (n, corners, ...), in a fifth of the time of `numpy.roll`."""
    return np.concatenate((corners[:, 1:], corners[:, :1]), axis=1)


def _half_extent(run: RunView, normals: Array) -> Array:
    """Half extent of the supporting feet along edge normals, the larger of two, shape (n, edges)."""
    stance = run.field("/reference", "stance")
    extents = []
    for foot, yaw in enumerate(run.sole_yaw.T):
        along = np.abs(normals[..., 0] * np.cos(yaw)[:, None] + normals[..., 1] * np.sin(yaw)[:, None])
        across = np.abs(normals[..., 1] * np.cos(yaw)[:, None] - normals[..., 0] * np.sin(yaw)[:, None])
        extent = (along * run.constants.foot_length + across * run.constants.foot_width) / 2
        extents.append(np.where((stance == 1 - foot)[:, None], 0.0, extent))
    return np.maximum(*extents)
