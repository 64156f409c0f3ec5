"""The scripts of bench/peers, with a few grains and steps. Usage: peers_test.py TSUBU"""
import collections
import contextlib
import csv
import io
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
import codes  # noqa: E402
import grains  # noqa: E402
import table  # noqa: E402

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


    def test_room_is_the_largest_upright_cylinder(self):
        # A funnel that opens at 45 degrees from 1 to 5 over the lower half, and a lid half-way up its body: r² times the height that is
        # left is largest for all of the body below the lid.
        def ring(radius, z):
            return [(radius * math.cos(k * math.pi / 50), radius * math.sin(k * math.pi / 50), z) for k in range(100)]

        def between(a, b):
            return [t for k in range(100) for t in ((a[k], a[(k + 1) % 100], b[k]), (b[k], a[(k + 1) % 100], b[(k + 1) % 100]))]

        funnel = between(ring(1, 0), ring(5, 4)) + between(ring(5, 4), ring(5, 8))
        low, high, radius = grains.room_in(funnel, [0, 0], 0, 8)
        self.assertEqual((low, high), (4, 8))
        self.assertAlmostEqual(radius, 5 * math.cos(math.pi / 100), places=9)
        lid = [((0, 0, 6.1), a, b) for a, b in zip(ring(5, 6.1), ring(5, 6.1)[1:] + ring(5, 6.1)[:1])]
        low, high, radius = grains.room_in(funnel + lid, [0, 0], 0, 8)
        self.assertAlmostEqual(high, 6)
        self.assertAlmostEqual(radius, (1 + low) * math.cos(math.pi / 100), places=6)
        # Without end faces, sides seen from above are lines: the axis is inside of none.
        self.assertEqual(grains.from_axis([(1, 1, 0), (2, 1, 0), (2, 2, 0)]), math.sqrt(2))
        self.assertEqual(grains.from_axis([(-1, -1, 0), (2, -1, 0), (0, 2, 0)]), 0)

    def test_meshes_that_hold_nothing_are_refused(self):
        column = [((1.0, 0.0, z), (0.0, 1.0, z), (-1.0, -1.0, z + 0.2)) for z in (0.0, 2.0)]
        with self.assertRaisesRegex(bed.Unusable, "gap"):
            grains.room_in(column, [0, 0], 0, 2.2)
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "no.stl")
            path.write_text("solid nothing")
            with self.assertRaisesRegex(bed.Unusable, "no triangles"):
                grains.read_stl(path)


