"""The work as every code wants it: reads a LAMMPS data file or tsubu's CSV of grains, and writes the inputs of all codes.

All codes start from the same positions and velocities, with empty contact memory, and compute the same thing: a linear
spring-dashpot, or Hertz and Mindlin, with Coulomb friction and tangential memory or without, between planes and perhaps a mesh.
The bed is a square box of five planes, under gravity tilted by thirty degrees; it may be laid out in tiles, box beside box without
the walls between.
"""
import csv
import gzip
import shutil
from dataclasses import dataclass
from pathlib import Path

SIDE = 0.084  # m, of the box in x and y
NORMAL_STIFFNESS = 1000.0  # N/m
TANGENTIAL_STIFFNESS = 285.7  # N/m
NORMAL_DAMPING_RATE = 3118.0  # 1/s: the damping constant over the effective mass (the grain's mass at a wall)
TANGENTIAL_DAMPING_RATE = 1559.0  # 1/s
YOUNG, POISSON, RESTITUTION = 1e7, 0.3, 0.5  # of Hertz and Mindlin, Pa
FRICTION = 0.5
DENSITY = 2500.0  # kg/m3
GRAVITY = 9.81  # m/s2
GRAVITY_DIRECTION = (0.5, 0.0, -0.866)  # LAMMPS and LIGGGHTS normalise it
TIME_STEP = 1e-5  # s
OUTPUT_EVERY = 500  # steps


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


def box(side):
    return (Plane("floor", "z", 0.0, 1), Plane("left", "x", 0.0, 1), Plane("right", "x", side, -1), Plane("front", "y", 0.0, 1),
            Plane("back", "y", side, -1))


@dataclass(frozen=True)
class Work:
    """What is done with some grains."""
    name: str
    steps: int
    law: str = "linear"  # or "hertz"
    friction: bool = True
    time_step: float = TIME_STEP
    planes: tuple = box(SIDE)
    mesh: Path | None = None  # an STL beside the planes
    gravity: tuple = GRAVITY_DIRECTION

    def limits(self, grains):
        """The corners of a box that nothing leaves; planes end it."""
        margin, sides = 0.0005, []
        for k, axis in enumerate("xyz"):
            at = {plane.inward: plane.at for plane in self.planes if plane.axis == axis}
            low, high = min(g.position[k] for g in grains), max(g.position[k] for g in grains)
            sides.append((at[1] - margin if 1 in at else low - 0.1, at[-1] + margin if -1 in at else high + 0.1))
        return sides


def lay_out(grains, tiles, side=SIDE):
    return [Grain(g.radius, (g.position[0] + side * i, g.position[1] + side * j, g.position[2]), g.velocity, g.spin)
            for i in range(tiles) for j in range(tiles) for g in grains]


def read(path):
    """Grains from tsubu's CSV, or from a LAMMPS data file (atom style sphere), possibly compressed."""
    path = Path(path)
    open_it = gzip.open if path.suffix == ".gz" else open
    with open_it(path, "rt", encoding="utf-8") as file:
        return read_csv(file) if ".csv" in path.suffixes else read_lammps(file)


def read_csv(file):
    grains = []
    for row in csv.DictReader(file):
        number = {key: float(value) for key, value in row.items() if key != "material"}
        grains.append(Grain(number["radius"], *(tuple(number[k] for k in keys.split()) for keys in ("x y z", "vx vy vz", "wx wy wz"))))
    return grains


def read_lammps(file):
    """Sections 'Atoms' (id type diameter density x y z …) and 'Velocities' (id vx vy vz wx wy wz)."""
    atoms, velocities, section = {}, {}, None
    for line in file:
        words = line.split("#")[0].split()
        if not words:
            continue
        if words[0] in ("Atoms", "Velocities"):
            section = {"Atoms": atoms, "Velocities": velocities}[words[0]]
        elif section is not None:
            section[int(words[0])] = [float(word) for word in words[1:]]
    grains = []
    for number in sorted(atoms):
        _, diameter, density, *position = atoms[number][:6]
        if density != DENSITY:
            raise SystemExit(f"grain {number} has density {density}; the bed is made for {DENSITY} kg/m3")
        motion = velocities.get(number, [0.0] * 6)
        grains.append(Grain(diameter / 2, tuple(position), tuple(motion[:3]), tuple(motion[3:])))
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


def skin(grains, share):
    """How much farther than contact neighbours are listed, as a share of the smallest radius."""
    return share * min(g.radius for g in grains)


