"""The MCAP log: channels, writer, reader and recovery."""

from surefoot.scenarios.log.messages import ChannelData
from surefoot.scenarios.log.reader import Log, read
from surefoot.scenarios.log.recorder import Kept
from surefoot.scenarios.log.spec import ChannelSpec, FieldSpec
from surefoot.scenarios.log.thinning import Thinning
from surefoot.scenarios.log.writer import AttachedFile, LogWriter, NoLog, PublishedSchema

__all__ = [
    "AttachedFile",
    "ChannelData",
    "ChannelSpec",
    "FieldSpec",
    "Kept",
    "Log",
    "LogWriter",
    "NoLog",
    "PublishedSchema",
    "Thinning",
    "read",
]
