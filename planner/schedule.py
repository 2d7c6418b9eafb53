"""The phases of a gait on the integer clock of planner samples."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from planner.gait import GaitParameters, samples, support_rows
from planner.types import Array, Foot, PhaseKind


@dataclass(frozen=True, slots=True)
class Phase:
    """One support phase; it covers the samples `start` <= k < `start + samples`.

    Attributes:
        kind: stand, double or single support.
        start: first sample.
        samples: length in samples; the last phase of a schedule has 0, which means for ever.
        step: number of the step that this phase swings (single support) or has just landed (otherwise); 0 before.
        stance: the only supporting foot of a single support, otherwise None.
        support: support point (see `Schedule`) on which the ZMP reference stands, or which it leaves.
        rest: samples of a double support before it leaves.
    """

    kind: PhaseKind
    start: int
    samples: int
    step: int
    stance: Foot | None
    support: int
    rest: int = 0

    @property
    def end(self) -> int:
        """First sample after the phase (meaningless for the last one)."""
        return self.start + self.samples


@dataclass(frozen=True, slots=True)
class Schedule:
    """Phases and what follows from them at every sample; the arrays hold `preview` samples beyond the last change.

    The ZMP reference moves along the polyline of the support points (`planner.gait.support_rows`): a point between the
    feet before each bout and at the end, and the stance foot of each step. At sample k it is the fraction `fraction[k]`
    of the way from point `index[k]` to the next. It rests while the robot stands, and on the stance foot in single
    support; in every double support it goes on to exactly the next point.

    Attributes:
        phases: in order, without gaps; the last one never ends.
        phase_index: index into `phases`, shape (K,).
        index: support point that the ZMP reference leaves, shape (K,).
        fraction: share of the way to the next support point, shape (K,), in [0, 1).
        fraction_rate: rate of that share within the phase's ramp, shape (K,) [1/s].
        load_left: share of the weight on the left foot, shape (K,).
        contacts: planned contacts (left, right), shape (K, 2).
        sample_time: length of a sample [s].
        last: first sample of the final standing; the clock need not go beyond it.
    """

    phases: tuple[Phase, ...]
    phase_index: NDArray[np.intp]
    index: NDArray[np.intp]
    fraction: Array
    fraction_rate: Array
    load_left: Array
    contacts: NDArray[np.bool_]
    sample_time: float
    last: int

    def phase(self, sample: int) -> Phase:
        """The phase at a sample, which may lie beyond the end of the walk."""
        return self.phases[int(self.phase_index[min(sample, self.last)])]


def schedule(gait: GaitParameters, sample_time: float, preview: int) -> Schedule:
    """Lay the gait's phases on the clock.

    Each bout: stand, a first double support of twice the usual length that rests for its first half (so that the DCM is
    consistent when the weight shift begins), then single and double supports in turn. The last double support brings
    the ZMP back between the feet, where the robot stands until the next bout, in the end for ever.

    Args:
        gait: the gait.
        sample_time: planner sample time [s].
        preview: samples that a window may reach beyond the current one.

    Raises:
        ValueError: a duration is no multiple of the sample time.
    """
    phases = _phases(gait, sample_time)
    last = phases[-1].start
    count = last + preview + 2
    phase_index = np.empty(count, dtype=np.intp)
    index = np.empty(count, dtype=np.intp)
    fraction = np.zeros(count)
    rate = np.zeros(count)
    contacts = np.ones((count, 2), dtype=np.bool_)
    for i, phase in enumerate(phases):
        span = slice(phase.start, phase.end if phase.samples else count)
        phase_index[span] = i
        index[span] = phase.support
        if phase.kind is PhaseKind.DOUBLE:
            ramp = phase.samples - phase.rest
            ramp_span = slice(phase.end - ramp, phase.end)
            fraction[ramp_span] = np.arange(ramp) / ramp
            rate[ramp_span] = 1.0 / (ramp * sample_time)
        if phase.stance is not None:
            contacts[span, phase.stance.other] = False
    on_left = np.array([float(gait.step_foot(row - 1) is Foot.LEFT) for row in range(gait.steps + 2)])
    share = on_left[support_rows(gait.walk)].mean(axis=1)
    load_left = (1.0 - fraction) * share[index] + fraction * share[np.minimum(index + 1, len(share) - 1)]
    for array in (phase_index, index, fraction, rate, load_left, contacts):
        array.flags.writeable = False
    return Schedule(phases, phase_index, index, fraction, rate, load_left, contacts, sample_time, last)


def _phases(gait: GaitParameters, sample_time: float) -> tuple[Phase, ...]:
    names = ("initial_stand", "single_support", "double_support")
    _, single, double = (samples(f"gait.{name}", getattr(gait, name), sample_time) for name in names)
    phases: list[Phase] = []
    start = step = support = 0
    for bout in gait.walk:
        stand = samples("The standing before a bout", bout.stand, sample_time)
        if stand:
            phases.append(Phase(PhaseKind.STAND, start, stand, step, None, support))
        phases.append(Phase(PhaseKind.DOUBLE, start + stand, 2 * double, step, None, support, rest=double))
        for _ in bout.strides:
            step, support = step + 1, support + 1
            stance = gait.step_foot(step).other
            phases.append(Phase(PhaseKind.SINGLE, phases[-1].end, single, step, stance, support))
            phases.append(Phase(PhaseKind.DOUBLE, phases[-1].end, double, step, None, support))
        start, support = phases[-1].end, support + 1
    phases.append(Phase(PhaseKind.STAND, start, 0, step, None, support))
    return tuple(phases)
