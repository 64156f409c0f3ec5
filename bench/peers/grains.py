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
SLICES = 20  # of a mesh, to find room in it
LARGEST = 2  # m: whatever is larger was drawn in millimetres


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
    try:
        data = Path(path).read_bytes()
    except OSError as error:
        raise bed.Unusable(f"{path} cannot be read: {error}.") from None
    count = struct.unpack_from("<I", data, 80)[0] if len(data) >= 84 else 0
    if 0 < count <= (len(data) - 84) // 50 and b"facet" not in data[:1000].lower():
        return [tuple(struct.unpack_from("<3f", data, 84 + 50 * t + 12 * (corner + 1)) for corner in range(3)) for t in range(count)]
    try:
        lines = (line.split() for line in data.decode("latin-1").lower().splitlines())
        corners = [tuple(map(float, words[1:4])) for words in lines if words[:1] == ["vertex"]]
    except ValueError:
        raise bed.Unusable(f"{path} has a corner that is not of three numbers.") from None
    if not corners:
        raise bed.Unusable(f"There are no triangles in {path}: it is not an STL.")
    return list(zip(corners[0::3], corners[1::3], corners[2::3]))


def clipped(polygon, low, high):
    """The part of a polygon between two heights."""
    for height, sign in ((low, 1), (high, -1)):
        kept = []
        for a, b in zip(polygon, polygon[1:] + polygon[:1]):
            over, next_over = sign * (a[2] - height), sign * (b[2] - height)
            if over >= 0:
                kept.append(a)
            if over * next_over < 0:
                share = over / (over - next_over)
                kept.append(tuple(p + share * (q - p) for p, q in zip(a, b)))
        polygon = kept
    return polygon


def from_axis(polygon):
    """How far a polygon, seen from above, is from the axis x = y = 0."""
    nearest, turns = math.inf, []
    for a, b in zip(polygon, polygon[1:] + polygon[:1]):
        edge = (b[0] - a[0], b[1] - a[1])
        length2 = edge[0]**2 + edge[1]**2
        along = min(1, max(0, -(a[0] * edge[0] + a[1] * edge[1]) / length2)) if length2 else 0
        nearest = min(nearest, math.hypot(a[0] + along * edge[0], a[1] + along * edge[1]))
        turns.append(a[0] * b[1] - a[1] * b[0])
    return 0 if min(turns) > 0 or max(turns) < 0 else nearest  # the axis goes through it


def room_in(triangles, axis, low, high):
    """The largest upright cylinder about the axis in a mesh: from, to, and radius. Its ends lie at twentieths of the height."""
    edges = [low + (high - low) * k / SLICES for k in range(SLICES + 1)]
    free = [math.inf] * SLICES
    for triangle in triangles:
        polygon = [(x - axis[0], y - axis[1], z) for x, y, z in triangle]
        heights = [(corner[2] - low) / (high - low) * SLICES for corner in polygon]
        for k in range(max(0, math.ceil(min(heights)) - 1), min(SLICES, math.floor(max(heights)) + 1)):
            part = clipped(polygon, edges[k], edges[k + 1])
            if part:
                free[k] = min(free[k], from_axis(part))
    if not all(map(math.isfinite, free)):
        raise bed.Unusable("The mesh has a gap all the way round: it holds no grains.")
    base, top = max(((a, b) for a in range(SLICES) for b in range(a + 1, SLICES + 1)), key=lambda ends: (ends[1] - ends[0]) * min(free[slice(*ends)])**2)
    if min(free[base:top]) == 0:
        raise bed.Unusable("There is no room about the upright axis of the mesh, where its outlet should be lowest.")
    return edges[base], edges[top], min(free[base:top])


def hopper(directory, mesh, given, steps):
    """The work and the flowing grains. The hopper stands upright with its outlet in the lowest plane of the mesh; grains are packed
    loosely into the largest cylinder that fits into it, fall, rest on a plug, and flow for a tenth of a second without it."""
    triangles = read_stl(mesh) if mesh else cone_and_cylinder()
    if max(abs(number) for triangle in triangles for corner in triangle for number in corner) > LARGEST:
        print(f"{mesh} reaches farther than {LARGEST} m: it is taken for one in millimetres")
        triangles = [tuple(tuple(1e-3 * number for number in corner) for corner in triangle) for triangle in triangles]
    path = directory / "hopper.stl"
    write_stl(path, triangles)
    low, high = (tuple(pick(corner[k] for triangle in triangles for corner in triangle) for k in range(3)) for pick in (min, max))
    if not all(low[k] < high[k] for k in range(3)):
        raise bed.Unusable("The mesh is flat.")
    axis = [(low[k] + high[k]) / 2 for k in range(2)]
    flowing = bed.read(given) if given else None
    if flowing:
        grain = min(g.radius for g in flowing)
        bottom = min(low[2], min(g.position[2] - g.radius for g in flowing))
    else:
        base, top, radius = room_in(triangles, axis, low[2], high[2])
        radius, bottom = 0.96 * radius, low[2]
        grain = (LOOSE * radius**2 * (top - base) * 0.75 / HOPPER_GRAINS) ** (1 / 3)
    step = bed.rounded(bed.TIME_STEP * grain / bed.RADIUS)  # of Hertz contacts: as the radius
    floor = bed.Plane("floor", "z", bottom - BELOW * grain / bed.RADIUS, 1)
    work = bed.Work("hopper", steps, "hertz", time_step=step, planes=(floor,), mesh=path, reach=(low, high), gravity=(0.0, 0.0, -1.0))
    if flowing:
        return work, flowing, len(triangles)
    region = f"cylinder = {{ base = {[*axis, base]}, top = {[*axis, top]}, radius = {radius} }}\ncount = {HOPPER_GRAINS}"
    closed = replace(work, planes=(bed.Plane("plug", "z", low[2], 1),))
    rest = kept(directory, "settled_hopper", closed, packing(region, f"radius = {grain!r}"), round(0.4 / step))
    flow = kept(directory, "flowing_hopper", work, f'[grains.bed]\nsource = "file"\nfile = "../{rest.parent.name}/{rest.name}"\n', round(0.1 / step))
    return work, bed.read(flow), len(triangles)
