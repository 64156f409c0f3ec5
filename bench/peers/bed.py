"""The work as every code wants it: reads a LAMMPS data file or a CSV of grains, and writes the inputs of all codes.

All codes start from the same positions and velocities, with empty contact memory, and compute the same thing: a linear
spring-dashpot, or Hertz and Mindlin, with Coulomb friction and tangential memory or without, between planes and perhaps a mesh.
The bed is a square box of five planes, under gravity tilted by thirty degrees; it may be laid out in tiles, box beside box without
the walls between.
"""
import csv
import gzip
import math
import shutil
import statistics
from dataclasses import dataclass, replace
from pathlib import Path

SIDE = 0.084  # m, of the box in x and y
YOUNG, POISSON, RESTITUTION = 1e7, 0.3, 0.5  # of Hertz and Mindlin, Pa
FRICTION = 0.5
DENSITY = 2500.0  # kg/m3
GRAVITY = 9.81  # m/s2
GRAVITY_DIRECTION = (0.5, 0.0, -0.866)  # LAMMPS and LIGGGHTS normalise it
RADIUS = 1e-3  # m: what the springs and the time step are made for
TIME_STEP = 1e-5  # s
OUTPUT_EVERY = 500  # steps


class Unusable(Exception):
    """A file of the user that cannot be worked with; the sentence says why."""


@dataclass
class Grain:
    radius: float
    position: tuple
    velocity: tuple
    spin: tuple


@dataclass(frozen=True)
class Plane:
    name: str
    axis: str
    at: float
    inward: int  # +1: grains are on the side of larger coordinates


def box(x, y):
    return (Plane("floor", "z", 0.0, 1), Plane("left", "x", 0.0, 1), Plane("right", "x", x, -1), Plane("front", "y", 0.0, 1),
            Plane("back", "y", y, -1))


@dataclass(frozen=True)
class Springs:
    """Of linear contacts, N/m, and dashpots over the effective mass (the grain's mass at a wall), 1/s."""
    normal: float = 1000.0
    tangential: float = 285.7
    normal_damping: float = 3118.0
    tangential_damping: float = 1559.0


@dataclass(frozen=True)
class Work:
    """What is done with some grains."""
    name: str
    steps: int
    law: str = "linear"  # or "hertz"
    friction: bool = True
    time_step: float = TIME_STEP
    springs: Springs = Springs()
    planes: tuple = box(SIDE, SIDE)
    mesh: Path | None = None  # an STL beside the planes
    reach: tuple = ()  # its lowest and highest corner
    gravity: tuple = GRAVITY_DIRECTION

    def limits(self, grains):
        """The corners of a box that nothing leaves; planes end it."""
        margin, sides = 0.0005, []
        for k, axis in enumerate("xyz"):
            at = {plane.inward: plane.at for plane in self.planes if plane.axis == axis}
            there = [g.position[k] for g in grains] + [corner[k] for corner in self.reach]
            sides.append((at[1] - margin if 1 in at else min(there) - 0.1, at[-1] + margin if -1 in at else max(there) + 0.1))
        return sides

    def fitted(self, grains):
        """For grains of another size: under their weight they overlap by the same share of a radius, and a collision takes as many steps."""
        usual, smallest = statistics.median(g.radius for g in grains) / RADIUS, min(g.radius for g in grains) / RADIUS
        if usual == smallest == 1:
            return self
        if self.law == "hertz":
            return replace(self, time_step=rounded(TIME_STEP * smallest))
        of, stiffer, slower = self.springs, usual**2, usual**-0.5
        springs = Springs(of.normal * stiffer, of.tangential * stiffer, of.normal_damping * slower, of.tangential_damping * slower)
        return replace(self, springs=springs, time_step=rounded(TIME_STEP * usual**0.5 * (smallest / usual)**1.5))


def rounded(number):
    return float(f"{number:.2g}")


def lay_out(grains, tiles, x=SIDE, y=SIDE):
    return [Grain(g.radius, (g.position[0] + x * i, g.position[1] + y * j, g.position[2]), g.velocity, g.spin)
            for i in range(tiles) for j in range(tiles) for g in grains]


def in_box(grains, side):
    """Grains, and the sides of their box in x and y, whose corner is the origin. Without `side` it is that of the bed where they lie in it;
    otherwise it is fitted to them, and they are moved."""
    outside = next((number for number, g in enumerate(grains, 1)
                    if not (0 < g.position[0] < (side or SIDE) and 0 < g.position[1] < (side or SIDE) and 0 < g.position[2])), None)
    if not outside:
        return grains, (side or SIDE, side or SIDE)
    if side:
        raise Unusable(f"Grain {outside} at {grains[outside - 1].position} lies outside the box, which goes from the origin to {side} m in x and y "
                       "(give another --side, or none).")
    low = [min(g.position[k] - g.radius for g in grains) for k in range(3)]
    moved = [replace(g, position=tuple(g.position[k] - low[k] for k in range(3))) for g in grains]
    return moved, tuple(max(g.position[k] + g.radius for g in moved) for k in range(2))


