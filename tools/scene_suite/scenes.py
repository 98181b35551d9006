"""The suite's scenes, as dicts with the keys of a scene file: six clouds, and seven shots with what stands in them.

No constant of the renderer was fitted to any of them.
"""
import copy
import hashlib

import numpy as np

from .clouds import CLOUDS

POINTS = 96  # of an array along each axis
VOXEL = 2 / (POINTS - 1)


class Densities:
    """The arrays of one run, each made once."""

    def __init__(self, vdbeam):
        self._vdbeam, self._made = vdbeam, {}

    def __getitem__(self, name):
        if name not in self._made:
            random = np.random.default_rng(sorted(CLOUDS).index(name) + 1)
            values = CLOUDS[name](random, POINTS).astype(np.float32)
            self._made[name] = self._vdbeam.Density(values, VOXEL, [-1, -1, -1])
            self._made[name].identity = hashlib.sha256(values.tobytes()).hexdigest()
        return self._made[name]


def phase(g):
    return {"type": "henyey_greenstein", "g": g}


def sun(direction, irradiance, **keys):
    return {"type": "distant", "direction": direction, "irradiance": irradiance, "angular_radius": 0.27, **keys}


def camera(position, look_at=(0, 0, 0), fov=32):
    return {"position": list(position), "look_at": list(look_at), "up": [0, 1, 0], "fov": fov}


def ground(height, size, albedo=(0.3, 0.27, 0.2), **keys):
    return {"type": "quad", "scale": size, "translate": [0, height, 0], "rotate": [-90, 0, 0],
            "material": {"type": "diffuse", "albedo": list(albedo)}, **keys}


def ball(position, radius, albedo=(0.5, 0.5, 0.5), **keys):
    return {"type": "sphere", "scale": radius, "translate": list(position),
            "material": {"type": "diffuse", "albedo": list(albedo)}, **keys}


def lone_clouds(density):
    """Each cloud alone, under light of its own."""
    sky = {"type": "sky"}
    low_sun = sun([0.8, -0.2, 0.6], [8, 5, 3])
    high_sun = sun([-0.3, -0.9, -0.3], [5, 4.8, 4.4])
    behind = sun([0.2, -0.3, 1], [8, 7, 6])
    even = {"type": "environment", "radiance": [0.6, 0.7, 0.9]}
    view = camera([0.5, 0.4, 5.2])
    return {
        "cumulus": {"camera": view, "light": [high_sun, sky],
                    "volume": [{"file": density["cumulus"], "extinction": 60, "albedo": 0.999, "phase": phase(0.8)}]},
        "stratus": {"camera": camera([0.3, 1.6, 4.5]), "light": [low_sun, sky],
                    "volume": [{"file": density["stratus"], "extinction": 12, "albedo": 0.995, "phase": phase(0.6)}]},
        "wisps": {"camera": view, "light": [behind, even],
                  "volume": [{"file": density["wisps"], "extinction": 6, "albedo": 0.98, "phase": phase(0.3)}]},
        "plume": {"camera": view, "light": [low_sun, even],
                  "volume": [{"file": density["plume"], "extinction": 20, "albedo": [0.6, 0.55, 0.5],
                              "phase": phase(0.4)}]},
        "tower": {"camera": view, "light": [behind, sky],
                  "volume": [{"file": density["tower"], "extinction": 150, "albedo": 0.9995, "phase": phase(0.85)}]},
        "shell": {"camera": view, "light": [high_sun, even],
                  "volume": [{"file": density["shell"], "extinction": 30, "albedo": 0.99,
                              "phase": {"type": "mie", "droplet_diameter": 14}}]},
    }


