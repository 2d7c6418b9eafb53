"""The contacts that the whole-body QP holds, and the load that each may take: plan and feeling combined."""

from dataclasses import dataclass

from surefoot.wbc.parameters import ContactParameters
from surefoot.wbc.reference import WbcReference
from surefoot.wbc.types import FootSensing

_NONE = 0
"""Edge of a foot that stands on none [-]."""


@dataclass(frozen=True)
class ContactState:
    """Contacts of one tick, (left, right).

    Attributes:
        active: held by the QP as rigid contacts.
        felt: loaded, as the feet feel it.
        force_cap: largest normal force the QP may ask of each [N].
        edge: of each foot that of which alone it stands: 1 the toe edge, -1 the heel edge, 0 none, all of its sole [-].
        landing: held before anything is felt of it, so that it is to come to rest softly.
    """

    active: tuple[bool, bool]
    felt: tuple[bool, bool]
    force_cap: tuple[float, float]
    edge: tuple[int, int] = (0, 0)
    landing: tuple[bool, bool] = (False, False)


class ContactSchedule:
    """Follows the plan, but never against the feet.

    - A planned contact becomes active when the foot feels the ground: a late foot goes on searching downwards.
    - A swing foot that feels the ground after ``early_progress`` becomes active at once and stays so. It gets a small
      load until its planned touchdown, whether or not it feels the ground: to lift it again would only shake the ZMP.
      The plan's clock does not move, but for a step that catches the body.
    - A foot that comes to the ground before the next tick counts as one that feels it. Otherwise a command would swing
      on a foot that stands. So does one with which the planner has ended a single support.
    - A foot is released when the plan lifts it, unless it would be the last contact.
    - A foot that the plan rolls keeps an edge on the ground.
    - Allowed loads grow after touchdown and shrink before lift-off, so that no contact appears or ends with a jump in
      force. A foot that counts as landed before it is felt bears nothing yet, or the robot would fall onto it.

    Attributes:
        weight: of the robot, as it is now known [N].
    """

    def __init__(self, parameters: ContactParameters, weight: float, control_period: float) -> None:
        """Start with both feet loaded; ``weight`` [N], ``control_period`` [s]."""
        self.weight, self._period = weight, control_period
        self._early_progress, self._early_cap = parameters.early_progress, parameters.early_cap
        self._loading_time, self._unloading_time = parameters.loading_time, parameters.unloading_time
        self._share_margin = parameters.share_margin
        self._least, self._ticks = parameters.felt_force, parameters.felt_ticks
        self._ticks_felt = [parameters.felt_ticks, parameters.felt_ticks]
        self._planned, self._active, self._felt = [True, True], [True, True], [True, True]
        self._awaited, self._loading = [False, False], [1.0, 1.0]
        self._last = ContactState((True, True), (True, True), (3.0 * weight, 3.0 * weight))

    def update(self, reference: WbcReference, sensing: FootSensing) -> ContactState:
        """Contacts of this tick from the plan, and from what an estimator decided or else the normal forces.

        The same object as long as nothing changes.
        """
        self._planned[0], self._planned[1] = reference.planned_contact
        self._feel(0, sensing.normal_force[0], sensing.contact, sensing.touching[0])
        self._feel(1, sensing.normal_force[1], sensing.contact, sensing.touching[1])
        self._hold(0, reference.swing_progress)
        self._hold(1, reference.swing_progress)
        most = 3.0 * self.weight
        if self._active[0] and self._active[1]:
            caps, awaited = (self._cap(0, reference), self._cap(1, reference)), (self._awaited[0], self._awaited[1])
            return self._contacts(caps, reference.edge, awaited)
        # An edge of a foot in the air is none of a contact.
        if self._active[0]:
            return self._contacts((most, 0.0), (reference.edge[0], _NONE), (False, False))
        return self._contacts((0.0, most), (_NONE, reference.edge[1]), (False, False))

    def _feel(self, k: int, force: float, contact: tuple[bool, bool] | None, touches: bool) -> None:
        """Note whether a foot counts as loaded, and whether it does so before anything is felt of it."""
        if contact is None:
            self._ticks_felt[k] = self._ticks_felt[k] + 1 if force > self._least else 0
            self._felt[k] = self._ticks_felt[k] >= self._ticks
        else:
            self._felt[k] = contact[k]
        self._awaited[k] = (touches or self._awaited[k]) and not self._felt[k]
        self._felt[k] = self._felt[k] or touches

    def _hold(self, k: int, progress: float) -> None:
        """Hold a foot, or release it, by what plan and feeling tell of it."""
        early = not self._planned[k] and progress >= self._early_progress
        if not self._active[k]:
            if self._felt[k] and (self._planned[k] or early):
                self._active[k] = True
                self._loading[k] = 0.0
        elif not self._planned[k] and not early and self._active[1 - k]:
            self._active[k] = False

    def _cap(self, k: int, reference: WbcReference) -> float:
        """Load that a foot may take while both are held [N]."""
        if self._awaited[k] or not self._planned[k]:
            return self._early_cap
        if self._loading[k] < 1.0:
            self._loading[k] = min(1.0, self._loading[k] + self._period / self._loading_time)
        cap = self._early_cap + self._loading[k] * (3.0 * self.weight - self._early_cap)
        if reference.lifting_foot == k and self._loading[1 - k] >= 1.0:
            remaining = min(1.0, reference.time_to_switch / self._unloading_time)
            share = reference.load_share[1] if k else reference.load_share[0]
            cap = min(cap, self.weight * (share + self._share_margin * remaining))
        return cap

    def _contacts(self, cap: tuple[float, float], edge: tuple[int, int], landing: tuple[bool, bool]) -> ContactState:
        """The contacts, which are the same object where they are those of the tick before."""
        last = self._last
        if not (
            last.active[0] == self._active[0]
            and last.active[1] == self._active[1]
            and last.felt[0] == self._felt[0]
            and last.felt[1] == self._felt[1]
            and last.force_cap[0] == cap[0]
            and last.force_cap[1] == cap[1]
            and last.edge[0] == edge[0]
            and last.edge[1] == edge[1]
            and last.landing[0] == landing[0]
            and last.landing[1] == landing[1]
        ):
            active, felt = (self._active[0], self._active[1]), (self._felt[0], self._felt[1])
            self._last = ContactState(active, felt, cap, edge, landing)
        return self._last
