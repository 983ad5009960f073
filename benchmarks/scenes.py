"""A scene as `twinlight scene convert` writes it, described for Mitsuba. What Mitsuba's plugins might understand
differently than twinlight does is refused: only diffuse surfaces, emitting ones among them, and rectangle lights."""

import tomllib
from pathlib import Path

import numpy as np

# Vertex after which both let roulette end a path: twinlight's default. Mitsuba's is 5.
ROULETTE_BEGIN = 4


def scene_dict(mi, path: Path, size: int) -> dict:
    """For mi.load_dict(): a box-filtered picture of size × size pixels by unlimited path tracing."""
    scene = tomllib.loads(path.read_text())
    if "environment" in scene:
        raise SystemExit(f"{path}: environment light is not compared")
    described = {
        "type": "scene",
        "integrator": {"type": "path", "max_depth": -1, "rr_depth": ROULETTE_BEGIN},
        "sensor": sensor(mi, scene["camera"], size),
    }
    materials = {material["name"]: material for material in scene["material"]}
    meshes = {mesh["name"]: mesh for mesh in scene["mesh"]}
    for index, instance in enumerate(scene["instance"]):
        mesh = meshes[instance["mesh"]]
        material = materials[instance.get("material", mesh["material"])]
        described[f"instance{index}"] = {
            **ply(path.parent / mesh["path"]),
            **surface(material),
            "to_world": mi.ScalarTransform4f([*instance["matrix"], [0, 0, 0, 1]]),
        }
    for index, light in enumerate(scene.get("light", [])):
        described[f"light{index}"] = rectangle(mi, light)
    return described


def sensor(mi, camera: dict, size: int) -> dict:
    return {
        "type": "perspective",
        "fov": camera["vfov"],
        "fov_axis": "y",
        # Mitsuba cuts off what lies before or beyond these; twinlight nothing.
        "near_clip": 1e-4,
        "far_clip": 1e6,
        "to_world": mi.ScalarTransform4f().look_at(
            origin=camera["position"], target=camera["target"], up=camera["up"]
        ),
        "film": {
            "type": "hdrfilm",
            "width": size,
            "height": size,
            "rfilter": {"type": "box"},
            "pixel_format": "rgb",
            "component_format": "float32",
        },
        "sampler": {"type": "independent"},
    }


def colour(rgb: list[float]) -> dict:
    return {"type": "rgb", "value": rgb}


def ply(path: Path) -> dict:
    with path.open("rb") as file:
        header = file.read(1024).split(b"end_header")[0]
    # Without normals in the file, twinlight shades by the triangles' own.
    return {"type": "ply", "filename": str(path), "face_normals": b"property float nx" not in header}


def surface(material: dict) -> dict:
    plain = material["kind"] == "opaque" and not any(material["specular"]) and "albedo_texture" not in material
    if not plain or material["emits_both_sides"]:
        raise SystemExit(f"material {material['name']} is not plainly diffuse: not compared")
    diffuse = {"type": "diffuse", "reflectance": colour(material["albedo"])}
    described = {"bsdf": {"type": "twosided", "nested": diffuse}}
    if any(material["emission"]):
        described["emitter"] = {"type": "area", "radiance": colour(material["emission"])}
    return described


def rectangle(mi, light: dict) -> dict:
    """Mitsuba's rectangle spans -1 to 1 in x and y and emits along +z; twinlight's reflects nothing."""
    if light["type"] != "rectangle":
        raise SystemExit(f"{light['type']} lights are not compared")
    u, v = (np.array(light[key]) for key in ("edge_u", "edge_v"))
    center = np.array(light["corner"]) + (u + v) / 2
    columns = np.column_stack([u / 2, v / 2, np.cross(u, v), center])
    return {
        "type": "rectangle",
        "to_world": mi.ScalarTransform4f(np.vstack([columns, [0, 0, 0, 1]])),
        "bsdf": {"type": "diffuse", "reflectance": colour([0, 0, 0])},
        "emitter": {"type": "area", "radiance": colour(light["radiance"])},
    }
