#!/usr/bin/env python3
"""LIGGGHTS and LAMMPS as witnesses for other laws than that of the bed: laws.py [--tsubu PROGRAM] [-o FOLDER]

Some hundred grains, thrown together in five plane walls, go through the same 500 steps in all codes; the script prints by how much the
kinetic energies (of translation) differ. Early on, because a granular flow is chaotic: correct codes drift apart by a factor of ten
every few hundred steps. Where two codes do not mean quite the same by a law, the case says so, and the difference is what it is.
Small ones are everywhere: LIGGGHTS touches a wall half an overlap before it, and lets springs shorten as their contact turns.
"""
import argparse
import csv
import math
import random
import re
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import bed

ROOT = Path(__file__).resolve().parents[2]
STEPS, EVERY, DT = 500, 100, 1e-6
YOUNG, POISSON, FRICTION, RESTITUTION, ROLLING = 5e7, 0.3, 0.4, 0.7, 0.05
STIFFNESS, TANGENTIAL = 4000.0, 1200.0
DAMPING_RATE, TANGENTIAL_DAMPING_RATE = 900.0, 500.0
AIM = 2e-4
WORK = bed.Work("crowd", STEPS)


@dataclass
class Case:
    name: str
    note: str
    liggghts: tuple  # model and its properties, or empty
    lammps: tuple    # pair granular between grains and at walls, or empty
    contact: str     # tables of tsubu


def damping_ratio(restitution):
    """ζ of an oscillator with this restitution, tension allowed."""
    log = math.log(restitution)
    return -log / math.sqrt(math.pi**2 + log**2)


def restitution_like_tsuji(e):
    """LAMMPS' damping tsuji is a polynomial in e, η = α √(m k_n); tsubu's η is √5 ζ √(m k_n). The e of tsubu with the same η."""
    alpha = 1.2728 - 4.2783 * e + 11.087 * e**2 - 22.348 * e**3 + 27.467 * e**4 - 18.022 * e**5 + 4.8218 * e**6
    zeta = alpha / math.sqrt(5)
    return math.exp(-math.pi * zeta / math.sqrt(1 - zeta**2))


def hertz(more="", e=RESTITUTION, tangential="mindlin", friction=FRICTION, factor=1.0):
    return f"""[contact]
normal = "hertz"
tangential = "{tangential}"
tension = true
{more}
[materials.glass]
density = {bed.DENSITY}
young_modulus = {YOUNG}
poisson_ratio = {POISSON}
[pairs]
restitution = {e}
friction = {friction}
tangential_damping_factor = {factor}
"""


def linear(more="", friction=FRICTION, tangential="spring"):
    return f"""[contact]
tangential = "{tangential}"
tension = true
{more}
[materials.glass]
density = {bed.DENSITY}
[pairs]
normal_stiffness = {STIFFNESS}
tangential_stiffness = {TANGENTIAL}
normal_damping_rate = {DAMPING_RATE}
tangential_damping_rate = {TANGENTIAL_DAMPING_RATE}
friction = {friction}
rolling_friction = {ROLLING}
"""


properties = bed.liggghts_properties


def hertz_properties(friction=FRICTION):
    return properties(youngsModulus=YOUNG, poissonsRatio=POISSON, coefficientRestitution=RESTITUTION, coefficientFriction=friction)


def linear_properties(friction=FRICTION, **more):
    return properties(kn=STIFFNESS, kt=TANGENTIAL, gamman=DAMPING_RATE, gammat=TANGENTIAL_DAMPING_RATE, coefficientFriction=friction, **more)


def granular(tangential, friction=FRICTION):
    """Between grains and at walls. Walls of 29 Sep 2021 take 1 - nu for 1 - nu^2, and E (2 - nu)(1 + nu)/4 for 2 E/((2 - nu)(1 + nu)):
    they are told another modulus, and the tangential stiffness itself."""
    rest = f"tangential {tangential} {{}} 1.0 {friction} damping tsuji"
    shear = 2 * YOUNG / ((2 - POISSON) * (1 + POISSON))  # 8 G*
    return (f"hertz/material {YOUNG} {RESTITUTION} {POISSON} {rest.format('NULL')}",
            f"hertz/material {YOUNG / (1 + POISSON)} {RESTITUTION} {POISSON} {rest.format(shear)}")


def hooke(friction=FRICTION):
    """Damping over the effective mass, and the tangential one as a share of it."""
    same = (f"hooke {STIFFNESS} {DAMPING_RATE} tangential linear_history {TANGENTIAL} {TANGENTIAL_DAMPING_RATE / DAMPING_RATE} {friction} "
            "damping mass_velocity")
    return same, same


