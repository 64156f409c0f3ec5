"""The programs that are measured: how each is run, and what is taken from a run."""
import csv
import json
import os
import re
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import bed

ROOT = Path(__file__).resolve().parents[2]
BUILD = "cmake --preset release && cmake --build --preset release"


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
    """Runs a command; stops with its last lines when it fails."""
    # As root (in a container) Open MPI wants to be told twice.
    environment = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", OMP_NUM_THREADS="1")
    done = subprocess.run([sys.executable, "-c", STARTER, *command], cwd=directory, env=environment, stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)} failed with code {done.returncode}:\n" + "\n".join(done.stdout.splitlines()[-20:]))
    text, _, usage = done.stdout.rpartition("\nusage ")
    seconds, peak = usage.split()
    return Finished(text, float(seconds), int(peak))


class Lammps:
    """LAMMPS, and LIGGGHTS, which descends from it and reports in the same words."""

    def __init__(self, name, program, write):
        self.name, self.program, self.write = name, program, write
        self.input = f"in.{name.lower()}"
        # -h of LIGGGHTS waits for input; its banner of an empty run names the version too.
        found = re.search(r"(?:LAMMPS \(|Version LIGGGHTS-PUBLIC )([^),]+)", call([program, "-log", "none"], ".").text)
        self.version = found[1] if found else "unknown"

    def can(self, work):
        """LAMMPS of 29 September 2021 damps Hertz contacts otherwise and has no meshes."""
        return self.name == "LIGGGHTS" or (work.law == "linear" and not work.mesh)

    def prepare(self, directory, grains, work):
        self.write(directory, grains, work)

    def run(self, directory, cores):
        command = [self.program, "-in", self.input, "-log", "none"]
        if cores > 1:
            command = ["mpirun", "-np", str(cores), "--oversubscribe"] + command
        text = call(command, directory).text
        energies = {int(step): float(energy) for step, energy in re.findall(r"^\s*(\d+)\s+\d+\s+([\d.e+-]+)\s*$", text, re.M)}
        return Measurement(float(re.search(r"Loop time of ([\d.e+-]+)", text)[1]), energies)


class Tsubu:
    name = "tsubu"

    def __init__(self, program):
        self.program = str(Path(program).resolve())
        self.version = call([self.program, "--version"], ".").text.split()[-1]
        self.energies = {}  # by directory

    def can(self, _):
        return True

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
    for name, program, write in [("LAMMPS", "lmp", bed.write_lammps), ("LIGGGHTS", "liggghts", bed.write_liggghts)]:
        if shutil.which(program):
            peers.append(Lammps(name, program, write))
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
