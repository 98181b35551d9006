"""Small sound files of every kind that vdbeam reads; what the campaigns damage.

They are made once into a folder, by the programs that come with vdbeam, by vdbeam itself, and by OpenImageIO's tool.
"""
import json
import math
import os
import pathlib
import shutil
import struct
import subprocess
import tempfile

import judge
import sample_meshes

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(os.environ.get("VDBEAM_BUILD", pathlib.Path(judge.BINARY).parent))
LARGEST = 300_000  # bytes of a file that is damaged: each mutant must cost little
SMALL = ["--resolution", "8x8", "--threads", "1", "-q"]
EXR_COMPRESSIONS = ["none", "rle", "zips", "zip", "piz", "pxr24", "b44", "b44a", "dwaa", "dwab"]


def make_volumes(folder):
    """Every kind of volume that make_volumes knows, packed and plain."""
    program = str(BUILD / "tools/make_volumes")
    listed = subprocess.run([program, "--list"], check=True, capture_output=True, text=True).stdout
    for line in listed.splitlines():
        kind = line.split()[0]
        for name, option in (("plain", ["--plain"]), ("packed", [])):
            subprocess.run([program, kind, str(folder / f"{kind}_{name}.vdb"), "--size", "10", *option], check=True)


def make_meshes(folder):
    gltf, buffer = sample_meshes.gltf_with_buffer("buffer.bin")
    files = {"mesh.obj": sample_meshes.obj_file().replace(b"none.mtl", b"mesh.mtl"),
             "mesh.mtl": b"newmtl grey\nKa 0.1 0.1 0.1\nKd 0.5 0.4 0.3\nNs 20\nillum 2\nd 1\nmap_Kd rgb8.png\n",
             "text.ply": sample_meshes.ply_file(binary=False), "binary.ply": sample_meshes.ply_file(binary=True),
             "mesh.gltf": sample_meshes.gltf_file(), "mesh.glb": sample_meshes.glb_file(), "parts.gltf": gltf,
             "buffer.bin": buffer}
    for name, data in files.items():
        (folder / name).write_bytes(data)


def make_cameras(folder):
    lines = [[frame, 0.1 * frame, 0.2, 6, 2, 3 * frame, 0] for frame in range(1, 6)]
    (folder / "camera.chan").write_text("# frame translation rotation\n" +
                                        "".join(" ".join(f"{x:g}" for x in line) + "\n" for line in lines))
    (folder / "fov.chan").write_text("".join(" ".join(f"{x:g}" for x in [*line, 30]) + "\n" for line in lines))
    matrix = [1, 0, 0, 0.3, 0, 1, 0, 0.2, 0, 0, 1, 6, 0, 0, 0, 1]
    (folder / "matrix.txt").write_text("".join(f"{frame} {matrix}\n" for frame in (1, 2, 9)))
    (folder / "still.txt").write_text(f"{matrix[:4]}\n{matrix[4:8]}\n".replace("\n", " ") + f"{matrix[8:]}\n")
    times, places = [0, 0.1, 0.2], [(0, 0, 6), (0.5, 0, 6), (1, 0.2, 6)]
    turns = [(0, math.sin(0.1 * i), 0, math.cos(0.1 * i)) for i in range(3)]
    buffer = b"".join(struct.pack(f"<{len(one)}f", *one) for one in [times, *places, *turns])
    views = [(0, 12, "SCALAR"), (12, 36, "VEC3"), (48, 48, "VEC4")]
    (folder / "camera.bin").write_bytes(buffer)
    (folder / "camera.gltf").write_text(json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [{"name": "rig", "children": [1], "translation": [0, 0, 1]}, {"name": "cam", "camera": 0}],
        "cameras": [{"name": "cam", "type": "perspective", "perspective": {"yfov": 0.6, "znear": 0.1, "zfar": 100}}],
        "buffers": [{"byteLength": len(buffer), "uri": "camera.bin"}],
        "bufferViews": [{"buffer": 0, "byteOffset": at, "byteLength": size} for at, size, _ in views],
        "accessors": [{"bufferView": i, "componentType": 5126, "count": 3, "type": kind, "min": [0], "max": [0.2]}
                      if i == 0 else {"bufferView": i, "componentType": 5126, "count": 3, "type": kind}
                      for i, (_, _, kind) in enumerate(views)],
        "animations": [{"channels": [{"sampler": 0, "target": {"node": 1, "path": "translation"}},
                                     {"sampler": 1, "target": {"node": 0, "path": "rotation"}}],
                        "samplers": [{"input": 0, "output": 1, "interpolation": "LINEAR"},
                                     {"input": 0, "output": 2, "interpolation": "STEP"}]}]}))


