"""Meshes of one known body in every format and unit, and others that are of none.

The body is an ellipsoid as large as the thigh of `biped`, in metres, in the frame of the thigh.
"""

import re
from dataclasses import dataclass

import numpy as np
from test_meshes import ball

from surefoot.models.robot_file.mesh_file import binary_stl

SIZE = np.array([0.06, 0.06, 0.2])
"""Extents of the body [m]."""

AT = np.array([0.0, 0.0, -0.15])
"""Its centre in the frame of the thigh [m]."""

METRES = {"m": 1.0, "cm": 0.01, "mm": 0.001, "inch": 0.0254}
POINTER = b"version https://git-lfs.github.com/spec/v1\noid sha256:4d7a214614ab2935c943f9e0ff69d22e\nsize 12345\n"


def body() -> tuple[np.ndarray, np.ndarray]:
    """Vertices [m] and faces."""
    vertices, faces = ball(0.5, 10)
    return AT + vertices * SIZE, faces


def stl(vertices, faces) -> bytes:
    return binary_stl((np.asarray(vertices, dtype=float), np.asarray(faces)))


def text_stl(vertices, faces) -> bytes:
    lines = ["solid body"]
    for face in faces:
        lines += ["facet normal 0 0 0", "outer loop"]
        lines += [f"vertex {x:.9g} {y:.9g} {z:.9g}" for x, y, z in vertices[face]]
        lines += ["endloop", "endfacet"]
    return "\n".join([*lines, "endsolid body\n"]).encode()


def obj(vertices, faces) -> bytes:
    lines = [f"v {x:.9g} {y:.9g} {z:.9g}" for x, y, z in vertices]
    return "\n".join([*lines, *(f"f {a} {b} {c}" for a, b, c in np.asarray(faces) + 1), ""]).encode()


def dae(vertices, faces, unit='<unit meter="1"/>', up="Z_UP", node="", encoding="utf-8") -> bytes:
    """A Collada file of one geometry in one node."""
    numbers = " ".join(f"{value:.9g}" for value in np.ravel(vertices))
    indices = " ".join(map(str, np.ravel(faces)))
    axis = f"<up_axis>{up}</up_axis>" if up else ""
    return f"""<?xml version="1.0" encoding="{encoding}"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset><contributor>
<author>J\u00fcrgen</author></contributor>{unit}{axis}</asset><library_geometries><geometry id="g"><mesh><source id="p">
<float_array id="a" count="{3 * len(vertices)}">{numbers}</float_array><technique_common>
<accessor source="#a" count="{len(vertices)}" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source><vertices id="v">
<input semantic="POSITION" source="#p"/></vertices><triangles count="{len(faces)}">
<input semantic="VERTEX" source="#v" offset="0"/><p>{indices}</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n">{node}<instance_geometry url="#g"/></node></visual_scene>
</library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>""".encode(encoding)


@dataclass(frozen=True)
class Mesh:
    """A file of a mesh, and what is to become of it.

    Attributes:
        ending: of the file.
        data: what is in it.
        scale: that the URDF gives it.
        sound: whether it is the body.
        said: pattern of what is said of it, where it is not; matched in a refusal, or in a note where it is drawn.
    """

    ending: str
    data: bytes
    scale: str = "1 1 1"
    sound: bool = True
    said: str = ""


def meshes() -> dict[str, Mesh]:
    """All of them by name."""
    return {**_sound(), **_in_other_units(), **_of_nothing()}


def _sound() -> dict[str, Mesh]:
    vertices, faces = body()
    found = {
        f"dae in {unit}, {up or 'no up'}": Mesh(
            "dae", dae(vertices / METRES[unit], faces, f'<unit name="{unit}" meter="{METRES[unit]}"/>', up)
        )
        for unit in METRES
        for up in ("Z_UP", "Y_UP", "X_UP", "")
    }
    for ending, write in (("stl", stl), ("stl", text_stl), ("obj", obj)):
        for unit, metres in METRES.items():
            name = f"{write.__name__} scaled from {unit}"
            found[name] = Mesh(ending, write(vertices / metres, faces), " ".join([str(metres)] * 3))
    mirrored, flip = vertices * [1, -1, 1], "1 -1 1"
    found |= {
        "dae without a unit": Mesh("dae", dae(vertices, faces, "")),
        "dae with a unit's name": Mesh("dae", dae(vertices, faces, '<unit name="meter"/>')),
        "dae scaled in its node": Mesh("dae", dae(vertices * 4, faces, node="<scale>0.25 0.25 0.25</scale>")),
        "dae in latin-1": Mesh("dae", dae(vertices, faces, encoding="ISO-8859-1")),
        "dae in utf-16": Mesh("dae", dae(vertices, faces, encoding="UTF-16")),
        "stl mirrored back": Mesh("stl", stl(mirrored, faces), flip),
        "stl inside out": Mesh("stl", stl(vertices, faces[:, ::-1])),
        "stl turned over twice": Mesh("stl", stl(-vertices, faces), "-1 -1 -1"),
        "obj with colours beside": Mesh("obj", b"mtllib none.mtl\n" + obj(vertices, faces)),
        "obj with quads": Mesh("obj", _quads(vertices, faces)),
    }
    return found


