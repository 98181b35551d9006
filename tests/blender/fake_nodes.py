"""Nodes of Blender as tests need them, without Blender."""
import pathlib
import sys
import types

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools" / "blender"))

from vdbeam_blender import nodes  # noqa: E402


class Socket:
    """A socket of a node."""

    def __init__(self, name, value=0.0):
        self.name, self.default_value, self.links = name, value, []

    @property
    def is_linked(self):
        return bool(self.links)


def node(kind, inputs=(), **more):
    """A node with sockets by name and value."""
    return types.SimpleNamespace(type=kind, bl_label=kind.title(), inputs=[Socket(*pair) for pair in dict(inputs).items()],
                                 outputs=[Socket("Out")], **more)


def link(source, target, name):
    """Connects a node with a socket of another."""
    socket = nodes.socket(target, name)
    socket.links = [types.SimpleNamespace(from_node=source, from_socket=source.outputs[0])]
    return target
