"""Which contacts the whole-body QP holds, and how much load each may take: plan and feeling combined."""

from dataclasses import dataclass

from surefoot.wbc.parameters import ContactParameters
from surefoot.wbc.reference import WbcReference
from surefoot.wbc.types import NONE_TOUCHES, FootSensing


@dataclass(frozen=True, slots=True)
class ContactState:
    """Contacts of one tick, (left, right).

    Attributes:
        active: held by the QP as rigid contacts.
        felt: loaded, as the feet feel it.
        force_cap: largest normal force the QP may ask of each [N].
        rolling: index of the foot of which only the toe edge is in contact, -1 for none.
        landing: held before anything is felt of it, so that it is to come to rest softly.
    """

    active: tuple[bool, bool]
    felt: tuple[bool, bool]
    force_cap: tuple[float, float]
    rolling: int = -1
    landing: tuple[bool, bool] = (False, False)


class ContactSchedule:
    """Follows the plan, but never against the feet.

    - A planned contact becomes active when the foot feels the ground: a late foot goes on searching downwards.
    - A swing foot that feels the ground after ``early_progress`` becomes active at once and stays so, with a small load
      until its planned touchdown, whether or not it feels it: lifting and landing again would only shake the ZMP. The
      plan's clock does not move, but for a step that catches the body.
    - A foot that comes to the ground before the next tick counts as one that feels it, lest a command swings on a foot
      that stands. So does one with which the planner has ended a single support.
    - A foot is released when the plan lifts it, unless it would be the last contact.
    - A foot that the plan rolls keeps its toe edge on the ground, while the other foot carries as well.
    - Allowed loads grow after touchdown and shrink before lift-off, so that no contact appears or ends with a jump in
      force. A foot that counts as landed before it is felt bears nothing yet, or the robot would fall onto it.

    Attributes:
        weight: of the robot, as it is now known [N].
    """

    def __init__(self, parameters: ContactParameters, weight: float, control_period: float) -> None:
        """Start with both feet loaded; ``weight`` [N], ``control_period`` [s]."""
        self._parameters = parameters
        self.weight = weight
        self._period = control_period
        self._active = True, True
        self._least, self._ticks = parameters.felt_force, parameters.felt_ticks
        self._ticks_felt = [self._ticks, self._ticks]
        self._loading = [1.0, 1.0]
        self._awaited = NONE_TOUCHES
        self._last = ContactState(self._active, self._active, (3.0 * weight, 3.0 * weight))
        self._found: tuple[object, ...] = ()

    def update(self, reference: WbcReference, sensing: FootSensing) -> ContactState:
        """Contacts of this tick from the plan, and from what an estimator decided or else the normal forces.

        The same object as long as nothing changes.
        """
        felt, active, planned = sensing.contact, self._active, reference.planned_contact
        if felt is None:
            left, right = sensing.normal_force
            ticks = self._ticks_felt
            ticks[0] = ticks[0] + 1 if left > self._least else 0
            ticks[1] = ticks[1] + 1 if right > self._least else 0
            felt = (ticks[0] >= self._ticks, ticks[1] >= self._ticks)
        touching, awaited = sensing.touching, self._awaited
        if touching is not NONE_TOUCHES or awaited is not NONE_TOUCHES:
            one, other = ((touching[k] or awaited[k]) and not felt[k] for k in (0, 1))
            self._awaited = (one, other) if one or other else NONE_TOUCHES
            felt = (felt[0] or touching[0], felt[1] or touching[1])
        if active != planned or felt[0] > active[0] or felt[1] > active[1]:
            self._active = active = self._held(reference, felt)
        rolling, landing = -1, NONE_TOUCHES
        if active[0] and active[1]:
            cap, rolling = self._caps(reference), reference.rolling_foot
            landing = self._awaited
        else:
            cap = (3.0 * self.weight, 0.0) if active[0] else (0.0, 3.0 * self.weight)
        found = active, felt, cap, rolling, landing
        if found != self._found:
            self._found, self._last = found, ContactState(*found)
        return self._last

    def _held(self, reference: WbcReference, felt: tuple[bool, bool]) -> tuple[bool, bool]:
        """Contacts after what plan and feeling change of them."""
        held, planned = list(self._active), reference.planned_contact
        for k in (0, 1):
            early = not planned[k] and reference.swing_progress >= self._parameters.early_progress
            if not held[k]:
                if felt[k] and (planned[k] or early):
                    held[k] = True
                    self._loading[k] = 0.0
            elif not planned[k] and not early and held[1 - k]:
                held[k] = False
        return held[0], held[1]

    def _caps(self, reference: WbcReference) -> tuple[float, float]:
        """Loads that both feet may take while both are held [N]."""
        parameters, most, caps = self._parameters, 3.0 * self.weight, [0.0, 0.0]
        for k in (0, 1):
            if self._awaited[k] or not reference.planned_contact[k]:
                caps[k] = parameters.early_cap
                continue
            if self._loading[k] < 1.0:
                self._loading[k] = min(1.0, self._loading[k] + self._period / parameters.loading_time)
            cap = parameters.early_cap + self._loading[k] * (most - parameters.early_cap)
            if reference.lifting_foot == k and self._loading[1 - k] >= 1.0:
                remaining = min(1.0, reference.time_to_switch / parameters.unloading_time)
                cap = min(cap, self.weight * (reference.load_share[k] + parameters.share_margin * remaining))
            caps[k] = cap
        return caps[0], caps[1]
