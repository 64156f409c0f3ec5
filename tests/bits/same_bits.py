#!/usr/bin/env python3
"""One scene, one state: runs a scene with several numbers of threads, with the portable instruction set, and, given a second
program, all that with it too.

    same_bits.py SCENE UNTIL PROGRAM [OTHER_PROGRAM]

Fails unless every run took the same number of steps and ended with the same state hash.
"""
import json
import subprocess
import sys
import tempfile
from pathlib import Path

VARIANTS = [["--threads", str(threads)] for threads in (1, 2, 3, 8)] + [["--threads", "2", "--isa", "portable"]]


def state_of(program, scene, until, options):
    with tempfile.TemporaryDirectory() as out:
        command = [program, "run", scene, "-o", out, "--until", until, "--no-frames", *options]
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        if done.returncode != 0:
            sys.exit(f"{' '.join(command)} ended with code {done.returncode}:\n{done.stdout}")
        report = json.loads((Path(out) / "run.json").read_text())
        return report["state_hash"], report["steps"], report["grains"]


def main(arguments):
    if len(arguments) < 4:
        sys.exit(__doc__)
    scene, until, *programs = arguments[1:]
    states = {}
    for program in programs:
        for options in VARIANTS:
            state = state_of(program, scene, until, options)
            states.setdefault(state, []).append(" ".join([program, *options]))
    for (state_hash, steps, grains), runs in states.items():
        print(f"{state_hash} after {steps} steps of {grains} grains:", *runs, sep="\n  ")
    if any(steps == 0 or grains == 0 for _, steps, grains in states):
        sys.exit("nothing was simulated, so nothing was compared")
    if len(states) != 1:
        sys.exit(f"{len(states)} different states")


if __name__ == "__main__":
    main(sys.argv)
