#!/usr/bin/env python3
"""Makes the meshes of the scenes: python3 assets/make_assets.py [--check]

Writes every file next to this script, the same bytes each time; with --check it writes nothing and exits with 1 when a file is not what
it would write. Lengths in metres, z up. Walls are sheets without thickness unless it says solid. README.md lists the dimensions.
"""
import base64
import json
import math
import struct
import sys
from pathlib import Path

# --- hopper.stl and bin.obj: one stands over the other, floor of the bin at z = 0
HOPPER_FACETS = 64
HOPPER_RADIUS = 0.080
HOPPER_TOP = 0.420
HOPPER_WAIST = 0.260  # where the cylinder ends and the cone begins
HOPPER_OUTLET = 0.160
OUTLET_RADIUS = 0.022
BIN_WIDTH = 0.220
BIN_HEIGHT = 0.100

# --- drum.ply, drum_front.ply, drum_lifters.stl: axis along y through the origin
DRUM_FACETS = 96
DRUM_RADIUS = 0.120
DRUM_LENGTH = 0.100
LIFTERS = 6
LIFTER_HEIGHT = 0.018

# --- chute.stl, gate.obj, obstacles.glb: down along +x, horizontal run-out at z = 0
CHUTE_ANGLE = math.radians(32)
CHUTE_WIDTH = 0.200
CHUTE_WALL = 0.090
SLOPE_LENGTH = 0.700  # of the straight part
BEND_RADIUS = 0.200
BEND_FACETS = 12
RUN_OUT = 0.350  # from the end of the bend to the end wall
GATE_AT = 0.160  # from the back wall, along the slope
POST_RADIUS = 0.014
POST_HEIGHT = 0.055
POST_FACETS = 24
POST_SUNK = 0.004  # obstacles go a little into the floor, so that no two surfaces coincide

# --- table.gltf: solid, top at z = 0
TABLE_LENGTH = 0.500
TABLE_WIDTH = 0.160
TABLE_THICKNESS = 0.020
LEG_WIDTH = 0.020
LEG_LENGTH = 0.080
LEG_SUNK = 0.005  # into the plate

# --- silo.obj: axis z
SILO_FACETS = 64
SILO_RADIUS = 0.025
SILO_HEIGHT = 0.450

# --- tracks.obj: two grooves along x, their deepest lines at z = 0 and y = ±TRACK_Y
TRACK_Y = 0.045
TRACK_FLAT = 0.300
TRACK_BEND = 0.250  # radius of the bends at both ends
TRACK_ANGLE = math.radians(70)
TRACK_FACETS = 42
GROOVE = 0.018  # half the width of a groove, and its depth: both sides at 45°

# --- roller.stl: solid, axis along y through the origin
ROLLER_FACETS = 72
ROLLER_RADIUS = 0.008
ROLLER_LENGTH = 0.010

# --- block.obj and press.obj, both solid: what holds a beam at x = 0, and a round bar along y that presses on it
BLOCK = ((-0.060, -0.050, -0.060), (0.0, 0.050, 0.060))
PRESS_RADIUS = 0.020
PRESS_LENGTH = 0.080
PRESS_FACETS = 64

# --- piston.obj: solid, a flat plate with a rod on it; the plate's underside is z = 0
PISTON_PLATE = ((-0.0995, -0.0045, 0.0), (0.0995, 0.0045, 0.012))
PISTON_ROD = ((-0.009, -0.0030, 0.010), (0.009, 0.0030, 0.090))  # sunk into the plate


def circle(radius, count):
    return [(radius * math.cos(2 * math.pi * k / count), radius * math.sin(2 * math.pi * k / count)) for k in range(count)]


def band(lower, upper):
    """Quadrilaterals between two rings of as many points."""
    n = len(lower)
    return [[lower[k], lower[(k + 1) % n], upper[(k + 1) % n], upper[k]] for k in range(n)]


def box(low, high):
    """A solid box, outward normals."""
    (x0, y0, z0), (x1, y1, z1) = low, high
    return prism([(x0, y0), (x1, y0), (x1, y1), (x0, y1)], z0, z1)


def prism(base, z0, z1):
    """A solid over a convex polygon that runs counterclockwise."""
    bottom, top = [(x, y, z0) for x, y in base], [(x, y, z1) for x, y in base]
    return band(bottom, top) + [bottom[::-1], top]


