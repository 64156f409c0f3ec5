"""The programs that are measured: how each is run, and what is taken from a run."""
import csv
import json
import os
import re
import shutil
import subprocess
import sys
from dataclasses import dataclass, replace
from pathlib import Path

import bed

ROOT = Path(__file__).resolve().parents[2]
BUILD = "cmake --preset release && cmake --build --preset release"


class Failed(Exception):
    """A program that did not do what it was asked; the sentence has its last words."""


@dataclass
class Finished:
    text: str           # what the command printed
    cpu_seconds: float
    peak_bytes: int     # of resident memory; of a command that starts others, the largest of them


@dataclass
class Measurement:
    seconds: float  # of the loop over the steps, without reading and writing
    energies: dict  # step -> kinetic energy, J
    state_hash: str = ""
    contacts: float = 0  # between grains, and with walls: the mean of the table's rows
    peak_bytes: int = 0
    wall_seconds: float = 0  # of the whole run


# A program's peak of memory begins with that of the process that starts it: this one is small, whatever the script has in memory.
STARTER = """import os, subprocess, sys
_, status, usage = os.wait4(subprocess.Popen(sys.argv[1:]).pid, 0)
print(f"\\nusage {usage.ru_utime + usage.ru_stime} {1024 * usage.ru_maxrss}", flush=True)
sys.exit(os.waitstatus_to_exitcode(status) % 256)"""