def read(path):
    """Grains from a CSV with the names of tsubu's columns, or from a LAMMPS data file (atom style sphere), possibly compressed."""
    path = Path(path)
    open_it = gzip.open if path.suffix == ".gz" else open
    try:
        with open_it(path, "rt", encoding="utf-8-sig") as file:
            lines = [line for line in file if line.strip() and not line.lstrip().startswith("#")]
    except (OSError, UnicodeDecodeError) as error:
        raise Unusable(f"{path} cannot be read: {error}.") from None
    is_table = ".csv" in path.suffixes or bool(lines) and {"x", "y", "z"} <= {name.strip() for name in lines[0].split(",")}
    grains = read_csv(path, lines) if is_table and lines else read_lammps(path, lines)
    if not grains:
        raise Unusable(f"There are no grains in {path}.")
    return grains


def read_csv(path, lines):
    """Columns x, y, z, radius, and if they move vx, vy, vz, wx, wy, wz, in any order; others do not matter."""
    names = [name.strip() for name in lines[0].split(",")]
    missing = {"x", "y", "z", "radius"} - set(names)
    if missing:
        raise Unusable(f"{path} has no column {', '.join(sorted(missing))}.")
    grains = []
    for line, values in enumerate(csv.reader(lines[1:], skipinitialspace=True), 1):
        row = dict(zip(names, values))
        try:
            numbers = [tuple(float(row.get(name, 0)) for name in of.split()) for of in ("x y z", "vx vy vz", "wx wy wz")]
            grains.append(Grain(float(row["radius"]), *numbers))
        except (ValueError, KeyError):
            raise Unusable(f"Grain {line} of {path} is not a row of numbers: {','.join(values)}") from None
    return grains


def read_lammps(path, lines):
    """Sections 'Atoms' (id type diameter density x y z …) and 'Velocities' (id vx vy vz wx wy wz)."""
    sections, section = {"Atoms": {}, "Velocities": {}}, None
    for line in lines:
        words, _, style = line.partition("#")
        words = words.split()
        if words[:1] and words[0][0].isalpha():
            if words[0] == "Atoms" and style.strip() not in ("", "sphere", "granular"):
                raise Unusable(f"The atoms of {path} are of style {style.strip()}, not sphere.")
            section = sections.get(words[0])
        elif section is not None and words:
            try:
                section[int(words[0])] = [float(word) for word in words[1:]]
            except ValueError:
                raise Unusable(f"{path} has a line that is not of numbers: {line.strip()}") from None
    grains = []
    for number, numbers in sorted(sections["Atoms"].items()):
        if len(numbers) < 6:
            raise Unusable(f"Atom {number} of {path} has fewer numbers than id, type, diameter, density, x, y, z.")
        _, diameter, density, *position = numbers[:6]
        if not math.isclose(density, DENSITY, rel_tol=1e-9):
            raise Unusable(f"Atom {number} of {path} has density {density}; the scripts are made for {DENSITY} kg/m3.")
        motion = sections["Velocities"].get(number, [0.0] * 6)
        grains.append(Grain(diameter / 2, tuple(position), tuple(motion[:3]), tuple(motion[3:6])))
    return grains


def write_data(path, grains, title, sphere_style, limits):
    """A data file of LAMMPS (`sphere_style`) or LIGGGHTS: they differ in what follows the word 'Atoms'."""
    with open(path, "w", encoding="utf-8") as file:
        file.write(f"{title}\n\n{len(grains)} atoms\n1 atom types\n\n")
        file.write("".join(f"{low!r} {high!r} {axis}lo {axis}hi\n" for axis, (low, high) in zip("xyz", limits)) + "\n")
        file.write("Atoms # sphere\n\n" if sphere_style else "Atoms\n\n")
        for number, g in enumerate(grains, 1):
            file.write(f"{number} 1 {2 * g.radius!r} {DENSITY} " + " ".join(map(repr, g.position)) + "\n")
        file.write("\nVelocities\n\n")
        for number, g in enumerate(grains, 1):
            file.write(f"{number} " + " ".join(map(repr, g.velocity + g.spin)) + "\n")