def _quads(vertices, faces) -> bytes:
    half = len(faces) // 2
    quads = np.column_stack((faces[:half], faces[half:, 2])) + 1
    lines = [f"v {x:.9g} {y:.9g} {z:.9g}" for x, y, z in vertices]
    return "\n".join([*lines, *(f"f {' '.join(map(str, quad))}" for quad in quads), ""]).encode()


def _in_other_units() -> dict[str, Mesh]:
    vertices, faces = body()
    names = {1000.0: "millimetres", 100.0: "centimetres", 39.37: "inches"}
    found = {}
    for ending, write in (("stl", stl), ("stl", text_stl), ("obj", obj), ("dae", dae)):
        for factor, unit in names.items():
            said = f"link 'left_thigh' reaches .* m from its frame, .*likely in {unit}"
            found[f"{write.__name__} in {unit}"] = Mesh(ending, write(vertices * factor, faces), "1 1 1", False, said)
        small = "left_thigh.*(cube of water|no volume|no triangles)"
        found[f"{write.__name__} of a thousandth"] = Mesh(ending, write(vertices * 1e-3, faces), "1 1 1", False, small)
    return found


def _of_nothing() -> dict[str, Mesh]:
    vertices, faces = body()
    flat, unread = vertices * [1, 1, 0], "left_thigh.*cannot be read"
    nan = vertices.copy()
    nan[7, 1] = np.nan
    head = stl(vertices, faces)

    def bad(ending: str, data: bytes, said: str = unread, scale: str = "1 1 1") -> Mesh:
        return Mesh(ending, data, scale, False, said)

    return {
        "stl of nothing": bad("stl", stl(vertices, faces[:0])),
        "stl of no bytes": bad("stl", b""),
        "stl of a head": bad("stl", head[:84]),
        "stl cut off": bad("stl", head[:-30], unread),
        "stl with more behind": bad("stl", head + b"\0" * 7),
        "stl of one triangle": bad("stl", stl(vertices, faces[40:41]), "left_thigh"),
        "stl in a plane": bad("stl", stl(flat, faces), "left_thigh"),
        "stl in a point": bad("stl", stl(vertices * 0, faces), "left_thigh"),
        "stl with nan": bad("stl", stl(nan, faces)),
        "stl with infinity": bad("stl", stl(np.where(np.isnan(nan), np.inf, nan), faces)),
        "stl without end": bad("stl", stl(vertices * 1e30, faces), "left_thigh"),
        "stl scaled by nothing": bad("stl", head, "left_thigh.*scale", "1 0 1"),
        "stl scaled by much": bad("stl", head, "left_thigh|scale", "1e6 1e6 1e6"),
        "text stl of nothing": bad("stl", b"solid a\nendsolid a\n"),
        "text stl with nan": bad("stl", re.sub(rb"vertex \S+", b"vertex nan", text_stl(vertices, faces), count=1)),
        "text stl cut off": bad("stl", text_stl(vertices, faces)[:200], "left_thigh"),
        "obj of nothing": bad("obj", b""),
        "obj of points": bad("obj", obj(vertices, faces[:0])),
        "obj with nan": bad("obj", re.sub(rb"v \S+", b"v nan", obj(vertices, faces), count=1), "left_thigh"),
        "obj of one triangle": bad("obj", obj(vertices, faces[40:41]), "left_thigh"),
        "obj in a plane": bad("obj", obj(flat, faces), "left_thigh"),
        "obj with a vertex too many": bad("obj", obj(vertices[:-3], faces), "left_thigh"),
        "dae of nothing": bad("dae", b""),
        "dae of another XML": bad("dae", b"<robot/>"),
        "dae cut off": bad("dae", dae(vertices, faces)[:400]),
        "dae without triangles": bad("dae", dae(vertices, faces[:0])),
        "dae in a plane": bad("dae", dae(flat, faces), "left_thigh"),
        "dae with nan": bad("dae", dae(nan, faces), "left_thigh"),
        "dae of no unit": bad("dae", dae(vertices, faces, '<unit meter="0"/>'), "left_thigh.*its unit is '0'"),
        "dae of less than a unit": bad("dae", dae(vertices, faces, '<unit meter="-1"/>'), "left_thigh.*unit is '-1'"),
        "dae of a unit's name": bad("dae", dae(vertices, faces, '<unit name="inch"/>'), "left_thigh.*unit is 'inch'"),
        "dae with a comma": bad("dae", dae(vertices, faces, '<unit meter="0,01"/>'), "left_thigh.*its unit is '0,01'"),
        "pointer as stl": bad("stl", POINTER, "left_thigh.*Git LFS pointer.*run 'git lfs pull'"),
        "pointer as obj": bad("obj", POINTER, "left_thigh.*Git LFS pointer.*run 'git lfs pull'"),
        "pointer as dae": bad("dae", POINTER, "left_thigh.*Git LFS pointer.*run 'git lfs pull'"),
        "a mesh of another kind": bad("ply", b"ply\n"),
    }  # fmt: skip