def make_pictures(folder):
    """EXR of every compression, in tiles, with levels, in parts; HDR, PNG, and what else OpenImageIO writes."""
    def tool(*words):
        # It would write the whole command into each file.
        subprocess.run(["oiiotool", "--nosoftwareattrib", *words], check=True, cwd=folder, capture_output=True)

    picture = ["--pattern", "checker:width=3:color1=0.2,0.4,0.1,1:color2=2,0.5,1.5,0.5", "16x8", "4"]
    rgb = [*picture, "--ch", "R,G,B"]
    tool(*rgb, "-d", "half", *(word for one in EXR_COMPRESSIONS for word in ("--compression", one, "-o", f"{one}.exr")))
    tool(*picture, "-d", "float", "-o", "float_rgba.exr", "-d", "uint8", "-o", "rgba8.png", "--ch", "R", "-o", "grey8.png",
         "-d", "half", "-o", "one_channel.exr")
    tool(*rgb, "-d", "half", "--tile", "4", "4", "-o", "tiled.exr")
    tool(*rgb, "-d", "half", "-otex:prefilter=0", "mip.exr")
    tool(*rgb, *rgb, "--siappend", "-d", "half", "-o", "parts.exr")
    tool(*rgb, "-o", "rgbe.hdr", "-d", "uint8", "-o", "rgb8.png", "-d", "uint16", "-o", "rgb16.png")
    subprocess.run(["oiiotool", *rgb, "-o", "picture.jpg"], check=True, cwd=folder)  # with the blocks that such words stand in
    tool(*rgb, "-d", "uint16", *(word for one in ("none", "zip", "lzw") for word in ("--compression", one, "-o", f"{one}.tif")))
    tool(*rgb, "-d", "float", "-otex", "picture.tx")


def make_profiles(folder):
    """Photometric files: round, with planes, and with a tilt."""
    head = "IESNA:LM-63-2002\n[MANUFAC] none\n"
    (folder / "round.ies").write_text(head + "TILT=NONE\n1 900 1 3 1 1 2 0 0 0\n1 1 9\n0 45 90\n0\n90 40 1\n")
    (folder / "planes.ies").write_text(head + "TILT=NONE\r\n1 -1 1.5 2 3 1 1 0.1 0.1 0\r\n1 1 9\r\n0 180\r\n"
                                       "0 90 180\r\n9 4\r\n9 3\r\n9 2\r\n")
    (folder / "tilt.ies").write_text("lamp\nTILT=INCLUDE\n1\n2\n0 90\n1 0.8\n1 900 1 2 1 1 2 0 0 0\n1 1 9\n0 90\n0\n9,4\n")


def make_instances(folder):
    """Places of instances: with a line of names, and without."""
    (folder / "places.csv").write_text("x, y, z, ry, scale, density\n0, 0, 0, 30, 1, 1\n# beside it\n1, 0, 0, 0, 0.5, 2\n")
    (folder / "plain.csv").write_text("0 0 0\r\n0.5; 0; 0\n")