SAME = "the same law"
STICKS = 100.0  # a friction that no contact exceeds
RADII = "LAMMPS takes the slip at the radii, tsubu at the contact point, which the overlap brings nearer"
CUT = "that, and at the limit tsubu cuts spring and dashpot alike (T2), LAMMPS the spring alone (T13)"
STICK = "at the limit tsubu cuts spring and dashpot alike (T2); LIGGGHTS holds the spring to the limit and damps only while it sticks (T14)"
RISES = "tsubu's force stays when the stiffness rises (T8), LIGGGHTS' displacement stays (T15)"
HISTORY, LINEAR_HISTORY = "hertz tangential history", "hooke/stiffness tangential history"


def cases():
    """Name, what to know of it, and what each code is told."""
    # LAMMPS damps the slip as the normal motion, η_t = η_n; tsubu and LIGGGHTS with √(k_t/S) of it, here √(4 G*/E*).
    as_lammps = {"e": restitution_like_tsuji(RESTITUTION), "factor": math.sqrt((2 - POISSON) / (2 * (1 - POISSON)))}
    rolling = {"coefficientRollingFriction": ROLLING}
    stuck, sliding = linear_properties(STICKS), linear_properties()
    hertz_stuck, hertz_sliding = hertz_properties(STICKS), hertz_properties()
    return [
        Case("linear, sticking", SAME, (LINEAR_HISTORY, stuck), (), linear(friction=STICKS)),
        Case("linear, sticking", RADII, (), hooke(STICKS), linear(friction=STICKS)),
        Case("linear, sliding, luding_spring", RADII, (), hooke(), linear(tangential="luding_spring")),
        Case("linear, sliding", CUT, (), hooke(), linear()),
        Case("linear, sliding, limited_spring", SAME, (LINEAR_HISTORY, sliding), (), linear(tangential="limited_spring")),
        Case("linear, sliding", STICK, (LINEAR_HISTORY, sliding), (), linear()),
        Case("Hertz, smooth", SAME, ("hertz tangential off", hertz_sliding), (), hertz(tangential="none")),
        Case("Hertz and mindlin_displacement, sticking", SAME, (HISTORY, hertz_stuck), (), hertz(tangential="mindlin_displacement", friction=STICKS)),
        Case("Hertz and mindlin_displacement, sliding", SAME, (HISTORY, hertz_sliding), (), hertz(tangential="mindlin_displacement")),
        Case("Hertz and Mindlin, sticking", RISES, (HISTORY, hertz_stuck), (), hertz(friction=STICKS)),
        Case("Hertz and Mindlin, sliding", "both", (HISTORY, hertz_sliding), (), hertz()),
        Case("Hertz and mindlin_displacement, sticking", RADII, (), granular("mindlin", STICKS),
             hertz(tangential="mindlin_displacement", friction=STICKS, **as_lammps)),
        Case("Hertz and Mindlin rescaled, sticking", RADII, (), granular("mindlin_rescale/force", STICKS), hertz(friction=STICKS, **as_lammps)),
        Case("Hertz and Mindlin not rescaled, sticking", RADII, (), granular("mindlin/force", STICKS),
             hertz("rescale = false", friction=STICKS, **as_lammps)),
        Case("Hertz and Mindlin rescaled, sliding", CUT, (), granular("mindlin_rescale/force"), hertz(**as_lammps)),
        Case("linear, sticking, rolling cdt", "LIGGGHTS takes the spring's part of the normal force for the moment, and only its part across n",
             (LINEAR_HISTORY + " rolling_friction cdt", linear_properties(STICKS, **rolling)), (), linear('rolling = "constant"', STICKS)),
        Case("linear, sticking, rolling epsd", SAME,
             (LINEAR_HISTORY + " rolling_friction epsd", linear_properties(STICKS, **rolling, coefficientRollingViscousDamping=0.3)), (),
             linear('rolling = "elastic_plastic"', STICKS)),
    ]


def crowd():
    """Grains of three sizes on a loose lattice, thrown at each other."""
    numbers = random.Random(3)
    grains = []
    for i in range(9):
        for j in range(9):
            for k in range(6):
                radius = numbers.choice((0.0018, 0.0020, 0.0022))
                position = tuple(0.0046 * (n + 0.5) + numbers.uniform(-5e-5, 5e-5) for n in (i, j, k))
                grains.append(bed.Grain(radius, position, tuple(numbers.uniform(-1, 1) for _ in range(3)), tuple(numbers.uniform(-150, 150) for _ in range(3))))
    return grains