def write_csv(path, grains):
    with open(path, "w", encoding="utf-8") as file:
        file.write("x,y,z,radius,vx,vy,vz,wx,wy,wz\n")
        for g in grains:
            file.write(",".join(map(repr, g.position + (g.radius,) + g.velocity + g.spin)) + "\n")


def write_lammps(directory, grains, work, skin):
    """A peer without Hertz and Mindlin as tsubu has them, and without meshes. `skin`, m: how much farther than contact neighbours are listed.
    Bins for each size (multi) gain nothing for sizes of 1 to 5."""
    write_data(directory / "bed.lammps.data", grains, work.name, True, work.limits(grains))
    model, springs = "hooke/history" if work.friction else "hooke", work.springs
    values = (springs.normal, springs.tangential, springs.normal_damping, springs.tangential_damping, FRICTION, 1)
    if not work.friction:
        values = (springs.normal, 0, springs.normal_damping, 0, 0, 0)
    law = " ".join(map(str, values))
    walls = ""
    for axis in "zxy":  # one fix for two walls that face each other
        at = {plane.inward: plane.at for plane in work.planes if plane.axis == axis}
        if at:
            walls += f"fix sides_{axis} all wall/gran {model} {law} {axis}plane {at.get(1, 'NULL')} {at.get(-1, 'NULL')}\n"
    (directory / "in.lammps").write_text(f"""\
units si
atom_style sphere
boundary f f f
processors * * 1
newton off
comm_modify vel yes
neighbor {skin:g} bin
neigh_modify delay 0 every 1 check yes
read_data bed.lammps.data
pair_style gran/{model} {law}
pair_coeff * *
fix gravity all gravity {GRAVITY} vector {" ".join(map(str, work.gravity))}
fix motion all {"nve/sphere" if work.friction else "nve"}
{walls}timestep {work.time_step}
thermo_style custom step atoms ke
thermo_modify format float %.10g
thermo {OUTPUT_EVERY}
run {work.steps}
""")


def liggghts_law(work):
    """The normal model and its properties."""
    if work.law == "hertz":
        return "hertz", {"youngsModulus": YOUNG, "poissonsRatio": POISSON, "coefficientRestitution": RESTITUTION, "coefficientFriction": FRICTION}
    springs = work.springs
    return "hooke/stiffness", {"kn": springs.normal, "kt": springs.tangential, "gamman": springs.normal_damping,
                               "gammat": springs.tangential_damping, "coefficientFriction": FRICTION}


def liggghts_properties(**values):
    material = ("youngsModulus", "poissonsRatio")
    return "".join(f"fix {name} all property/global {name} {'peratomtype' if name in material else 'peratomtypepair 1'} {value}\n"
                   for name, value in values.items())


def place_mesh(directory, work):
    """Codes look for the mesh beside their input."""
    if work.mesh and work.mesh.parent != directory:
        shutil.copy(work.mesh, directory)


def write_liggghts(directory, grains, work, skin):
    place_mesh(directory, work)
    write_data(directory / "bed.liggghts.data", grains, work.name, False, work.limits(grains))
    normal, values = liggghts_law(work)
    model = f"{normal} tangential {'history' if work.friction else 'off'}"
    walls = "".join(f"fix wall_{plane.name} all wall/gran model {model} primitive type 1 {plane.axis}plane {plane.at}\n" for plane in work.planes)
    if work.mesh:
        walls += f"fix mesh all mesh/surface file {work.mesh.name} type 1 curvature_tolerant yes\nfix wall_mesh all wall/gran model {model} mesh n_meshes 1 meshes mesh\n"
    (directory / "in.liggghts").write_text(f"""\
atom_style granular
atom_modify map array
boundary f f f
newton off
communicate single vel yes
units si
processors * * 1
neighbor {skin:g} bin
neigh_modify delay 0
read_data bed.liggghts.data
{liggghts_properties(**values)}pair_style gran model {model}
pair_coeff * *
timestep {work.time_step}
fix gravity all gravity {GRAVITY} vector {" ".join(map(str, work.gravity))}
{walls}fix motion all {"nve/sphere" if work.friction else "nve"}
thermo_style custom step atoms ke
thermo_modify format float %.10g
thermo {OUTPUT_EVERY}
run {work.steps}
""")