SCENE = """# Every section once, as small as it gets.
[image]
width = 8
height = 8
[camera]
position = [0, 0.5, 6]
look_at = [0, 0, 0]
fov = 30
[[volume]]
file = "sphere_packed.vdb"
extinction = 3
albedo = [0.9, 0.8, 0.7]
phase = { type = "two_lobe", g = 0.6, g2 = -0.2, blend = 0.3 }
emission = { intensity = "density", color = [0.1, 0.05, 0.02], scale = 1 }
translate = [0, 0.1, 0]
noise_amplitude = 0.01
[[volume]]
shape = "height"
box_lower = [-2, -1, -2]
box_upper = [2, 1, 2]
scale_height = 0.3
extinction = 0.5
[[mesh]]
file = "mesh.obj"
translate = [0, -1.5, 0]
rotate = [-90, 0, 0]
material = { type = "diffuse", texture = "rgb8.png" }
[[mesh]]
type = "sphere"
scale = 0.2
material = { type = "dielectric", ior = 1.4, absorption = [0.1, 0.2, 0.3] }
[[light]]
type = "distant"
direction = [0.2, -1, 0.3]
irradiance = [2, 2, 2]
group = "sun"
[[light]]
type = "environment"
radiance = 0.5
image = "rgbe.hdr"
[[light]]
type = "spot"
position = [1, 2, 1]
direction = [-1, -2, -1]
power = [3, 4, 5]
kelvin = 3000
exposure = 1
ies = "planes.ies"
image = "rgb8.png"
[[layer]]
name = "Z"
[render]
passes = 1
photons = 100
"""

# The smallest scene of fog under a lamp, whose renders checkpoints and partials are made of.
FOG = """image = { width = 8, height = 8 }
camera = { position = [0, 0.5, 6], look_at = [0, 0, 0], fov = 30 }
volume = [{ file = "sphere_packed.vdb", extinction = 3 }]
light = [{ type = "distant", direction = [0.2, -1, 0.3], irradiance = [2, 2, 2] }]
render = { photons = 100, estimator = "beam" }
"""


def make_films(folder):
    """What vdbeam writes and reads again: finished images, flat and deep, partial images, checkpoints."""
    def render(*words):
        subprocess.run([judge.BINARY, "render", "fog.toml", *SMALL, *words], check=True, cwd=folder)

    (folder / "fog.toml").write_text(FOG)
    render("--passes", "2", "-o", "finished.exr")
    render("--passes", "2", "-o", "flat.exr", "--set", "image.deep=true")
    render("--pass-range", "0-0", "-o", "first.exr")
    render("--pass-range", "1-1", "-o", "second.exr")
    render("--pass-range", "0-0", "-o", "first_deep.exr", "--set", "image.deep=true")


def make_summaries(folder):
    """What a batch says of itself, from which pages are made."""
    subprocess.run([judge.BINARY, "render", "fog.toml", *SMALL, "--passes", "2", "-o", "finished.exr", "--skip-existing",
                    "--summary", "frames.summary"], check=True, cwd=folder)


MAKERS = {"volume": make_volumes, "mesh": make_meshes, "camera": make_cameras, "picture": make_pictures,
          "profile": make_profiles, "instance": make_instances, "film": make_films, "summary": make_summaries}


def make(folder):
    """Fills the folder; returns the files of each kind."""
    made = {}
    for kind, maker in MAKERS.items():
        before = set(folder.iterdir())
        maker(folder)
        made[kind] = sorted(path.name for path in set(folder.iterdir()) - before
                            if path.suffix != ".toml" and path.stat().st_size <= LARGEST)
    (folder / "scene.toml").write_text(SCENE)
    made["scene"] = ["fog.toml", "scene.toml"]
    return made


def kept():
    """The folder of samples, and the files of each kind in it: made anew where the program or this file is newer."""
    sources = [pathlib.Path(judge.BINARY), BUILD / "tools/make_volumes", *pathlib.Path(__file__).parent.glob("sample*.py")]
    stamp = max(path.stat().st_mtime_ns for path in sources)
    folder = BUILD / "attack" / f"{stamp:x}"
    if not folder.exists():
        shutil.rmtree(folder.parent, ignore_errors=True)
        new = pathlib.Path(tempfile.mkdtemp(prefix="samples_", dir=BUILD))
        (new / "kinds.json").write_text(json.dumps(make(new)))
        folder.parent.mkdir(exist_ok=True)
        try:
            new.rename(folder)
        except OSError:  # another campaign was faster
            shutil.rmtree(new)
    return folder, json.loads((folder / "kinds.json").read_text())
