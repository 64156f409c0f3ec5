"""The program as a user meets it: exit codes, files, interruption, messages. Usage: program_test.py TSUBU"""

import csv
import json
import os
import pathlib
import signal
import struct
import subprocess
import sys
import tempfile
import time
import unittest

PROGRAM = ""

SCENE = """
title = "Two balls"
[simulation]
end = 0.2
[materials]
ball = { density = 1000 }
[pairs]
normal_stiffness = 1e5
restitution = 0.8
friction = 0.3
[grains.balls]
source = "list"
radius = 0.02
positions = [[0, 0, 0.06], [0.1, 0, 0.1]]
[walls.floor]
plane = {}
[output]
fps = 50
[picture]
width = 160
height = 96
quality = "draft"
"""


def run(*arguments, **options):
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, timeout=120, **options)


class Program(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.path = pathlib.Path(self.folder.name)
        self.scene = self.path / "two.toml"
        self.scene.write_text(SCENE)
        self.out = self.path / "out"

    def report(self):
        return json.loads((self.out / "run.json").read_text())

    def frames(self):
        return sorted(path.name for path in (self.out / "frames").iterdir())

    def test_run_writes_frames_ledger_and_report(self):
        result = run("run", self.scene, "-o", self.out)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(self.frames(), [f"{k:06}.png" for k in range(11)])
        report = self.report()
        for key in ("version", "scene", "threads", "threads_used", "dt", "dt_limit_by", "steps", "simulated_time", "wall_time", "grain_steps_per_second",
                    "grains", "lost", "removed", "energy_residual", "state_hash", "frames", "renderer"):
            self.assertIn(key, report)
        self.assertEqual((report["grains"], report["frames"], report["lost"], report["ended"]), (2, 11, 0, "complete"))
        self.assertAlmostEqual(report["simulated_time"], 0.2, places=9)
        self.assertLess(report["energy_residual"], 0.005)
        with open(self.out / "ledger.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), 11)
        self.assertEqual({len(row) for row in rows}, {len(rows[0])})
        for k, row in enumerate(rows):
            self.assertAlmostEqual(float(row["time_s"]), k / 50, places=9)
            self.assertNotIn(None, row.values())
        turnover = abs(float(rows[-1]["residual_J"])) / float(rows[-1]["residual_fraction"])
        self.assertAlmostEqual(report["worst_energy_residual"], max(abs(float(row["residual_J"])) for row in rows) / turnover, delta=1e-8)
        header = (self.out / "frames" / "000000.png").read_bytes()
        self.assertEqual(struct.unpack(">II", header[16:24]), (160, 96))

    def test_free_fall_in_the_ledger(self):
        run("run", self.scene, "-o", self.out, "--no-frames")
        with open(self.out / "ledger.csv", newline="") as file:
            row = list(csv.DictReader(file))[1]
        mass = 2 * 1000 * 4 / 3 * 3.141592653589793 * 0.02**3
        kinetic = sum(float(row[name]) for name in ("kinetic_bulk_J", "kinetic_fluctuation_J", "kinetic_rotation_J"))
        self.assertAlmostEqual(kinetic / (0.5 * mass * (9.81 * 0.02) ** 2), 1, places=6)
        self.assertAlmostEqual(float(row["momentum_z"]) / (-mass * 9.81 * 0.02), 1, places=6)

    def table(self, name):
        with open(self.out / name, newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertNotIn(None, [value for row in rows for value in row.values()])
        return rows

    def test_diagnostics_are_written_when_asked_for_and_change_nothing(self):
        plain = SCENE
        self.scene.write_text(plain + """
[diagnostics]
every = 5
regions = { left = { box = { min = [-0.02, -0.02, 0], max = [0.02, 0.02, 0.1] } } }
grid = { box = { min = [-0.02, -0.02, 0], max = [0.12, 0.02, 0.12] }, cells = { x = 7, z = 3 } }
""")
        result = run("run", self.scene, "-o", self.out, "--no-frames")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("diagnostics.csv, walls.csv, grid.csv", result.stdout)
        rows, walls, cells = self.table("diagnostics.csv"), self.table("walls.csv"), self.table("grid.csv")
        self.assertEqual([(row["time_s"], row["region"]) for row in rows],
                         [(time, region) for time in ("0", "0.1", "0.2") for region in ("whole", "left")])
        volume = 4 / 3 * 3.141592653589793 * 0.02**3
        whole, left = rows[0], rows[1]
        self.assertAlmostEqual(float(whole["volume_m3"]), 0.14 * 0.04 * 0.08)  # around the two balls
        self.assertAlmostEqual(float(whole["solid_fraction"]), 2 * volume / (0.14 * 0.04 * 0.08))
        self.assertEqual((whole["grains"], left["grains"], whole["temperature_m2_per_s2"]), ("2", "1", "0"))
        self.assertAlmostEqual(float(left["solid_fraction"]), volume / (0.04 * 0.04 * 0.1))
        self.assertEqual([row["wall"] for row in walls], ["floor"] * 3)
        self.assertEqual(len(cells), 3 * 21)
        filled = sum(float(row["solid_fraction"]) for row in cells[:21]) * 0.14 * 0.04 * 0.12 / 21
        self.assertAlmostEqual(filled / (2 * volume), 1, places=6)

        measured = self.report()["state_hash"]
        self.scene.write_text(plain)
        run("run", self.scene, "-o", self.out, "--no-frames")
        self.assertEqual(self.report()["state_hash"], measured)
        self.assertFalse((self.out / "diagnostics.csv").exists() or (self.out / "grid.csv").exists())

    def test_files_hold_numbers_also_when_there_is_no_grain(self):
        """Before the first grain comes there is no mean, no share and no centre: nothing of that may be "not a number"."""
        self.scene.write_text("""
[simulation]
end = 0.02
[materials]
ball = { density = 1000, conductivity = 1, heat_capacity = 800 }
[heat]
[pairs]
normal_stiffness = 1e3
restitution = 0.8
friction = 0.3
[grains.late]
source = "stream"
box = { min = [0, 0, 0.05], max = [0.02, 0.02, 0.07] }
rate = "1000 grains/s"
start = 0.012
radius = "1 mm"
[walls.floor]
plane = {}
[counters.plane]
point = [0, 0, 0.01]
[diagnostics]
regions = { below = { box = { min = [0, 0, 0], max = [0.02, 0.02, 0.03] } } }
grid = { box = { min = [0, 0, 0], max = [0.02, 0.02, 0.1] }, cells = { z = 4 } }
[observe]
rate = { kind = "discharge_rate", counter = "plane" }
empty = { kind = "time_to_empty", counter = "plane" }
slope = { kind = "angle_of_repose" }
mixing = { kind = "mixing", material = "ball", cell = "1 cm" }
residual = { kind = "energy_residual" }
[show]
forces = "all"
[colours]
by = "temperature"
[picture]
width = 64
height = 36
[output]
frame_interval = 0.004
""")
        result = run("run", self.scene, "-o", self.out)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertGreater(self.report()["grains"], 0)
        names = sorted(path.name for path in self.out.iterdir() if path.suffix == ".csv")
        self.assertEqual(names, ["diagnostics.csv", "grid.csv", "ledger.csv", "walls.csv"])
        for name in names:
            self.assertNotRegex((self.out / name).read_text().lower(), r"\b(nan|inf)\b", name)
        json.loads((self.out / "run.json").read_text(), parse_constant=lambda word: self.fail(f"{word} in run.json"))

    def test_results_depend_on_neither_threads_nor_isa_nor_frames(self):
        hashes = set()
        for options in (["--no-frames", "--threads", 1], ["--no-frames", "--threads", 3], ["--no-frames", "--isa", "portable"], [],
                        ["--set", "output.ledger_interval=0.1"]):
            run("run", self.scene, "-o", self.out, *options)
            hashes.add((self.report()["state_hash"]))
        self.assertEqual(len(hashes), 1)

    def test_until_set_and_no_frames(self):
        result = run("run", self.scene, "-o", self.out, "--no-frames", "--until", "0.05", "--set", "grains.balls.radius=0.01")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertFalse((self.out / "frames").exists())
        self.assertAlmostEqual(self.report()["simulated_time"], 0.05, delta=self.report()["dt"])

    def test_a_shorter_run_leaves_no_frame_of_the_longer_one(self):
        run("run", self.scene, "-o", self.out)
        (self.out / "frames" / "notes.txt").write_text("mine")
        run("run", self.scene, "-o", self.out, "--until", "0.04")
        self.assertEqual(self.frames(), ["000000.png", "000001.png", "000002.png", "notes.txt"])

    def test_interruption_leaves_complete_files(self):
        program = subprocess.Popen([PROGRAM, "run", str(self.scene), "-o", str(self.out), "--until", "1000"],
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        deadline = time.time() + 60
        while time.time() < deadline and not (self.out / "frames" / "000002.png").exists():
            time.sleep(0.02)
        program.send_signal(signal.SIGINT)
        program.communicate(timeout=60)
        self.assertEqual(program.returncode, 130)
        report = self.report()
        self.assertEqual(report["ended"], "interrupted")
        self.assertEqual(len(self.frames()), report["frames"])
        for name in self.frames():
            self.assertTrue((self.out / "frames" / name).read_bytes().endswith(b"IEND\xaeB`\x82"))

    def test_a_failing_simulation_keeps_its_frames(self):
        result = run("run", self.scene, "-o", self.out, "--set", "pairs.normal_stiffness=50", "--set", "simulation.time_step=1e-5")
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertRegex(result.stderr, r"error: Overlap of .* grain 0 at \(.*\) m, t = .* with wall 'floor'")
        report = self.report()
        self.assertEqual(report["ended"], "failed")
        self.assertGreater(report["frames"], 1)
        self.assertEqual(len(self.frames()), report["frames"])

    def test_exit_codes_of_bad_input(self):
        self.assertEqual(run("run", self.path / "absent.toml").returncode, 3)
        self.assertEqual(run().returncode, 2)
        self.assertEqual(run("run").returncode, 2)
        self.assertEqual(run("fly", self.scene).returncode, 2)
        self.assertEqual(run("run", self.scene, "--threads", "0").returncode, 2)
        bad = run("check", self.scene, "--set", "pairs.frction=0.1")
        self.assertEqual(bad.returncode, 2)
        self.assertIn("did you mean 'friction'?", bad.stderr)
        (self.path / "file").write_text("")
        self.assertEqual(run("run", self.scene, "-o", self.path / "file").returncode, 3)
        self.assertEqual(run("run", self.scene, "--isa", "mmx").returncode, 2)

    def test_check_explain_reference_help_version(self):
        self.assertIn("fine", run("check", self.scene).stdout)
        explained = run("explain", self.scene)
        self.assertEqual(explained.returncode, 0)
        for word in ("linear", "spring", "bytes", "time step", "grain"):
            self.assertIn(word, explained.stdout.lower())
        self.assertIn("normal_stiffness", run("reference").stdout)
        self.assertEqual(run("--help").returncode, 0)
        self.assertRegex(run("--version").stdout, r"^tsubu \d+\.\d+\.\d+")


    @unittest.skipIf(os.environ.get("SANITIZED"), "sanitizers take memory of their own")
    def test_memory_is_what_grains_and_contacts_need(self):
        # Beyond what a small scene takes, at the fullest moment, neighbour lists made anew among others: docs/performance.md, "Memory".
        def peak(edge, friction):
            lattice = ('source = "lattice"\nlattice = "fcc"\nvelocity_spread = 0.5\nradius = 0.02\n'
                       f"box = {{ min = [0, 0, 0.001], max = [{edge}, {edge}, {edge + 0.001}] }}\n" + ("" if friction else '[contact]\ntangential = "none"\n'))
            self.scene.write_text(SCENE.replace('source = "list"\nradius = 0.02\npositions = [[0, 0, 0.06], [0.1, 0, 0.1]]\n', lattice))
            process = subprocess.Popen([PROGRAM, "run", self.scene, "-o", self.out, "--no-frames", "--threads", "1", "--until", "0.004", "--set",
                                        "simulation.ledger=false", "--set", "simulation.integrator=symplectic_euler"],
                                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            _, status, usage = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
            self.assertEqual(process.returncode, 0)
            return 1024 * usage.ru_maxrss, self.report()["grains"]

        # Each grain has 12 neighbours that are listed, and touches half of them. Rows of grains; lists, and springs along them; what is
        # remembered of contacts while the lists are made anew; a quarter for the grid and for what lies between arrays below 4 MB, which
        # are used again and not given back.
        for friction, bytes_needed in ((True, 254 + 6 * (20 + 24) + 3 * 36), (False, 190 + 6 * 20)):
            (few, some), (full, many) = peak(0.1, friction), peak(1.7, friction)
            self.assertGreater(many, 90_000)
            self.assertLess((full - few) / (many - some), 1.25 * bytes_needed, f"bytes a grain, friction: {friction}")

    STUDIED = SCENE + """
[observe]
height = { kind = "centre_of_mass" }
"""

    def test_run_writes_what_the_scene_observes(self):
        self.scene.write_text(self.STUDIED)
        run("run", self.scene, "-o", self.out, "--no-frames")
        height = self.report()["observables"]["height"]
        self.assertEqual(height["unit"], "m")
        self.assertTrue(0.02 < height["value"] < 0.08)

    def test_tradeoff_writes_its_files_and_runs_nothing_twice(self):
        self.scene.write_text(self.STUDIED)
        command = ("tradeoff", self.scene, "-o", self.out, "--axes", "step,stiffness", "--budget", "60s")
        first = run(*command)
        self.assertEqual(first.returncode, 0, first.stderr)
        self.assertIn("height = ", first.stdout)
        study = json.loads((self.out / "tradeoff.json").read_text())
        self.assertTrue(study["complete"])
        self.assertGreater(len(study["points"]), 5)
        with open(self.out / "tradeoff.csv", newline="") as file:
            self.assertIn("stiffness", {row["axis"] for row in csv.DictReader(file)})
        self.assertIn(" 0 trials run", run(*command).stdout)
        without = dict(os.environ, PATH="")
        result = subprocess.run([PROGRAM, *map(str, command)], capture_output=True, text=True, timeout=120, env=without)
        self.assertEqual(result.returncode, 0)
        self.assertIn("gnuplot is not installed", result.stderr)

    def test_accuracy_takes_the_cheapest_setting_that_is_within(self):
        self.scene.write_text(self.STUDIED)
        missing = run("run", self.scene, "-o", self.out, "--accuracy", "2%")
        self.assertEqual(missing.returncode, 3)
        self.assertIn("make one: tsubu tradeoff", missing.stderr)
        folder = self.path / "study"
        run("tradeoff", self.scene, "-o", folder, "--axes", "step,stiffness", "--budget", "60s")
        points = [p for p in json.loads((folder / "tradeoff.json").read_text())["points"] if p["errors"]]
        bounds = sorted(p["bound"] for p in points)
        accuracy = bounds[len(bounds) // 2] * 1.0001
        cheapest = min((p for p in points if p["bound"] <= accuracy), key=lambda p: p["cost_cpu_seconds"])
        chosen = run("run", self.scene, "-o", self.out, "--no-frames", "--study", folder, "--accuracy", accuracy)
        self.assertEqual(chosen.returncode, 0, chosen.stderr)
        self.assertEqual(self.report()["setting"]["overrides"], cheapest["overrides"])
        none = run("run", self.scene, "-o", self.out, "--study", folder, "--accuracy", bounds[0] * 0.5)
        self.assertEqual(none.returncode, 2)
        self.assertIn("No setting of the study is within", none.stderr)
        other = run("run", self.scene, "-o", self.out, "--study", folder, "--quality", "draft", "--set", "pairs.restitution=0.5")
        self.assertIn("another scene", other.stderr)
        explained = run("explain", self.scene, "--study", folder, "--quality", "reference").stdout
        for word in ("draft", "standard", "reference", "setting "):
            self.assertIn(word, explained)
        self.assertEqual(run("run", self.scene, "--accuracy", "none").returncode, 2)

    def test_stability_of_a_ball_on_the_floor(self):
        self.scene.write_text(SCENE.replace("restitution = 0.8", "restitution = 0.3"))
        result = run("stability", self.scene, "--set", "simulation.end=1", "--set", "grains.balls.positions=[[0, 0, 0.0199]]")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("spectral", result.stdout)
        self.assertIn("1 grain, 1 contact\n", result.stdout)
        self.assertEqual(run("stability", self.scene, "--at", "0").returncode, 2)

    def test_tradeoff_of_features(self):
        result = run("tradeoff", self.scene, "-o", self.out, "--features", "--budget", "60s")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("without friction", result.stdout)
        self.assertIn("the scene does not model it", result.stdout)
        # Two balls that only fall and bounce do not know friction; and explain says so.
        self.assertRegex(run("explain", self.scene, "--study", self.out).stdout, r"without friction +makes no difference")

    def test_tradeoff_goes_on_after_ctrl_c(self):
        self.scene.write_text(self.STUDIED)
        command = ["tradeoff", str(self.scene), "-o", str(self.out), "--axes", "step", "--until", "2", "--budget", "60s", "--threads", "1"]
        program = subprocess.Popen([PROGRAM, *command], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        program.stderr.readline()
        program.send_signal(signal.SIGINT)
        program.communicate(timeout=60)
        self.assertEqual(program.returncode, 130)
        study = json.loads((self.out / "tradeoff.json").read_text())
        self.assertFalse(study["complete"])
        kept = len(list((self.out / "trials").glob("*.json")))
        self.assertGreater(kept, 0)
        result = run(*command)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn(f" {kept} known", result.stdout)

    def test_tradeoff_refuses_what_it_does_not_know(self):
        self.assertIn("did you mean 'step'?", run("tradeoff", self.scene, "-o", self.out, "--axes", "stop").stderr)
        self.assertEqual(run("tradeoff", self.scene, "-o", self.out, "--budget", "soon").returncode, 2)


if __name__ == "__main__":
    PROGRAM = os.path.abspath(sys.argv.pop(1))
    unittest.main()