# Yade takes a pair's constants as a b/(a + b) of those of its bodies, and a dashpot as it is, not over a mass: the grains are of one size.
YADE = """\
import time
O.dt = {time_step}
shared = dict(kn={normal}, ks={tangential}, frictionAngle={angle}, density={density})
grain = O.materials.append(ViscElMat(cn={normal_dashpot}, cs={tangential_dashpot}, **shared))
wall = O.materials.append(ViscElMat(cn=1e30, cs=1e30, **shared))
for line in open("bed.grains.csv").read().splitlines()[1:]:
    x, y, z, radius, vx, vy, vz, wx, wy, wz = map(float, line.split(","))
    body = utils.sphere((x, y, z), radius, material=grain)
    body.state.vel, body.state.angVel = (vx, vy, vz), (wx, wy, wz)
    O.bodies.append(body)
grains = [body for body in O.bodies]
for axis, at, sense in {planes}:
    O.bodies.append(utils.wall(at, axis, sense, material=wall))
O.engines = [ForceResetter(), InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Wall_Aabb()]),
             InteractionLoop([Ig2_Sphere_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom()], [Ip2_ViscElMat_ViscElMat_ViscElPhys()],
                             [Law2_ScGeom_ViscElPhys_Basic()]),
             NewtonIntegrator(damping=0, gravity={gravity})]


def report():
    energy = sum(0.5 * body.state.mass * body.state.vel.squaredNorm() for body in grains)
    print(f"{{O.iter}} {{len(grains)}} {{energy:.10g}}", flush=True)


report()
O.run(1, True)  # finds all neighbours for the first time, as the others do before their loops
start, spent = time.perf_counter(), 0.0
while O.iter < {steps}:
    O.run(min({every} - O.iter % {every}, {steps} - O.iter), True)
    spent += time.perf_counter() - start
    report()
    start = time.perf_counter()
print(f"Loop time of {{spent * {steps} / max(1, {steps} - 1)}}", flush=True)
"""


def write_yade(directory, grains, work):
    write_csv(directory / "bed.grains.csv", grains)
    springs, mass = work.springs, DENSITY * 4 / 3 * math.pi * grains[0].radius**3
    (directory / "bed_yade.py").write_text(YADE.format(
        time_step=work.time_step, normal=2 * springs.normal, tangential=2 * springs.tangential, density=DENSITY, angle=math.atan(FRICTION),
        normal_dashpot=springs.normal_damping * mass, tangential_dashpot=springs.tangential_damping * mass, gravity=gravity(work),
        planes=[("xyz".index(plane.axis), plane.at, plane.inward) for plane in work.planes], steps=work.steps, every=OUTPUT_EVERY))


def contact_tables(work):
    """The laws of a scene and their constants."""
    springs, law = work.springs, work.law
    normal, tangential = {
        "linear": (f"normal_stiffness = {springs.normal}\nnormal_damping_rate = {springs.normal_damping}\n",
                   f"tangential_stiffness = {springs.tangential}\ntangential_damping_rate = {springs.tangential_damping}\nfriction = {FRICTION}\n"),
        "hertz": (f"restitution = {RESTITUTION}\n", f"friction = {FRICTION}\ntangential_damping_factor = 1.0\n"),
    }[law]
    name = {"linear": "spring", "hertz": "mindlin"}[law] if work.friction else "none"
    elastic = f"young_modulus = {YOUNG}\npoisson_ratio = {POISSON}\n" if law == "hertz" else ""
    return (f'[contact]\nnormal = "{law}"\ntangential = "{name}"\ntension = true\n\n[materials.glass]\ndensity = {DENSITY}\n{elastic}\n'
            f"[pairs]\n{normal}{tangential if work.friction else ''}")


def wall_tables(work):
    text = ""
    for plane in work.planes:
        point = [plane.at if axis == plane.axis else 0 for axis in "xyz"]
        normal = [plane.inward if axis == plane.axis else 0 for axis in "xyz"]
        text += f"[walls.{plane.name}]\nplane = {{ point = {point}, normal = {normal} }}\n"
    return text + (f'[walls.mesh]\nmesh = "{work.mesh.name}"\n' if work.mesh else "")


def gravity(work):
    length = sum(component**2 for component in work.gravity) ** 0.5 or 1
    return [GRAVITY * component / length for component in work.gravity]


FROM_FILE = '[grains.bed]\nsource = "file"\nfile = "bed.grains.csv"\n'


def write_tsubu(directory, grains, work, sources=FROM_FILE):
    """Also for scenes that make grains: `sources` then says how, and `grains` is empty."""
    place_mesh(directory, work)
    if grains:
        write_csv(directory / "bed.grains.csv", grains)
    (directory / "bed.toml").write_text(f"""\
title = "{work.name}"

[simulation]
end = {work.steps * work.time_step!r}
gravity = {gravity(work)}
integrator = "symplectic_euler"
time_step = {work.time_step}
overlap_limit = 0.3
ledger = false

{contact_tables(work)}
{sources}
{wall_tables(work)}
[output]
frame_interval = {OUTPUT_EVERY * work.time_step!r}
""")
