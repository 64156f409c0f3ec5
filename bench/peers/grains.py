"""The grains of every case, and the hopper's mesh: made by tsubu from scenes, the same on every machine, and kept for the next time."""
import hashlib
import math
import struct
from dataclasses import replace
from pathlib import Path

import bed
import codes

SIZES = [0.6e-3 * factor for factor in (1, 2, 3, 4, 5)]  # m, radii of the polydisperse bed; the same mass of each
POLYDISPERSE_STEP = 4e-6  # s; the smallest grain weighs a fifth of those of the other bed
OUTLET, BODY, CONE, TALL = 0.010, 0.040, 0.052, 0.080  # m: radii of the hopper's outlet and body, heights of cone and body
AROUND, CONE_RINGS, BODY_RINGS = 64, 14, 8
HOPPER_GRAINS, LOOSE = 30_000, 0.35
BELOW = 0.06  # m, from the outlet to the floor


def kept(directory, name, work, sources, steps=None):
    """Grains as they are at the end of a scene. The name of the file tells what made it, so that another scene makes another file."""
    scene = directory / name
    scene.mkdir(exist_ok=True)
    bed.write_tsubu(scene, [], replace(work, steps=steps or work.steps), sources)
    made_of = (scene / "bed.toml").read_bytes() + (work.mesh.read_bytes() if work.mesh else b"")
    path = scene / f"{name}_{hashlib.sha256(made_of).hexdigest()[:12]}.csv"
    codes.settle(path, scene / "bed.toml", threads=2)
    return path


def packing(region, more):
    return f'[grains.bed]\nsource = "packing"\n{region}\n{more}\n'


def monodisperse(directory, given):
    """The bed of 30,420 equal grains, or one of the user's own."""
    if given:
        return bed.read(given)
    path = directory / "bed.csv"
    codes.settle(path)
    return bed.read(path)


def polydisperse(directory):
    """Sizes 1 to 5, the same mass of each, fallen into the box of the bed and come to rest."""
    work = bed.Work("Grains of five sizes fall into a box", 100_000, time_step=POLYDISPERSE_STEP, gravity=(0.0, 0.0, -1.0))
    region = f"box = {{ min = [0, 0, 0], max = [{bed.SIDE}, {bed.SIDE}, 0.06] }}\nfill = 0.32"
    radii = f"radius = {{ radii = {SIZES}, mass_fractions = [0.2, 0.2, 0.2, 0.2, 0.2] }}"
    return bed.read(kept(directory, "settled_polydisperse", work, packing(region, radii)))


def cone_and_cylinder():
    """Triangles of an open hopper about the z axis, outlet at z = 0. Rings are turned by half an edge against each other, so that no two
    triangles are coplanar."""
    heights = [(OUTLET + (BODY - OUTLET) * k / CONE_RINGS, CONE * k / CONE_RINGS) for k in range(CONE_RINGS)]
    heights += [(BODY, CONE + TALL * k / BODY_RINGS) for k in range(BODY_RINGS + 1)]
    rings = [[(radius * math.cos(2 * math.pi * (n + 0.5 * (number % 2)) / AROUND), radius * math.sin(2 * math.pi * (n + 0.5 * (number % 2)) / AROUND), z)
              for n in range(AROUND)] for number, (radius, z) in enumerate(heights)]
    triangles = []
    for number, (low, high) in enumerate(zip(rings, rings[1:])):
        for n in range(AROUND):
            after = (n + 1) % AROUND
            # The corner of the other ring that lies between n and n + 1.
            between = [n, after][number % 2]
            triangles.append((low[n], low[after], high[n if number % 2 == 0 else after]))
            triangles.append((high[n], low[[after, n][number % 2]], high[after]) if number % 2 == 0 else (high[n], low[n], high[between]))
    return triangles


def write_stl(path, triangles):
    """As text: LIGGGHTS reads that. The normals are for readers that want them; no code here does."""
    with open(path, "w", encoding="utf-8") as file:
        file.write("solid mesh\n")
        for triangle in triangles:
            file.write("facet normal 0 0 0\nouter loop\n" + "".join(f"vertex {x:.9g} {y:.9g} {z:.9g}\n" for x, y, z in triangle) + "endloop\nendfacet\n")
        file.write("endsolid mesh\n")


def read_stl(path):
    """Triangles of a text or binary STL."""
    data = Path(path).read_bytes()
    if len(data) >= 84 and len(data) == 84 + 50 * struct.unpack_from("<I", data, 80)[0]:
        return [tuple(struct.unpack_from("<3f", data, 84 + 50 * t + 12 * (corner + 1)) for corner in range(3))
                for t in range(struct.unpack_from("<I", data, 80)[0])]
    corners = [tuple(map(float, line.split()[1:4])) for line in data.decode("utf-8").splitlines() if line.split()[:1] == ["vertex"]]
    return list(zip(corners[0::3], corners[1::3], corners[2::3]))


def hopper(directory, mesh, given, steps):
    """The work and the flowing grains. The hopper stands upright with its outlet in the lowest plane of the mesh; grains are packed
    loosely into a cylinder in the upper three fifths of it, fall, rest on a plug, and flow for a tenth of a second without it."""
    triangles = read_stl(mesh) if mesh else cone_and_cylinder()
    path = directory / "hopper.stl"
    write_stl(path, triangles)
    low, high = ([pick(corner[k] for triangle in triangles for corner in triangle) for k in range(3)] for pick in (min, max))
    base, height = low[2] + 0.4 * (high[2] - low[2]), 0.6 * (high[2] - low[2])
    radius = 0.96 * min(high[0] - low[0], high[1] - low[1]) / 2
    grain = (LOOSE * radius**2 * height * 0.75 / HOPPER_GRAINS) ** (1 / 3)
    step = float(f"{bed.TIME_STEP * grain / 1e-3:.2g}")  # of Hertz contacts: as the radius
    floor = bed.Plane("floor", "z", low[2] - BELOW * grain / 1e-3, 1)
    work = bed.Work("hopper", steps, "hertz", time_step=step, planes=(floor,), mesh=path, gravity=(0.0, 0.0, -1.0))
    if given:
        return work, bed.read(given), len(triangles)
    axis = [(low[k] + high[k]) / 2 for k in range(2)]
    region = f"cylinder = {{ base = {[*axis, base]}, top = {[*axis, high[2]]}, radius = {radius} }}\ncount = {HOPPER_GRAINS}"
    closed = replace(work, planes=(bed.Plane("plug", "z", low[2], 1),))
    rest = kept(directory, "settled_hopper", closed, packing(region, f"radius = {grain!r}"), round(0.4 / step))
    flow = kept(directory, "flowing_hopper", work, f'[grains.bed]\nsource = "file"\nfile = "../{rest.parent.name}/{rest.name}"\n', round(0.1 / step))
    return work, bed.read(flow), len(triangles)
