"""Which contacts the whole-body QP holds, and how much load each may take: plan and feeling combined."""

from surefoot.values import dataclass, maker
from surefoot.wbc.parameters import ContactParameters
from surefoot.wbc.types import FootSensing, WbcReference


@dataclass(frozen=True, slots=True)
class ContactState:
    """Contacts of one tick, (left, right).

    Attributes:
        active: held by the QP as rigid contacts.
        felt: loaded, as the feet feel it.
        force_cap: largest normal force the QP may ask of each [N].
        rolling: index of the foot of which only the toe edge is in contact, -1 for none.
    """

    active: tuple[bool, bool]
    felt: tuple[bool, bool]
    force_cap: tuple[float, float]
    rolling: int = -1


_a_state = maker(ContactState)


class ContactSchedule:
    """Follows the plan, but never against the feet.

    - A planned contact becomes active when the foot feels the ground: a late foot goes on searching downwards.
    - A swing foot that feels the ground after ``early_progress`` becomes active at once and stays so, with a small load
      until its planned touchdown, whether or not it feels it: lifting and landing again would only shake the ZMP. The
      plan's clock does not move, but for a step that catches the body.
    - A foot is released when the plan lifts it, unless it would be the last contact.
    - A foot that the plan rolls keeps its toe edge on the ground, while the other foot carries as well.
    - Allowed loads grow after touchdown and shrink before lift-off, so that no contact appears or ends with a jump in
      force.

    Attributes:
        weight: of the robot, as it is now known [N].
    """

    def __init__(self, parameters: ContactParameters, weight: float, control_period: float) -> None:
        """Start with both feet loaded; ``weight`` [N], ``control_period`` [s]."""
        self._parameters = parameters
        self.weight = weight
        self._period = control_period
        self._active = [True, True]
        self._ticks_felt = [parameters.felt_ticks, parameters.felt_ticks]
        self._loading = [1.0, 1.0]

    def update(self, reference: WbcReference, sensing: FootSensing) -> ContactState:
        """Contacts of this tick from the plan, and from what an estimator decided or else the normal forces."""
        felt, held, planned = sensing.contact, self._active, reference.planned_contact
        if felt is None:
            felt = (self._feel(0, sensing.normal_force[0]), self._feel(1, sensing.normal_force[1]))
        if not (held[0] and held[1] and planned[0] and planned[1]):
            for k in (0, 1):
                early = not planned[k] and reference.swing_progress >= self._parameters.early_progress
                if not held[k]:
                    if felt[k] and (planned[k] or early):
                        held[k] = True
                        self._loading[k] = 0.0
                elif not planned[k] and not early and held[1 - k]:
                    held[k] = False
        active = (held[0], held[1])
        rolling = reference.rolling_foot if active[0] and active[1] else -1
        return _a_state(active, felt, (self._cap(0, reference), self._cap(1, reference)), rolling)

    def _feel(self, k: int, normal_force: float) -> bool:
        touches = normal_force > self._parameters.felt_force
        self._ticks_felt[k] = self._ticks_felt[k] + 1 if touches else 0
        return self._ticks_felt[k] >= self._parameters.felt_ticks

    def _cap(self, k: int, reference: WbcReference) -> float:
        parameters = self._parameters
        if not self._active[k]:
            return 0.0
        if not self._active[1 - k]:
            return 3.0 * self.weight
        if not reference.planned_contact[k]:
            return parameters.early_cap
        if self._loading[k] < 1.0:
            self._loading[k] = min(1.0, self._loading[k] + self._period / parameters.loading_time)
        cap = parameters.early_cap + self._loading[k] * (3.0 * self.weight - parameters.early_cap)
        if reference.lifting_foot == k and self._loading[1 - k] >= 1.0:
            remaining = min(1.0, reference.time_to_switch / parameters.unloading_time)
            cap = min(cap, self.weight * (reference.load_share[k] + parameters.share_margin * remaining))
        return cap
