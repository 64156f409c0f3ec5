"""The scripts of bench/peers, with a few grains and steps. Usage: peers_test.py TSUBU"""
import collections
import csv
import math
import os
import pathlib
import struct
import subprocess
import sys
import tempfile
import unittest

PEERS = pathlib.Path(__file__).resolve().parents[2] / "bench" / "peers"
sys.path.insert(0, str(PEERS))
import bed  # noqa: E402
import grains  # noqa: E402

PROGRAM = ""


class Hopper(unittest.TestCase):
    def test_mesh_has_two_rims_and_no_other_gap(self):
        triangles = grains.cone_and_cylinder()
        self.assertGreaterEqual(len(triangles), 2000)
        edges = collections.Counter(frozenset((t[k], t[(k + 1) % 3])) for t in triangles for k in range(3))
        self.assertEqual(collections.Counter(edges.values()), {2: len(edges) - 2 * grains.AROUND, 1: 2 * grains.AROUND})
        rims = {round(corner[2], 9) for edge, count in edges.items() if count == 1 for corner in edge}
        self.assertEqual(rims, {0.0, round(grains.CONE + grains.TALL, 9)})

    def test_mesh_has_the_area_of_cone_and_cylinder(self):
        def area(a, b, c):
            u, v = ([p - q for p, q in zip(end, a)] for end in (b, c))
            return 0.5 * math.dist((0, 0, 0), (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]))

        body, outlet, cone, tall = grains.BODY, grains.OUTLET, grains.CONE, grains.TALL
        exact = math.pi * ((outlet + body) * math.hypot(cone, body - outlet) + 2 * body * tall)
        self.assertAlmostEqual(sum(area(*t) for t in grains.cone_and_cylinder()) / exact, 1, delta=0.005)

    def test_text_and_binary_stl_are_read(self):
        triangles = [((0.0, 0.0, 0.0), (1.0, 0.0, 0.5), (0.0, 2.0, 0.25)), ((1.0, 1.0, 1.0), (2.0, 1.0, 1.0), (1.0, 2.0, 1.0))]
        with tempfile.TemporaryDirectory() as folder:
            text, binary = pathlib.Path(folder, "text.stl"), pathlib.Path(folder, "binary.stl")
            grains.write_stl(text, triangles)
            binary.write_bytes(b"solid, says the header, and is not".ljust(80) + struct.pack("<I", 2) +
                               b"".join(struct.pack("<12fH", 0, 0, 0, *sum(t, ()), 0) for t in triangles))
            self.assertEqual(grains.read_stl(text), triangles)
            self.assertEqual(grains.read_stl(binary), triangles)


class Run(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        places = [(0.0022 * i + 0.002, 0.0022 * j + 0.002, 0.0009 + 0.0021 * k) for i in range(3) for j in range(3) for k in range(2)]
        bed.write_csv(self.folder / "bed.csv", [bed.Grain(0.001, place, (0.0,) * 3, (0.0,) * 3) for place in places])

    def run_peers(self, *options):
        command = [sys.executable, "-B", str(PEERS / "run"), "--tsubu", PROGRAM, "-o", str(self.folder / "out"), "--bed", str(self.folder / "bed.csv"),
                   "--runs", "2", "--steps", "20", "--tiles", "2", *options]
        # Without the other codes, which need not be there.
        return subprocess.run(command, capture_output=True, text=True, timeout=250, env=dict(os.environ, PATH=""))

    def rows(self, name):
        with open(next((self.folder / "out").glob(f"{name}_*.csv")), newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def test_help(self):
        for script in ("run", "laws.py"):
            done = subprocess.run([sys.executable, "-B", str(PEERS / script), "--help"], capture_output=True, text=True, timeout=60)
            self.assertEqual(done.returncode, 0, done.stderr)

    def test_the_bed(self):
        done = self.run_peers("--cores", "1,2")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        runs = self.rows("runs")
        self.assertEqual([(row["cores"], row["run"]) for row in runs], [("1", "1"), ("1", "2"), ("2", "1"), ("2", "2")])
        self.assertEqual({(row["grains"], row["work"]) for row in runs}, {("72", "bed linear 2x2")})
        self.assertEqual(len({row["state_hash"] for row in runs}), 1)
        self.assertEqual([row["against"] for row in self.rows("table")], ["1 core"])

    def test_cases_of_one_code(self):
        for case in ("frictionless", "growth", "memory", "frames", "mixed"):
            done = self.run_peers("--case", case)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        cases = [row["case"] for row in self.rows("table")]
        self.assertIn("bed, friction left out", cases)
        contact = {row["case"]: float(row["value"]) for row in self.rows("table") if "contact" in row["case"]}
        self.assertEqual(contact, {"memory of a contact with friction (explain)": 24, "memory of a contact without friction (explain)": 0})


if __name__ == "__main__":
    PROGRAM = os.path.abspath(sys.argv.pop(1))
    unittest.main()