def shots(density):
    """What makes a shot: a ground, an object, a lamp, fire, coloured smoke, light groups, layers."""
    sky = {"type": "sky"}
    cloud = {"file": density["cumulus"], "extinction": 50, "albedo": 0.995, "phase": phase(0.7)}
    smoke = {"file": density["plume"], "extinction": 14, "albedo": [0.85, 0.8, 0.75], "phase": phase(0.3)}
    view = camera([0.6, 0.3, 6.5], [0, -0.2, 0])
    afternoon = sun([-0.4, -0.8, -0.4], [5, 4.7, 4.2])
    lamp = {"type": "disk", "scale": 0.5, "translate": [2.4, 2.6, 1], "rotate": [120, 0, 0],
            "material": {"type": "emissive", "radiance": [9, 8, 6]}}
    room = [{"type": "quad", "scale": 4, "translate": [0, -1.2, 0], "rotate": [-90, 0, 0]},
            {"type": "quad", "scale": 4, "translate": [0, 1.6, 0], "rotate": [90, 0, 0]},
            {"type": "quad", "scale": 4, "translate": [0, 0, -2]},
            {"type": "quad", "scale": [4, 1.6, 1], "translate": [-2.5, -0.6, 0], "rotate": [0, 90, 0]},
            {"type": "quad", "scale": 4, "translate": [2.5, 0, 0], "rotate": [0, -90, 0]}]
    for wall in room:
        wall["material"] = {"type": "diffuse", "albedo": [0.6, 0.55, 0.5]}
    groups = [dict(afternoon, group="sun"), dict(sky, group="sky")]
    return {
        "cloud_over_ground": {"camera": view, "volume": [cloud], "light": [afternoon, sky],
                              "mesh": [ground(-1, 1000), ball([1.5, -0.6, 1.5], 0.4), lamp]},
        "lamp_in_smoke": {"camera": view, "volume": [smoke],
                          "light": [{"type": "point", "position": [0.15, -0.1, 0], "intensity": [2, 1.7, 1.2]},
                                    {"type": "environment", "radiance": [0.05, 0.06, 0.08]}]},
        "fire_over_floor": {"camera": view, "mesh": [ground(-1, 40, (0.2, 0.2, 0.2)), ball([-1.4, -0.6, 0.8], 0.4)],
                            "volume": [dict(smoke, extinction=20,
                                            emission={"intensity": "density", "color": [1, 0.35, 0.08],
                                                      "scale": 6})]},
        "smoke_in_room": {"camera": camera([0.3, 0, 3.8], fov=60), "mesh": room,
                          "volume": [dict(smoke, albedo=[0.9, 0.4, 0.2], extinction=5)],
                          "light": [sun([1, -0.5, -0.1], [12, 11, 9]), sky]},
        "fog_with_trees": {"camera": camera([0, 0.6, 7], [0, -0.3, 0]), "light": [sun([0.5, -0.2, 0.8], [8, 5, 3]), sky],
                           "volume": [{"shape": "height", "box_lower": [-60, -1, -60], "box_upper": [60, 8, 60],
                                       "scale_height": 0.7, "extinction": 0.25, "albedo": 0.99, "phase": phase(0.7)}],
                           "mesh": [ground(-1, 1000, (0.08, 0.1, 0.05))] +
                                   [ball([x, 0, z], [0.25, 1.6, 0.25], (0.1, 0.08, 0.06))
                                    for x, z in ((-2, -1), (1.2, -4), (2.4, 1), (-0.4, -9))]},
        "droplets_over_ground": {"camera": view, "mesh": [ground(-1, 40), ball([1.5, -0.6, 1.5], 0.4)],
                                 "volume": [dict(cloud, phase={"type": "mie", "droplet_diameter": 12})],
                                 "light": [sun([0.8, -0.3, 0.5], [7, 4, 2]), sky]},
        "layers_for_comp": {"camera": view, "volume": [cloud], "light": groups,
                            "mesh": [ground(-1, 200, material={"type": "shadow_catcher"}),
                                     ball([0.8, 0, 1.4], 0.35, material={"type": "holdout"}),
                                     dict(copy.deepcopy(lamp), group="lamp")],
                            "layer": [{"name": name} for name in ("beauty", "alpha", "depth", "shadow", "holdout",
                                                                  "lights", "cryptomatte")]},
    }


def all_scenes(vdbeam):
    """name -> keys of a scene file, the clouds first."""
    density = Densities(vdbeam)
    return {**lone_clouds(density), **shots(density)}
