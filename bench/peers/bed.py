"""The bed as every code wants it: reads a LAMMPS data file or tsubu's CSV of grains, and writes the inputs of all codes.

All codes start from the same positions and velocities, with empty contact memory, and compute the same thing: a linear
spring-dashpot, or Hertz and Mindlin, with Coulomb friction and tangential memory, in five plane walls, under gravity tilted by thirty
degrees. The box is square; a bed may be laid out in tiles, box beside box without the walls between.
"""
import csv
import gzip
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


@dataclass
class Work:
    """What is done with the bed."""
    steps: int
    law: str = "linear"  # or "hertz"
    tiles: int = 1  # along x and along y

    @property
    def side(self):
        return SIDE * self.tiles


def lay_out(grains, tiles):
    return [Grain(g.radius, (g.position[0] + SIDE * i, g.position[1] + SIDE * j, g.position[2]), g.velocity, g.spin)
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


def write_data(path, grains, title, sphere_style, side=SIDE):
    """A data file of LAMMPS (`sphere_style`) or LIGGGHTS: they differ in what follows the word 'Atoms'."""
    margin = 0.0005
    top = max(g.position[2] for g in grains) + 0.1
    with open(path, "w", encoding="utf-8") as file:
        file.write(f"{title}\n\n{len(grains)} atoms\n1 atom types\n\n")
        file.write(f"{-margin} {side + margin} xlo xhi\n{-margin} {side + margin} ylo yhi\n-0.001 {top:.3f} zlo zhi\n\n")
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


def write_lammps(directory, grains, work):
    write_data(directory / "bed.lammps.data", grains, "bed for LAMMPS", True, work.side)
    law = f"{NORMAL_STIFFNESS} {TANGENTIAL_STIFFNESS} {NORMAL_DAMPING_RATE} {TANGENTIAL_DAMPING_RATE} {FRICTION} 1"
    (directory / "in.lammps").write_text(f"""\
units si
atom_style sphere
boundary f f f
processors * * 1
newton off
comm_modify vel yes
neighbor 0.0004 bin
neigh_modify delay 0 every 1 check yes
read_data bed.lammps.data
pair_style gran/hooke/history {law}
pair_coeff * *
fix gravity all gravity {GRAVITY} vector {" ".join(map(str, GRAVITY_DIRECTION))}
fix motion all nve/sphere
fix floor all wall/gran hooke/history {law} zplane 0.0 NULL
fix sides_x all wall/gran hooke/history {law} xplane 0.0 {work.side}
fix sides_y all wall/gran hooke/history {law} yplane 0.0 {work.side}
timestep {TIME_STEP}
thermo_style custom step atoms ke
thermo_modify format float %.10g
thermo {OUTPUT_EVERY}
run {work.steps}
""")


LIGGGHTS = {
    "linear": ("hooke/stiffness tangential history",
               {"kn": NORMAL_STIFFNESS, "kt": TANGENTIAL_STIFFNESS, "gamman": NORMAL_DAMPING_RATE, "gammat": TANGENTIAL_DAMPING_RATE,
                "coefficientFriction": FRICTION}),
    "hertz": ("hertz tangential history",
              {"youngsModulus": YOUNG, "poissonsRatio": POISSON, "coefficientRestitution": RESTITUTION, "coefficientFriction": FRICTION}),
}


def liggghts_property(name, value):
    kind = "peratomtype" if name in ("youngsModulus", "poissonsRatio") else "peratomtypepair 1"
    return f"fix {name} all property/global {name} {kind} {value}\n"


def write_liggghts(directory, grains, work):
    write_data(directory / "bed.liggghts.data", grains, "bed for LIGGGHTS", False, work.side)
    model, values = LIGGGHTS[work.law]
    walls = "".join(f"fix wall_{name} all wall/gran model {model} primitive type 1 {plane}\n"
                    for name, plane in [("z", "zplane 0.0"), ("x1", "xplane 0.0"), ("x2", f"xplane {work.side}"),
                                        ("y1", "yplane 0.0"), ("y2", f"yplane {work.side}")])
    properties = "".join(liggghts_property(name, value) for name, value in values.items())
    (directory / "in.liggghts").write_text(f"""\
atom_style granular
atom_modify map array
boundary f f f
newton off
communicate single vel yes
units si
processors * * 1
neighbor 0.0002 bin
neigh_modify delay 0
read_data bed.liggghts.data
{properties}pair_style gran model {model}
pair_coeff * *
timestep {TIME_STEP}
fix gravity all gravity {GRAVITY} vector {" ".join(map(str, GRAVITY_DIRECTION))}
{walls}fix motion all nve/sphere
thermo_style custom step atoms ke
thermo_modify format float %.10g
thermo {OUTPUT_EVERY}
run {work.steps}
""")


TSUBU = {
    "linear": f"""[contact]
tension = true

[materials.glass]
density = {DENSITY}

[pairs]
normal_stiffness = {NORMAL_STIFFNESS}
tangential_stiffness = {TANGENTIAL_STIFFNESS}
normal_damping_rate = {NORMAL_DAMPING_RATE}
tangential_damping_rate = {TANGENTIAL_DAMPING_RATE}
friction = {FRICTION}
""",
    "hertz": f"""[contact]
normal = "hertz"
tangential = "mindlin"
tension = true

[materials.glass]
density = {DENSITY}
young_modulus = {YOUNG}
poisson_ratio = {POISSON}

[pairs]
restitution = {RESTITUTION}
friction = {FRICTION}
tangential_damping_factor = 1.0
""",
}


def write_tsubu(directory, grains, work):
    write_csv(directory / "bed.grains.csv", grains)
    length = sum(component**2 for component in GRAVITY_DIRECTION) ** 0.5
    gravity = [GRAVITY * component / length for component in GRAVITY_DIRECTION]
    walls = "".join(f"[walls.{name}]\nplane = {{ point = {point}, normal = {normal} }}\n"
                    for name, point, normal in [("floor", [0, 0, 0], [0, 0, 1]),
                                                ("left", [0, 0, 0], [1, 0, 0]), ("right", [work.side, 0, 0], [-1, 0, 0]),
                                                ("front", [0, 0, 0], [0, 1, 0]), ("back", [0, work.side, 0], [0, -1, 0])])
    (directory / "bed.toml").write_text(f"""\
title = "A settled bed in a box that tilts by thirty degrees"

[simulation]
end = {work.steps * TIME_STEP!r}
gravity = {gravity}
integrator = "symplectic_euler"
time_step = {TIME_STEP}
ledger = false

{TSUBU[work.law]}
[grains.bed]
source = "file"
file = "bed.grains.csv"

{walls}
[output]
frame_interval = {OUTPUT_EVERY * TIME_STEP!r}
""")
