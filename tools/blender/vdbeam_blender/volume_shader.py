"""From volume shaders to the coefficients of a [[volume]].

Cycles' Principled Volume has, at density d, the scattering coefficient colour * d and the absorption coefficient
(1 - colour) (1 - sqrt(absorption colour)) d; Volume Scatter scatters colour * d; Volume Absorption absorbs
(1 - colour) d. A [[volume]] has one extinction with an albedo, both per channel.
"""
import math

from . import nodes

STEFAN_BOLTZMANN = 5.670373e-8  # W / m^2 / K^4
REFERENCE = 1000.0  # K, at which the black body's luminance is 1 in the scene file
LEAST = 1e-12


class Coefficients:
    """Sums over the shaders of a material: all at the same density grid."""

    def __init__(self):
        self.scattering = [0.0] * 3
        self.absorption = [0.0] * 3
        self.forwardness = 0.0  # g times luminance of the scattering
        self.weight = 0.0
        self.density_grid = None
        self.masks = []
        self.colour_grid = ""
        self.emission = None

    def add_scattering(self, colour, g):
        """A scattering coefficient with its mean cosine."""
        self.scattering = [a + b for a, b in zip(self.scattering, colour)]
        self.forwardness += g * sum(colour)
        self.weight += sum(colour)

    def add_absorption(self, colour):
        """An absorption coefficient."""
        self.absorption = [a + max(b, 0.0) for a, b in zip(self.absorption, colour)]

    def use_grid(self, grid, notes, subject):
        """The density grid; a material has one."""
        if self.density_grid not in (None, grid):
            notes.add(subject, f"its shaders use the density grids {self.density_grid} and {grid}; all of them get the "
                               "first")
            return
        self.density_grid = grid

    def volume_keys(self):
        """Keys of the [[volume]]."""
        extinction = [s + a for s, a in zip(self.scattering, self.absorption)]
        largest = max(extinction)
        keys = {"extinction": largest}
        if largest <= 0:
            return {**keys, "albedo": [0.0] * 3}
        keys["extinction_scale"] = [value / largest for value in extinction]
        keys["albedo"] = [min(s / e, 1.0) if e > LEAST else 0.0 for s, e in zip(self.scattering, extinction)]
        g = self.forwardness / self.weight if self.weight > 0 else 0.0
        if abs(g) > 1e-6:
            keys["phase"] = {"type": "henyey_greenstein", "g": max(-0.999, min(0.999, g))}
        return keys


def density_of(node, sums, notes, subject):
    """The factor of the density: the socket's number, its grids noted in `sums`."""
    grid, factor = nodes.grid_times_number(nodes.socket(node, "Density"), notes, subject)
    named = nodes.socket(node, "Density Attribute")
    attribute = named.default_value if named is not None else ""
    if attribute:
        sums.use_grid(attribute, notes, subject)
        if grid:
            sums.masks.append(grid)
    elif grid:
        sums.use_grid(grid, notes, subject)
    elif node.type != "PRINCIPLED_VOLUME":
        sums.use_grid("", notes, subject)
    return max(factor, 0.0)


def add_principled(node, sums, notes, subject):
    """Adds a Principled Volume."""
    density = density_of(node, sums, notes, subject)
    colour = [max(value, 0.0) for value in nodes.constant_colour(node, notes, subject, "Color")]
    named = nodes.socket(node, "Color Attribute")
    if named is not None and named.default_value:
        sums.colour_grid = named.default_value
    dark = [max(1 - math.sqrt(max(value, 0.0)), 0.0)
            for value in nodes.constant_colour(node, notes, subject, "Absorption Color")]
    g = nodes.constant_number(node, notes, subject, "Anisotropy")
    sums.add_scattering([density * value for value in colour], g)
    sums.add_absorption([density * max(1 - value, 0.0) * d for value, d in zip(colour, dark)])
    add_emission(node, sums, notes, subject)


