"""Foxglove's published schemas, out of the package that publishes them."""

from typing import cast

from google.protobuf.descriptor import FileDescriptor
from google.protobuf.descriptor_pb2 import FileDescriptorProto, FileDescriptorSet
from google.protobuf.message import Message

from scenarios.log import PublishedSchema


def published(message: type[Message]) -> PublishedSchema:
    """The schema of a message class, with every file that it imports."""
    files: dict[str, FileDescriptorProto] = {}
    _collect(cast(FileDescriptor, message.DESCRIPTOR.file), files)
    descriptors = FileDescriptorSet(file=files.values()).SerializeToString(deterministic=True)
    return PublishedSchema(message.DESCRIPTOR.full_name, descriptors)


def _collect(file: FileDescriptor, files: dict[str, FileDescriptorProto]) -> None:
    """Note a file after the files that it imports."""
    if file.name in files:
        return
    for imported in file.dependencies:
        _collect(imported, files)
    proto = FileDescriptorProto()
    file.CopyToProto(proto)
    files[file.name] = proto