def call(command, directory):
    """Runs a command. Raises Failed with its last lines."""
    # As root (in a container) Open MPI wants to be told twice.
    environment = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", OMP_NUM_THREADS="1")
    done = subprocess.run([sys.executable, "-c", STARTER, *command], cwd=directory, env=environment, stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode != 0:
        last = [line for line in done.stdout.splitlines() if not line.startswith("usage ")][-20:]
        raise Failed(f"{' '.join(command)} failed with code {done.returncode}:\n" + "\n".join(last))
    text, _, usage = done.stdout.rpartition("\nusage ")
    seconds, peak = usage.split()
    return Finished(text, float(seconds), int(peak))


def told(text):
    """What a peer has printed of its loop: lines of step, grains and energy (nan too), and its time."""
    energies = {int(step): float(energy) for step, energy in re.findall(r"^\s*(\d+)\s+\d+\s+([-+.\w]+)\s*$", text, re.M)}
    seconds = re.search(r"Loop time of ([\d.e+-]+)", text)
    if not seconds:
        raise Failed("It printed no time of its loop:\n" + "\n".join(text.splitlines()[-20:]))
    return Measurement(float(seconds[1]), energies)


class Lammps:
    """LAMMPS, and LIGGGHTS, which descends from it and reports in the same words."""

    def __init__(self, name, program, write):
        self.name, self.program, self.write = name, program, write
        self.input = f"in.{name.lower()}"
        self.skin_of = {}
        # -h of LIGGGHTS waits for input; its banner of an empty run names the version too.
        found = re.search(r"(?:LAMMPS \(|Version LIGGGHTS-PUBLIC )([^),]+)", call([program, "-log", "none"], ".").text)
        self.version = found[1] if found else "unknown"

    def can(self, work, _):
        """LAMMPS of 29 September 2021 damps Hertz contacts otherwise and has no meshes."""
        return self.name == "LIGGGHTS" or (work.law == "linear" and not work.mesh)

    def part(self, work):
        return work

    # Shares of the smallest radius. With more grains than can be tried for long, what was best for thirty thousand.
    SKINS, USUAL_SKIN, TRIED = (0.1, 0.2, 0.3, 0.45), 0.2, 50_000

    def prepare(self, directory, grains, work):
        """With the skin that makes it fastest, of some that are tried: over all steps, because grains may become faster."""
        smallest, of = min(g.radius for g in grains), (work.law, work.friction, work.mesh, len(grains))
        if of not in self.skin_of and len(grains) <= self.TRIED:
            seconds = {}
            for share in self.SKINS:
                self.write(directory, grains, work, share * smallest)
                seconds[share] = self.run(directory, 1).seconds
            self.skin_of[of] = min(self.SKINS, key=seconds.get)
            print(f"{work.name}, {self.name}: skins as shares of the smallest radius, " +
                  ", ".join(f"{share}: {seconds[share]:.2f} s" for share in self.SKINS) + f"; {self.skin_of[of]} is taken", flush=True)
        self.write(directory, grains, work, self.skin_of.get(of, self.USUAL_SKIN) * smallest)

    def run(self, directory, cores):
        command = [self.program, "-in", self.input, "-log", "none"]
        if cores > 1:
            command = ["mpirun", "-np", str(cores), "--oversubscribe"] + command
        return told(call(command, directory).text)


class Yade:
    name = "Yade"

    def __init__(self, program):
        self.program = program
        self.version = call([program, "--version"], ".").text.split()[-1]

    def can(self, work, grains):
        """Its dashpots are not over a mass: grains of one size only. Its Hertz contacts are damped otherwise."""
        return work.law == "linear" and work.friction and not work.mesh and len({g.radius for g in grains}) == 1

    def part(self, work):
        """So slow that it is given the first steps only."""
        return replace(work, steps=min(work.steps, bed.OUTPUT_EVERY))

    def prepare(self, directory, grains, work):
        bed.write_yade(directory, grains, self.part(work))

    def run(self, directory, cores):
        return told(call([self.program, "-n", "-x", f"-j{cores}", "bed_yade.py"], directory).text)


class Tsubu:
    name = "tsubu"

    def __init__(self, program):
        self.program = str(Path(program).resolve())
        self.version = call([self.program, "--version"], ".").text.split()[-1]
        self.energies = {}  # by directory

    def can(self, _work, _grains):
        return True

    def part(self, work):
        return work

    def has(self, isa, directory):
        """Is this instruction set in the program, and in the processor?"""
        bed.write_tsubu(directory, [bed.Grain(1e-3, (0.01, 0.01, 0.01), (0.0,) * 3, (0.0,) * 3)], bed.Work("one grain", 1))
        command = [self.program, "run", "bed.toml", "-o", "tsubu", "--no-frames", "--isa", isa]
        return subprocess.run(command, cwd=directory, capture_output=True).returncode == 0

    def prepare(self, directory, grains, work):
        bed.write_tsubu(directory, grains, work)
        self.energies[directory] = self.energies_of(directory, work)

    def energies_of(self, directory, work, *options):
        """By step, from a run of its own: the measured ones keep no ledger, as the peers keep none."""
        self.simulate(directory, 1, "--set", "simulation.ledger=true", *options)
        return {round(float(row["time_s"]) / work.time_step): float(row["kinetic_bulk_J"]) + float(row["kinetic_fluctuation_J"])
                for row in self.ledger(directory)}

    @staticmethod
    def ledger(directory):
        with open(directory / "tsubu" / "ledger.csv", encoding="utf-8", newline="") as file:
            return list(csv.DictReader(file))

    def simulate(self, directory, cores, *options, frames=False):
        done = call([self.program, "run", "bed.toml", "-o", "tsubu", "--threads", str(cores), *([] if frames else ["--no-frames"]), *options],
                    directory)
        return done, json.loads((directory / "tsubu" / "run.json").read_text())

    MIXED = ("--set", "simulation.precision=mixed")

    def run(self, directory, cores, isa="", frames=False, mixed=False):
        done, report = self.simulate(directory, cores, *(["--isa", isa] if isa else []), *(self.MIXED if mixed else ()), frames=frames)
        contacts = [float(row["contacts"]) for row in self.ledger(directory)]
        return Measurement(report["simulation_time"], self.energies.get(directory, {}), report["state_hash"], sum(contacts) / len(contacts),
                           done.peak_bytes, report["wall_time"])


def find_tsubu(program):
    if not Path(program).is_file():
        sys.exit(f"There is no {program} ({BUILD}).")
    return Tsubu(program)


def find_peers():
    peers = []
    for name, program, make in [("LAMMPS", "lmp", lambda path: Lammps("LAMMPS", path, bed.write_lammps)),
                                ("LIGGGHTS", "liggghts", lambda path: Lammps("LIGGGHTS", path, bed.write_liggghts)), ("Yade", "yade", Yade)]:
        path = shutil.which(program)
        if path:
            try:
                peers.append(make(path))
            except Failed as failure:
                print(f"{name} is left out: {failure}")
        else:
            print(f"{name} is left out: apt-get install {name.lower()}")
    return peers


def settle(target, scene=None, threads=1):
    """Grains at rest, or as they are at the end of a scene, made by tsubu; once for the same file name."""
    if target.is_file():
        return
    maker = ROOT / "build/release/bench/bed/settle_bed"
    if not maker.is_file():
        sys.exit(f"There is no {target}, and no {maker} to make it ({BUILD}).")
    print(f"tsubu makes {target.name} (once) …", flush=True)
    unfinished = target.with_name("unfinished.csv")
    print("  " + call([str(maker), str(unfinished), str(threads)] + ([str(scene)] if scene else []), target.parent).text.strip())
    unfinished.rename(target)