def liggghts(case, folder, grains):
    model, fixes = case.liggghts
    bed.write_data(folder / "crowd.data", grains, "crowd", False, WORK.limits(grains))
    walls = "".join(f"fix wall_{plane.name} all wall/gran model {model} primitive type 1 {plane.axis}plane {plane.at}\n" for plane in WORK.planes)
    (folder / "in.case").write_text(f"""\
atom_style granular
atom_modify map array
boundary f f f
newton off
communicate single vel yes
units si
neighbor 0.0004 bin
neigh_modify delay 0
read_data crowd.data
{fixes}pair_style gran model {model}
pair_coeff * *
timestep {DT}
fix gravity all gravity {bed.GRAVITY} vector {" ".join(map(str, bed.GRAVITY_DIRECTION))}
{walls}fix motion all nve/sphere
thermo_style custom step atoms ke
thermo_modify format float %.12g
thermo {EVERY}
run {STEPS}
""")
    return energies("liggghts", folder)


def lammps(case, folder, grains):
    bed.write_data(folder / "crowd.data", grains, "crowd", True, WORK.limits(grains))
    walls = "".join(f"fix wall_{plane.name} all wall/gran granular {case.lammps[1]} {plane.axis}plane " +
                    (f"{plane.at} NULL\n" if plane.inward > 0 else f"NULL {plane.at}\n") for plane in WORK.planes)
    (folder / "in.case").write_text(f"""\
units si
atom_style sphere
boundary f f f
newton off
comm_modify vel yes
neighbor 0.0004 bin
neigh_modify delay 0 every 1 check yes
read_data crowd.data
pair_style granular
pair_coeff * * {case.lammps[0]}
fix gravity all gravity {bed.GRAVITY} vector {" ".join(map(str, bed.GRAVITY_DIRECTION))}
fix motion all nve/sphere
{walls}timestep {DT}
thermo_style custom step atoms ke
thermo_modify format float %.12g
thermo {EVERY}
run {STEPS}
""")
    return energies("lmp", folder)


def call(command, folder):
    done = subprocess.run(command, cwd=folder, input="", stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))} failed:\n" + "\n".join(done.stdout.splitlines()[-15:]))
    return done.stdout


def energies(program, folder):
    text = call([program, "-in", "in.case", "-log", "none"], folder)
    return {int(step): float(energy) for step, energy in re.findall(r"^\s*(\d+)\s+\d+\s+([\d.e+-]+)\s*$", text, re.M)}


def tsubu(case, folder, grains, program):
    bed.write_csv(folder / "crowd.csv", grains)
    (folder / "crowd.toml").write_text(f"""\
[simulation]
end = {(STEPS + 1) * DT!r}
gravity = {bed.gravity(WORK)}
integrator = "symplectic_euler"
time_step = {DT}
overlap_limit = 0.3
{case.contact}[grains.crowd]
source = "file"
file = "crowd.csv"
{bed.wall_tables(WORK)}[output]
frame_interval = {EVERY * DT!r}
ledger_interval = {DT}
""")
    call([program, "run", "crowd.toml", "-o", "tsubu", "--no-frames", "--threads", "1"], folder)
    with open(folder / "tsubu" / "ledger.csv", encoding="utf-8", newline="") as file:
        own = {round(float(row["time_s"]) / DT): float(row["kinetic_bulk_J"]) + float(row["kinetic_fluctuation_J"]) for row in csv.DictReader(file)}
    # Velocities of symplectic Euler are half a step old where the peers bring theirs up to date.
    return {step: 0.5 * (own[step] + own[step + 1]) if step > 0 else own[0] for step in own if step + 1 in own}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--tsubu", default=str(ROOT / "build/release/src/app/tsubu"), help="the program")
    parser.add_argument("-o", "--output", type=Path, default=ROOT / "out/laws", help="directory for inputs and results")
    arguments = parser.parse_args()
    arguments.output.mkdir(parents=True, exist_ok=True)
    grains = crowd()
    print(f"{len(grains)} grains; difference of tsubu's kinetic energy after {EVERY} … {STEPS} steps; the aim for the same law is {AIM:.2%} after {STEPS}")
    worst = 0.0
    for case in cases():
        for name, program, run, told in (("LIGGGHTS", "liggghts", liggghts, case.liggghts), ("LAMMPS", "lmp", lammps, case.lammps)):
            if not told:
                continue
            if not shutil.which(program):
                print(f"{case.name}: left out, there is no {name} (apt-get install {name.lower()})")
                continue
            theirs = run(case, arguments.output, grains)
            ours = tsubu(case, arguments.output, grains, str(Path(arguments.tsubu).resolve()))
            steps = sorted(set(theirs) & set(ours))
            print(f"{case.name} ({case.note})\n  " + "  ".join(f"{step}: {ours[step] / theirs[step] - 1:+.4%}" for step in steps if step > 0) +
                  f"   energy left {ours[STEPS] / ours[0]:.2f}")
            if case.note.startswith(SAME):
                worst = max(worst, abs(ours[STEPS] / theirs[STEPS] - 1))
    return 0 if worst < AIM else 1


if __name__ == "__main__":
    sys.exit(main())