def hopper():
    def ring(radius, z):
        return [(x, y, z) for x, y in circle(radius, HOPPER_FACETS)]

    outlet, waist, top = ring(OUTLET_RADIUS, HOPPER_OUTLET), ring(HOPPER_RADIUS, HOPPER_WAIST), ring(HOPPER_RADIUS, HOPPER_TOP)
    return band(outlet, waist) + band(waist, top)


def bin_box():
    h = BIN_WIDTH / 2
    bottom = [(-h, -h, 0), (h, -h, 0), (h, h, 0), (-h, h, 0)]
    return [bottom[::-1]] + band(bottom, [(x, y, BIN_HEIGHT) for x, y, _ in bottom])


def drum_ring(y):
    return [(x, y, z) for x, z in circle(DRUM_RADIUS, DRUM_FACETS)]


def drum():
    front, back = drum_ring(-DRUM_LENGTH / 2), drum_ring(DRUM_LENGTH / 2)
    return band(front, back) + [back]


def drum_front():
    return [drum_ring(-DRUM_LENGTH / 2)[::-1]]


def drum_lifters():
    """Radial blades from the shell inwards."""
    blades = []
    h = DRUM_LENGTH / 2
    apothem = DRUM_RADIUS * math.cos(math.pi / DRUM_FACETS)
    for k in range(LIFTERS):
        phi = 2 * math.pi * (k / LIFTERS + 0.5 / DRUM_FACETS)  # in the middle of a facet
        c, s = math.cos(phi), math.sin(phi)
        inner, outer = apothem - LIFTER_HEIGHT, apothem
        blades.append([(inner * c, -h, inner * s), (outer * c, -h, outer * s), (outer * c, h, outer * s), (inner * c, h, inner * s)])
    return blades


def roller():
    front, back = ([(x, y, z) for x, z in circle(ROLLER_RADIUS, ROLLER_FACETS)] for y in (-ROLLER_LENGTH / 2, ROLLER_LENGTH / 2))
    return band(back, front) + [back[::-1], front]


def chute_profile():
    """Points (x, z) along the floor from the back wall to the end wall, and the direction normal to the floor in each."""
    bend_start_x = -BEND_RADIUS * math.sin(CHUTE_ANGLE)
    bend_start_z = BEND_RADIUS * (1 - math.cos(CHUTE_ANGLE))
    points = [(bend_start_x - SLOPE_LENGTH * math.cos(CHUTE_ANGLE), bend_start_z + SLOPE_LENGTH * math.sin(CHUTE_ANGLE))]
    normals = [(math.sin(CHUTE_ANGLE), math.cos(CHUTE_ANGLE))]
    for k in range(BEND_FACETS + 1):
        angle = CHUTE_ANGLE * (1 - k / BEND_FACETS)
        points.append((-BEND_RADIUS * math.sin(angle), BEND_RADIUS * (1 - math.cos(angle))))
        normals.append((math.sin(angle), math.cos(angle)))
    points.append((RUN_OUT, 0.0))
    normals.append((0.0, 1.0))
    return points, normals


def chute():
    """The floor, which is seen from above and takes shadows."""
    points, _ = chute_profile()
    h = CHUTE_WIDTH / 2
    return [[(x0, -h, z0), (x1, -h, z1), (x1, h, z1), (x0, h, z0)] for (x0, z0), (x1, z1) in zip(points, points[1:])]


def chute_sides():
    """The side walls, the back wall and the end wall, which one looks through."""
    points, normals = chute_profile()
    h = CHUTE_WIDTH / 2
    rims = [(x + CHUTE_WALL * nx, z + CHUTE_WALL * nz) for (x, z), (nx, nz) in zip(points, normals)]
    faces = []
    for k in range(len(points) - 1):
        (x0, z0), (x1, z1) = points[k], points[k + 1]
        (u0, w0), (u1, w1) = rims[k], rims[k + 1]
        faces.append([(x1, -h, z1), (x0, -h, z0), (u0, -h, w0), (u1, -h, w1)])
        faces.append([(x0, h, z0), (x1, h, z1), (u1, h, w1), (u0, h, w0)])
    for k, side in ((0, 1), (-1, -1)):
        (x, z), (u, w) = points[k], rims[k]
        faces.append([(x, -side * h, z), (x, side * h, z), (u, side * h, w), (u, -side * h, w)])
    return faces


