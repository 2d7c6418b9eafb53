"""What happens in a run, in words: touchdown, lift-off, push, fall, fallback."""

from foxglove_schemas_protobuf.Log_pb2 import Log
from google.protobuf.timestamp_pb2 import Timestamp

from scenarios.log import LogWriter
from scenarios.viewer.schemas import published

TOPIC = "/events"
_FEET = ("left", "right")


class EventLog:
    """The log messages of a run, in Foxglove's ``foxglove.Log``."""

    def __init__(self, writer: LogWriter) -> None:
        self._channel = writer.message_channel(TOPIC, published(Log), "what happens, in words")
        self._last = ((True, True), False, False, False)

    def update(self, time_ns: int, contact: tuple[bool, bool], pushed: bool, fallback: bool, fallen: bool) -> None:
        """Say what has changed since the last call; before the first one the robot stood in peace.

        Args:
            time_ns: simulated time [ns].
            contact: feet that stand, (left, right).
            pushed: whether a push acts.
            fallback: whether the controller or the planner goes on without a solution.
            fallen: whether the robot has fallen.
        """
        now = (contact, pushed, fallback, fallen)
        if now == self._last:
            return
        (last_contact, was_pushed, fell_back, had_fallen), self._last = self._last, now
        for foot, before, after in zip(_FEET, last_contact, contact, strict=True):
            if after != before:
                kind = "touchdown" if after else "lift-off"
                self._say(time_ns, Log.INFO, kind, f"{kind} of the {foot} foot")
        if pushed != was_pushed:
            self._say(time_ns, Log.WARNING, "push", "a push begins" if pushed else "the push ends")
        if fallback != fell_back:
            words = "no solution, the fallback acts" if fallback else "solved again, the fallback ends"
            self._say(time_ns, Log.WARNING, "fallback", words)
        if fallen and not had_fallen:
            self._say(time_ns, Log.ERROR, "fall", "the robot falls")

    def _say(self, time_ns: int, level: "Log.Level.ValueType", kind: str, text: str) -> None:
        seconds, nanos = divmod(time_ns, 10**9)
        message = Log(timestamp=Timestamp(seconds=seconds, nanos=nanos), level=level, message=text, name=kind)
        self._channel.append(time_ns, message.SerializeToString(deterministic=True))