class Beds(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def file(self, name, text):
        (self.folder / name).write_text(text, encoding="utf-8")
        return self.folder / name

    def test_tables_as_people_write_them(self):
        path = self.file("bed.csv", "\ufeff# settled\n\nradius, z, y, x, colour\n0.001, 3, 2, 1, red\n 0.002,6,5,4,blue\n")
        still = (0.0, 0.0, 0.0)
        self.assertEqual(bed.read(path), [bed.Grain(0.001, (1, 2, 3), still, still), bed.Grain(0.002, (4, 5, 6), still, still)])

    def test_data_files_come_back(self):
        some = [bed.Grain(0.001 * 1.07**k, (0.01 * k, 0.1 / 3, 1e-7), (k, -k, 0.5), (0.25, k, 0.0)) for k in range(5)]
        for sphere_style in (True, False):
            path = self.folder / "bed.data"
            bed.write_data(path, some, "Grains, a few", sphere_style, [(0, 1)] * 3)
            for one, other in zip(bed.read(path), some):
                self.assertAlmostEqual(one.radius, other.radius, places=15)
                self.assertEqual((one.position, one.velocity, one.spin), (other.position, other.velocity, other.spin))
        # As write_data of LAMMPS has it: comments, other sections, densities with a rounding in their last digit.
        text = path.read_text().replace("Atoms\n", "Pair Coeffs # gran\n\n1\n\nAtoms # sphere\n").replace(" 2500.0 ", " 2500.0000000000005 ")
        self.assertEqual(len(bed.read(self.file("more.data", text))), 5)

    def test_what_cannot_be_read_is_told(self):
        head = "a bed\n\n1 atoms\n\n"
        for name, text, words in [("a.csv", "x,y,z\n1,2,3\n", "no column radius"), ("b.csv", "x,y,z,radius\n1,2,3,4\n1,2,three,4\n", "Grain 2 "),
                                  ("c.data", head + "Atoms # atomic\n\n1 1 2 3 4\n", "style atomic"), ("d.data", head, "no grains"),
                                  ("e.data", head + "Atoms\n\n1 1 0.002 1000 0 0 0\n", "density 1000"),
                                  ("f.data", head + "Atoms\n\n1 1 0.002 2500\n", "fewer numbers")]:
            with self.subTest(name), self.assertRaisesRegex(bed.Unusable, words):
                bed.read(self.file(name, text))
        with self.assertRaisesRegex(bed.Unusable, "cannot be read"):
            bed.read(self.folder / "absent.csv")

    def test_the_box_fits_the_bed(self):
        def at(*position):
            return bed.Grain(0.001, position, (0.0,) * 3, (0.0,) * 3)

        usual = [at(0.01, 0.02, 0.001), at(0.08, 0.02, 0.001)]
        self.assertEqual(bed.in_box(usual, None), (usual, (bed.SIDE, bed.SIDE)))
        moved, sides = bed.in_box([at(-0.5, 1.0, 2.0), at(-0.4, 1.0, 2.25)], None)
        for number, exact in zip((*moved[1].position, *sides), (0.101, 0.001, 0.251, 0.102, 0.002)):
            self.assertAlmostEqual(number, exact)
        with self.assertRaisesRegex(bed.Unusable, "Grain 2 at .* outside the box"):
            bed.in_box(usual, 0.05)

    def test_other_sizes_have_springs_and_steps_that_fit_them(self):
        def numbers(radius, law):
            some = [bed.Grain(radius, (0.0,) * 3, (0.0,) * 3, (0.0,) * 3)]
            work, mass = bed.Work("bed", 1, law).fitted(some), radius**3
            return (mass / (work.springs.normal * radius), work.time_step * math.sqrt(work.springs.normal / mass), work.time_step *
                    work.springs.normal_damping, work.springs.tangential / work.springs.normal) if law == "linear" else (work.time_step / radius,)

        self.assertEqual(bed.Work("bed", 1).fitted([bed.Grain(bed.RADIUS, (), (), ())]), bed.Work("bed", 1))
        for law in ("linear", "hertz"):
            for radius in (4e-3, 2.5e-4):
                for own, usual in zip(numbers(radius, law), numbers(1e-3, law)):
                    self.assertAlmostEqual(own / usual, 1, delta=0.02)
        # The smallest sets the step: half the radius beside many that are usual, √8 times shorter.
        mixed = bed.Work("bed", 1).fitted([bed.Grain(r, (), (), ()) for r in (1e-3, 1e-3, 5e-4)])
        self.assertEqual((mixed.springs, mixed.time_step), (bed.Springs(), bed.rounded(bed.TIME_STEP / math.sqrt(8))))


class Verdict(unittest.TestCase):
    def wrong(self, *peers, hashes=("a", "a"), tolerance=1e-3):
        def series(name, energies, hashes=("",)):
            code = type("Code", (), {"name": name})
            return table.Series(code, bed.Work("bed", 2000), 1, 1, self, {}, [codes.Measurement(1.0, energies, state_hash=one) for one in hashes])

        with contextlib.redirect_stdout(io.StringIO()):
            return table.check([series("tsubu", {0: 1.0, 500: 2.0, 2000: 4.0}, hashes)] + [series(f"peer {k}", told) for k, told in enumerate(peers)],
                               table.Tolerances({"peer 0": tolerance, "peer 1": tolerance}))

    def test_each_peer_is_a_witness_before_chaos(self):
        self.assertEqual(self.wrong({0: 1.0, 500: 2.001, 2000: 5.0}, {500: 1.999}), [])
        self.assertEqual(len(self.wrong({0: 1.0, 500: 2.003}, {500: 2.0})), 1)
        self.assertEqual(self.wrong({0: 1.0, 500: 2.003}, tolerance=2e-3), [])

    def test_nothing_compared_is_no_agreement(self):
        self.assertIn("nothing was compared", self.wrong({0: 1.0, 300: 2.0})[0])
        self.assertIn("nothing was compared", self.wrong({0: 1.0, 2000: 4.0})[0])
        self.assertIn("+nan%", self.wrong({0: 1.0, 500: math.nan})[0])

    def test_other_bits_are_told(self):
        self.assertIn("different bits, a, b", self.wrong(hashes=("a", "b"))[0])

    def test_what_peers_print(self):
        told = codes.told("Step Atoms KinEng\n  0 30 5.0e-07\n  500 30 nan\nLoop time of 3.5 on 1 procs\n")
        self.assertEqual((told.seconds, told.energies[0], math.isnan(told.energies[500])), (3.5, 5e-7, True))
        with self.assertRaisesRegex(codes.Failed, "no time"):
            codes.told("Segmentation fault")


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
        # With no other codes than those that a test puts there.
        path = f"{self.folder / 'bin'}:/usr/bin:/bin" if (self.folder / "bin").is_dir() else ""
        return subprocess.run(command, capture_output=True, text=True, timeout=600, env=dict(os.environ, PATH=path))

    def program(self, name, text):
        path = self.folder / "bin" / name
        path.parent.mkdir(exist_ok=True)
        path.write_text("#!/bin/sh\n" + text)
        path.chmod(0o755)

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

    def test_a_peer_that_fails_or_disagrees_is_told_and_stops_nothing(self):
        self.program("lmp", "echo '0 72 0'; echo '20 72 123'; echo Loop time of 0.5\n")
        # Fails when it is measured, after its skins have been tried.
        self.program("liggghts", 'test "$1" = -log && exit 0\necho >> ran\ntest $(wc -l < ran) -le 4 || { echo lost elements; exit 3; }\n'
                                 "echo '0 72 0'; echo Loop time of 0.5\n")
        self.program("yade", "exit 1\n")
        done = self.run_peers("--cores", "1")
        self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
        self.assertIn("Yade is left out", done.stdout)
        self.assertRegex(done.stdout, r"WRONG: bed linear 2x2, LIGGGHTS, 1 core: left out(.|\n)*lost elements")
        self.assertIn("WRONG: bed linear 2x2, tsubu: the kinetic energy is -100.000% from that of LAMMPS after 20 steps.", done.stdout)
        self.assertEqual([row["against"] for row in self.rows("table")], ["LAMMPS"])
        self.program("liggghts", 'test "$1" = -log || { echo bad mesh; exit 3; }\n')
        self.assertRegex(self.run_peers("--law", "hertz", "--cores", "1").stdout, r"WRONG: bed hertz 2x2, LIGGGHTS: left out(.|\n)*bad mesh")

    def test_a_bed_that_cannot_be_read_is_told(self):
        (self.folder / "bed.csv").write_text("x,y,z\n")
        done = self.run_peers()
        self.assertEqual(done.returncode, 1)
        self.assertIn("has no column radius", done.stdout)
        self.assertNotIn("Traceback", done.stdout + done.stderr)

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