def on_slope(along, up):
    """World x, z of a point at this distance from the back wall along the slope and this height above it."""
    (x, z), (nx, nz) = (part[0] for part in chute_profile())
    return x + along * math.cos(CHUTE_ANGLE) + up * nx, z - along * math.sin(CHUTE_ANGLE) + up * nz


def gate():
    h = CHUTE_WIDTH / 2
    (x0, z0), (x1, z1) = on_slope(GATE_AT, 0), on_slope(GATE_AT, CHUTE_WALL)
    return [[(x0, -h, z0), (x0, h, z0), (x1, h, z1), (x1, -h, z1)]]


def obstacles():
    """In the frame of the slope: x along it from the back wall, z normal to it."""
    faces = []
    for x, y in ((0.34, -0.05), (0.34, 0.05), (0.42, 0.0), (0.50, -0.05), (0.50, 0.05)):
        base = [(x + u, y + v) for u, v in circle(POST_RADIUS, POST_FACETS)]
        faces += prism(base, -POST_SUNK, POST_HEIGHT)
    for side in (-1, 1):  # wedges at the side walls, point upstream
        y = side * (CHUTE_WIDTH / 2 - 0.001)
        base = [(0.57, y), (0.65, y - side * 0.045), (0.65, y)]
        faces += prism(base if side < 0 else base[::-1], -POST_SUNK, POST_HEIGHT)
    return faces


def table():
    a, b = TABLE_LENGTH / 2, TABLE_WIDTH / 2
    faces = box((-a, -b, -TABLE_THICKNESS), (a, b, 0))
    inset = 0.01
    for sx in (-1, 1):
        for sy in (-1, 1):
            x, y = sx * (a - inset - LEG_WIDTH / 2), sy * (b - inset - LEG_WIDTH / 2)
            half = LEG_WIDTH / 2
            faces += box((x - half, y - half, -TABLE_THICKNESS - LEG_LENGTH), (x + half, y + half, -TABLE_THICKNESS + LEG_SUNK))
    return faces


def silo():
    def ring(z):
        return [(x, y, z) for x, y in circle(SILO_RADIUS, SILO_FACETS)]

    return band(ring(0), ring(SILO_HEIGHT))


def groove(y):
    """A bend down, a flat piece, a bend up; the sides are planar in every segment."""
    points = []
    for k in range(TRACK_FACETS + 1):
        angle = TRACK_ANGLE * (k / TRACK_FACETS)
        points.append((TRACK_FLAT / 2 + TRACK_BEND * math.sin(angle), TRACK_BEND * (1 - math.cos(angle)), -math.sin(angle), math.cos(angle)))
    points = [(-x, z, -nx, nz) for x, z, nx, nz in points[::-1]] + points
    faces = []
    for (x0, z0, u0, w0), (x1, z1, u1, w1) in zip(points, points[1:]):
        for side in (-GROOVE, GROOVE):
            rim0, rim1 = (x0 + GROOVE * u0, y + side, z0 + GROOVE * w0), (x1 + GROOVE * u1, y + side, z1 + GROOVE * w1)
            faces.append([(x0, y, z0), (x1, y, z1), rim1, rim0] if side > 0 else [(x1, y, z1), (x0, y, z0), rim0, rim1])
    return faces


def tracks():
    return groove(-TRACK_Y) + groove(TRACK_Y)


# --- writers ---------------------------------------------------------------------------------------------------------------------------


def press():
    upright = prism(circle(PRESS_RADIUS, PRESS_FACETS), -PRESS_LENGTH / 2, PRESS_LENGTH / 2)
    return [[(x, -z, y) for x, y, z in face] for face in upright]


def triangles(faces):
    return [(face[0], face[k], face[k + 1]) for face in faces for k in range(1, len(face) - 1)]


def indexed(faces):
    """Vertices, each once and rounded to single precision, and the faces as lists of their indices."""
    vertices, known, result = [], {}, []
    for face in faces:
        indices = []
        for point in face:
            point = struct.unpack("<3f", struct.pack("<3f", *point))
            if point not in known:
                known[point] = len(vertices)
                vertices.append(point)
            indices.append(known[point])
        result.append(indices)
    return vertices, result


def normal(triangle):
    (ax, ay, az), (bx, by, bz), (cx, cy, cz) = triangle
    u, v = (bx - ax, by - ay, bz - az), (cx - ax, cy - ay, cz - az)
    n = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
    length = math.sqrt(sum(x * x for x in n))
    return tuple(x / length for x in n)


