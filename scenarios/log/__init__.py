"""The MCAP log: channels, writer, reader and recovery."""

from scenarios.log.channel_data import ChannelData
from scenarios.log.reader import Log, read
from scenarios.log.spec import ChannelSpec, FieldSpec
from scenarios.log.writer import AttachedFile, LogWriter, PublishedSchema

__all__ = ["AttachedFile", "ChannelData", "ChannelSpec", "FieldSpec", "Log", "LogWriter", "PublishedSchema", "read"]
