"""Reads Blender's shader nodes. Nothing here imports bpy: nodes are what has `type`, `inputs` and so on, so that
tests use objects of their own."""


def socket(node, *names):
    """The first input with one of these names (versions of Blender renamed some), or None."""
    for name in names:
        for candidate in node.inputs:
            if candidate.name == name:
                return candidate
    return None


def source(input_socket):
    """The node behind a socket, through reroutes and muted links, or None."""
    while input_socket is not None and input_socket.is_linked:
        link = input_socket.links[0]
        if getattr(link, "is_muted", False):
            return None
        node = link.from_node
        if node.type != "REROUTE":
            return node
        input_socket = node.inputs[0]
    return None


def output_name(input_socket):
    """The name of the output to which a socket is linked, through reroutes; requires a `source`."""
    link = input_socket.links[0]
    return link.from_socket.name if link.from_node.type != "REROUTE" else output_name(link.from_node.inputs[0])


def number(node, *names, default=0.0):
    """The value of a socket without its link."""
    found = socket(node, *names)
    return default if found is None else float(found.default_value)


def colour(node, *names, default=(0.0, 0.0, 0.0)):
    """The colour of a socket without its link."""
    found = socket(node, *names)
    return list(default) if found is None else [float(value) for value in found.default_value[:3]]


def active_output(tree, kind):
    """The output node that renders (kind "OUTPUT_MATERIAL" or "OUTPUT_WORLD"), or None."""
    if tree is None:
        return None
    outputs = [node for node in tree.nodes if node.type == kind and node.target in ("ALL", "CYCLES")]
    active = [node for node in outputs if node.is_active_output]
    return (active or outputs or [None])[0]


def shader_of(tree, kind, name):
    """The node behind the output's socket `name` ("Surface" or "Volume"), or None."""
    output = active_output(tree, kind)
    return None if output is None else source(socket(output, name))


def constant_colour(node, notes, subject, *names):
    """The colour of a socket, also of an RGB or black-body node behind it; any other node is noted."""
    found = socket(node, *names)
    behind = source(found)
    if behind is None:
        return colour(node, *names)
    if behind.type == "RGB":
        return [float(value) for value in behind.outputs[0].default_value[:3]]
    notes.add(subject, f"{names[0]} is driven by a {behind.bl_label} node, which has no counterpart; the socket's own "
                       "value is used")
    return colour(node, *names)


def constant_number(node, notes, subject, *names, default=0.0):
    """The value of a socket, also of a Value node behind it; any other node is noted."""
    found = socket(node, *names)
    behind = source(found)
    if behind is None:
        return number(node, *names, default=default)
    if behind.type == "VALUE":
        return float(behind.outputs[0].default_value)
    notes.add(subject, f"{names[0]} is driven by a {behind.bl_label} node, which has no counterpart; the socket's own "
                       "value is used")
    return number(node, *names, default=default)


def grid_times_number(input_socket, notes, subject):
    """(grid, factor) of a socket that is an attribute, times constants; the grid is "" where there is none. Nodes
    that are anything else are noted, and (None, 1) is returned."""
    node = source(input_socket)
    if node is None:
        return "", float(input_socket.default_value)
    if node.type == "ATTRIBUTE":
        return node.attribute_name, 1.0
    if node.type == "VALUE":
        return "", float(node.outputs[0].default_value)
    if node.type == "VOLUME_INFO":
        return input_socket.links[0].from_socket.name.lower(), 1.0
    if node.type == "MATH" and node.operation in ("MULTIPLY", "DIVIDE"):
        grid, factor = grid_times_number(node.inputs[0], notes, subject)
        other, second = grid_times_number(node.inputs[1], notes, subject)
        if grid is not None and other is not None:
            if node.operation == "DIVIDE" and other == "" and second != 0:
                return grid, factor / second
            if node.operation == "MULTIPLY" and not (grid and other):
                return grid or other, factor * second
    notes.add(subject, f"{input_socket.name} is driven by a {node.bl_label} node, which has no counterpart; attributes "
                       "and their products with numbers have one")
    return None, 1.0
