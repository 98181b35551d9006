"""From image textures of a shader's opacity, roughness, metal and normal to keys of a material."""
from . import nodes

PACKED = {"roughness": "Green", "metal": "Blue"}  # channels of an image that holds both, as glTF packs them


def image_of(node, image_path):
    """The file of an image texture's node, or None."""
    if node is None or node.type != "TEX_IMAGE" or node.image is None:
        return None
    return image_path(node.image)


def has_alpha(image):
    """Whether an image has an alpha channel, which Blender knows by its bits per pixel. Without one, its alpha is 1."""
    return getattr(image, "depth", 32) in (32, 64, 128)


def channel(input_socket):
    """(node, channel of a Separate Color in front of it, or None) behind a socket."""
    node, name = nodes.source(input_socket), None
    if node is not None and node.type in ("SEPARATE_COLOR", "SEPRGB"):
        name = nodes.output_name(input_socket)
        name = {"R": "Red", "G": "Green", "B": "Blue"}.get(name, name)
        node = nodes.source(node.inputs[0])
    return node, name


def number(node, key, notes, subject, image_path, name, default=0.0):
    """{key: number} of a socket, with the key's texture where an image drives it."""
    socket = nodes.socket(node, name)
    behind, packed = channel(socket)
    file = image_of(behind, image_path)
    if file is not None and packed in (None, PACKED[key]):
        return {key: 1.0, f"{key}_texture": file}
    return {key: max(0.0, min(1.0, nodes.constant_number(node, notes, subject, name, default=default)))}


def opacity(node, name, notes, subject, image_path):
    """Keys of the share of rays that a socket says are stopped; none where all are."""
    socket = nodes.socket(node, name)
    if socket is None:
        return {}
    behind = nodes.source(socket)
    file = image_of(behind, image_path)
    if file is not None and nodes.output_name(socket) == "Alpha" and not has_alpha(behind.image):
        return {}
    if file is not None:
        return {"opacity_texture": file}
    value = max(0.0, min(1.0, nodes.constant_number(node, notes, subject, name, default=1.0)))
    return {"opacity": value} if value < 1 else {}


def normal(node, notes, subject, image_path):
    """Keys of a Normal Map node with an image in tangent space; none without one."""
    behind = nodes.source(nodes.socket(node, "Normal"))
    if behind is None:
        return {}
    file = image_of(nodes.source(nodes.socket(behind, "Color")), image_path) if behind.type == "NORMAL_MAP" else None
    if file is None or behind.space != "TANGENT":
        notes.add(subject, f"Normal is driven by a {behind.bl_label} node, which has no counterpart; it is left out")
        return {}
    return {"normal_texture": file, "normal_scale": nodes.number(behind, "Strength", default=1.0)}