def write_lammps(directory, grains, work):
    """A peer without Hertz and Mindlin as tsubu has them, and without meshes."""
    write_data(directory / "bed.lammps.data", grains, work.name, True, work.limits(grains))
    model = "hooke/history" if work.friction else "hooke"
    values = (NORMAL_STIFFNESS, TANGENTIAL_STIFFNESS, NORMAL_DAMPING_RATE, TANGENTIAL_DAMPING_RATE, FRICTION, 1)
    if not work.friction:
        values = (NORMAL_STIFFNESS, 0, NORMAL_DAMPING_RATE, 0, 0, 0)
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
neighbor {skin(grains, 0.4):g} bin
neigh_modify delay 0 every 1 check yes
read_data bed.lammps.data
pair_style gran/{model} {law}
pair_coeff * *
fix gravity all gravity {GRAVITY} vector {" ".join(map(str, work.gravity))}
fix motion all nve/sphere
{walls}timestep {work.time_step}
thermo_style custom step atoms ke
thermo_modify format float %.10g
thermo {OUTPUT_EVERY}
run {work.steps}
""")


LIGGGHTS = {
    "linear": ("hooke/stiffness",
               {"kn": NORMAL_STIFFNESS, "kt": TANGENTIAL_STIFFNESS, "gamman": NORMAL_DAMPING_RATE, "gammat": TANGENTIAL_DAMPING_RATE,
                "coefficientFriction": FRICTION}),
    "hertz": ("hertz",
              {"youngsModulus": YOUNG, "poissonsRatio": POISSON, "coefficientRestitution": RESTITUTION, "coefficientFriction": FRICTION}),
}


def liggghts_properties(**values):
    material = ("youngsModulus", "poissonsRatio")
    return "".join(f"fix {name} all property/global {name} {'peratomtype' if name in material else 'peratomtypepair 1'} {value}\n"
                   for name, value in values.items())


def place_mesh(directory, work):
    """Codes look for the mesh beside their input."""
    if work.mesh and work.mesh.parent != directory:
        shutil.copy(work.mesh, directory)


def write_liggghts(directory, grains, work):
    place_mesh(directory, work)
    write_data(directory / "bed.liggghts.data", grains, work.name, False, work.limits(grains))
    normal, values = LIGGGHTS[work.law]
    model = f"{normal} tangential {'history' if work.friction else 'off'}"
    walls = "".join(f"fix wall_{plane.name} all wall/gran model {model} primitive type 1 {plane.axis}plane {plane.at}\n" for plane in work.planes)
    if work.mesh:
        walls += f"fix mesh all mesh/surface file {work.mesh.name} type 1\nfix wall_mesh all wall/gran model {model} mesh n_meshes 1 meshes mesh\n"
    (directory / "in.liggghts").write_text(f"""\
atom_style granular
atom_modify map array
boundary f f f
newton off
communicate single vel yes
units si
processors * * 1
neighbor {skin(grains, 0.2):g} bin
neigh_modify delay 0
read_data bed.liggghts.data
{liggghts_properties(**values)}pair_style gran model {model}
pair_coeff * *
timestep {work.time_step}
fix gravity all gravity {GRAVITY} vector {" ".join(map(str, work.gravity))}
{walls}fix motion all nve/sphere
thermo_style custom step atoms ke
thermo_modify format float %.10g
thermo {OUTPUT_EVERY}
run {work.steps}
""")


TSUBU = {
    "linear": (f"normal_stiffness = {NORMAL_STIFFNESS}\nnormal_damping_rate = {NORMAL_DAMPING_RATE}\n",
               f"tangential_stiffness = {TANGENTIAL_STIFFNESS}\ntangential_damping_rate = {TANGENTIAL_DAMPING_RATE}\nfriction = {FRICTION}\n"),
    "hertz": (f"restitution = {RESTITUTION}\n", f"friction = {FRICTION}\ntangential_damping_factor = 1.0\n"),
}


def contact_tables(law, friction=True):
    """The laws of a scene and their constants."""
    normal, tangential = TSUBU[law]
    name = {"linear": "spring", "hertz": "mindlin"}[law] if friction else "none"
    elastic = f"young_modulus = {YOUNG}\npoisson_ratio = {POISSON}\n" if law == "hertz" else ""
    return (f'[contact]\nnormal = "{law}"\ntangential = "{name}"\ntension = true\n\n[materials.glass]\ndensity = {DENSITY}\n{elastic}\n'
            f"[pairs]\n{normal}{tangential if friction else ''}")


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

{contact_tables(work.law, work.friction)}
{sources}
{wall_tables(work)}
[output]
frame_interval = {OUTPUT_EVERY * work.time_step!r}
""")