def stl(faces):
    result = b"tsubu".ljust(80, b"\0") + struct.pack("<I", len(triangles(faces)))
    for triangle in triangles(faces):
        result += struct.pack("<12fH", *normal(triangle), *(x for point in triangle for x in point), 0)
    return result


def obj(faces):
    vertices, polygons = indexed(faces)
    lines = ["v %.9g %.9g %.9g" % v for v in vertices] + ["f " + " ".join(str(i + 1) for i in p) for p in polygons]
    return ("\n".join(lines) + "\n").encode()


def ply(faces):
    vertices, polygons = indexed(faces)
    header = f"""ply
format binary_little_endian 1.0
element vertex {len(vertices)}
property float x
property float y
property float z
element face {len(polygons)}
property list uchar int vertex_indices
end_header
"""
    body = b"".join(struct.pack("<3f", *v) for v in vertices)
    body += b"".join(struct.pack(f"<B{len(p)}i", len(p), *p) for p in polygons)
    return header.encode() + body


def gltf_parts(faces, placement):
    """The JSON of a glTF file and its binary buffer; `placement` is a column-major matrix or None. Coordinates are kept z up."""
    vertices, polygons = indexed(faces)
    indices = [i for p in polygons for k in range(1, len(p) - 1) for i in (p[0], p[k], p[k + 1])]
    index_bytes, vertex_bytes = struct.pack(f"<{len(indices)}I", *indices), b"".join(struct.pack("<3f", *v) for v in vertices)
    node = {"mesh": 0}
    if placement:
        node["matrix"] = placement
    document = {
        "asset": {"version": "2.0", "generator": "tsubu"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [node],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 1}, "indices": 0}]}],
        "buffers": [{"byteLength": len(index_bytes) + len(vertex_bytes)}],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": len(index_bytes), "target": 34963},
            {"buffer": 0, "byteOffset": len(index_bytes), "byteLength": len(vertex_bytes), "target": 34962},
        ],
        "accessors": [
            {"bufferView": 0, "componentType": 5125, "count": len(indices), "type": "SCALAR"},
            {
                "bufferView": 1,
                "componentType": 5126,
                "count": len(vertices),
                "type": "VEC3",
                "min": [min(v[k] for v in vertices) for k in range(3)],
                "max": [max(v[k] for v in vertices) for k in range(3)],
            },
        ],
    }
    return document, index_bytes + vertex_bytes


def gltf(faces, placement=None):
    document, buffer = gltf_parts(faces, placement)
    document["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64.b64encode(buffer).decode()
    return (json.dumps(document, indent=1) + "\n").encode()


def glb(faces, placement=None):
    document, buffer = gltf_parts(faces, placement)
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    buffer += b"\0" * (-len(buffer) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(buffer), b"BIN\0") + buffer
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def slope_placement():
    """From the frame of the slope to the world, column-major."""
    c, s = math.cos(CHUTE_ANGLE), math.sin(CHUTE_ANGLE)
    x, z = on_slope(0, 0)
    return [round(value, 12) for value in (c, 0, -s, 0, 0, 1, 0, 0, s, 0, c, 0, x, 0, z, 1)]


def files():
    return {
        "hopper.stl": stl(hopper()),
        "bin.obj": obj(bin_box()),
        "drum.ply": ply(drum()),
        "drum_front.ply": ply(drum_front()),
        "drum_lifters.stl": stl(drum_lifters()),
        "roller.stl": stl(roller()),
        "chute.stl": stl(chute()),
        "chute_sides.stl": stl(chute_sides()),
        "gate.obj": obj(gate()),
        "obstacles.glb": glb(obstacles(), slope_placement()),
        "table.gltf": gltf(table()),
        "silo.obj": obj(silo()),
        "tracks.obj": obj(tracks()),
        "block.obj": obj(box(*BLOCK)),
        "press.obj": obj(press()),
        "piston.obj": obj(box(*PISTON_PLATE) + box(*PISTON_ROD)),
    }


def main(arguments):
    here = Path(__file__).resolve().parent
    wrong = []
    for name, content in files().items():
        path = here / name
        if arguments == ["--check"]:
            if not path.exists() or path.read_bytes() != content:
                wrong.append(name)
        else:
            path.write_bytes(content)
    for name in wrong:
        print(f"{name} is not what make_assets.py writes")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