def add_emission(node, sums, notes, subject):
    """Emission of a Principled Volume: a strength, and black bodies."""
    blackbody = nodes.constant_number(node, notes, subject, "Blackbody Intensity")
    grid, strength = nodes.grid_times_number(nodes.socket(node, "Emission Strength"), notes, subject)
    if blackbody > 0:
        grid_name, kelvin = temperature_of(node, notes, subject)
        tint = nodes.constant_colour(node, notes, subject, "Blackbody Tint")
        if grid_name:
            # Cycles' intensity is sigma / (pi 10^6) times mix(1, T^4, intensity).
            scale = STEFAN_BOLTZMANN * 1e-6 / math.pi * min(blackbody, 1.0) * REFERENCE ** 4
            sums.emission = {"temperature": grid_name, "kelvin": kelvin, "law": "stefan_boltzmann",
                             "reference": REFERENCE, "color": tint, "scale": scale}
        else:
            notes.add(subject, "black-body emission without a temperature grid has no counterpart and is left out")
    if not strength or grid is None:
        return
    if sums.emission is not None:
        notes.add(subject, "it has black-body emission and an emission strength; only the black body is exported")
        return
    if not grid:
        notes.add(subject, "its emission does not follow a grid; it is exported as following the density")
    sums.emission = {"intensity": grid or sums.density_grid or "density", "scale": strength,
                     "color": nodes.constant_colour(node, notes, subject, "Emission Color")}


def temperature_of(node, notes, subject):
    """Grid of the temperature and kelvin per unit of it."""
    grid, factor = nodes.grid_times_number(nodes.socket(node, "Temperature"), notes, subject)
    named = nodes.socket(node, "Temperature Attribute")
    if named is not None and named.default_value:
        return named.default_value, factor
    return grid or "", factor


def add_scatter(node, sums, notes, subject):
    """Adds a Volume Scatter."""
    density = density_of(node, sums, notes, subject)
    colour = nodes.constant_colour(node, notes, subject, "Color")
    if getattr(node, "phase", "HENYEY_GREENSTEIN") != "HENYEY_GREENSTEIN":
        notes.add(subject, f"the phase function {node.phase} is exported as Henyey-Greenstein")
    sums.add_scattering([density * max(value, 0.0) for value in colour],
                        nodes.constant_number(node, notes, subject, "Anisotropy"))


def add_absorption(node, sums, notes, subject):
    """Adds a Volume Absorption."""
    density = density_of(node, sums, notes, subject)
    sums.add_absorption([density * (1 - value) for value in nodes.constant_colour(node, notes, subject, "Color")])


SHADERS = {"PRINCIPLED_VOLUME": add_principled, "VOLUME_SCATTER": add_scatter, "VOLUME_ABSORPTION": add_absorption}


def add_shader(node, sums, notes, subject):
    """Adds a shader and, of an Add Shader, those behind it."""
    if node is None:
        return
    if node.type == "ADD_SHADER":
        for input_socket in node.inputs:
            add_shader(nodes.source(input_socket), sums, notes, subject)
    elif node.type in SHADERS:
        SHADERS[node.type](node, sums, notes, subject)
    else:
        notes.add(subject, f"the volume shader {node.bl_label} has no counterpart and is left out")


def volume_keys(node, notes, subject):
    """Keys of a [[volume]] for a volume shader; None without one that can be exported."""
    sums = Coefficients()
    add_shader(node, sums, notes, subject)
    if max(sums.scattering + sums.absorption) <= 0 and sums.emission is None:
        return None
    keys = sums.volume_keys()
    keys["density"] = sums.density_grid or ""
    if sums.masks:
        keys["mask"] = ", ".join(dict.fromkeys(sums.masks))
    if sums.colour_grid:
        keys["color_grid"] = sums.colour_grid
    if sums.emission is not None:
        keys["emission"] = sums.emission
    return keys
