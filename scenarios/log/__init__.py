"""The MCAP log: channels, writer, reader and recovery."""

from scenarios.log.reader import ChannelData, Log, read
from scenarios.log.spec import ChannelSpec, FieldSpec
from scenarios.log.writer import AttachedFile, LogWriter

__all__ = ["AttachedFile", "ChannelData", "ChannelSpec", "FieldSpec", "Log", "LogWriter", "read"]
