#!/usr/bin/env python3
"""The layer check must be able to fail: each made-up tree breaks one rule and must be named for it."""
import tempfile
import unittest
from pathlib import Path

import check_layers

CLEAN = {
    "src/core/vec.h": "// Vectors.\n\n#pragma once\n#include <Eigen/Core>\n",
    "src/sim/grid.h": '#pragma once\n#include <vector>\n\n#include "core/vec.h"\n',
    "src/sim/grid.cpp": '#include "sim/grid.h"\n\n#include <hwy/highway.h>\n',
    "src/render/context.cpp": "#include <GL/osmesa.h>\n",
    "src/io/png_file.cpp": '#include <png.h>\n// printf("%d") in a comment, and a word in a text:\nconst char* text = "exit(1)";\n',
    "src/scene/reader.h": '#pragma once\n#include "io/document.h"\n#include "render/scene.h"\n#include "sim/grid.h"\n',
    "src/io/document.h": "#pragma once\n#include <toml++/toml.h>\n",
    "src/render/scene.h": "#pragma once\n",
    "src/app/main.cpp": '#include <CLI/CLI.hpp>\n#include <nlohmann/json.hpp>\n\n#include "scene/reader.h"\nint main() { std::exit(0); }\n',
}


def complaints(changes):
    """What the check says about the clean tree with some files changed or added."""
    with tempfile.TemporaryDirectory() as root:
        for name, text in {**CLEAN, **changes}.items():
            path = Path(root) / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
        return list(check_layers.violations(root))


class LayerCheck(unittest.TestCase):
    def assert_refused(self, name, text, words):
        found = complaints({name: text})
        self.assertEqual(len(found), 1, found)
        self.assertTrue(found[0].startswith(name + ":"), found[0])
        self.assertIn(words, found[0])

    def test_a_clean_tree_passes(self):
        self.assertEqual(complaints({}), [])

    def test_an_empty_tree_does_not_pass(self):
        with tempfile.TemporaryDirectory() as root:
            self.assertEqual(len(list(check_layers.violations(root))), 1)

    def test_modules_include_only_what_is_below(self):
        for upper, lower in [("sim/grid.h", "core"), ("render/scene.h", "core"), ("scene/reader.h", "sim"), ("sim/grid.h", "render"),
                             ("render/scene.h", "sim"), ("io/document.h", "sim"), ("sim/grid.h", "io"), ("scene/reader.h", "io")]:
            with self.subTest(upper=upper, lower=lower):
                self.assert_refused(f"src/{lower}/new.cpp", f'#include "{upper}"\n', f"{lower} must not include")

    def test_nobody_includes_the_application(self):
        found = complaints({"src/app/options.h": "#pragma once\n", "src/scene/new.cpp": '#include "app/options.h"\n'})
        self.assertEqual(len(found), 1, found)

    def test_third_party_headers_stay_at_home(self):
        for header, module in [("GL/osmesa.h", "scene"), ("assimp/scene.h", "sim"), ("png.h", "render"), ("toml++/toml.h", "scene"),
                               ("CLI/CLI.hpp", "scene"), ("nlohmann/json.hpp", "io"), ("hwy/highway.h", "core")]:
            with self.subTest(header=header):
                self.assert_refused(f"src/{module}/new.cpp", f"#include <{header}>\n", "has its home in")

    def test_a_library_without_a_home_is_refused(self):
        self.assert_refused("src/io/new.cpp", "#include <boost/optional.hpp>\n", "has no home")

    def test_an_include_must_lead_somewhere(self):
        self.assert_refused("src/sim/new.cpp", '#include "sim/gird.h"\n', "there is no src/sim/gird.h")

    def test_an_include_names_its_module(self):
        self.assert_refused("src/sim/new.cpp", '#include "grid.h"\n', "is not written as")

    def test_indented_directives_count(self):
        self.assert_refused("src/core/new.cpp", '  #  include "sim/grid.h"\n', "must not include")

    def test_headers_have_a_guard(self):
        self.assert_refused("src/sim/new.h", "#include <vector>\n", "#pragma once")

    def test_the_own_header_comes_first(self):
        self.assert_refused("src/sim/grid.cpp", '#include <vector>\n#include "sim/grid.h"\n', "first")

    def test_libraries_are_silent(self):
        for line in ["std::cout << 1;", 'fmt::print("x");', "std::exit(1);", 'printf("x");', "abort();"]:
            with self.subTest(line=line):
                self.assert_refused("src/sim/new.cpp", f"void f() {{ {line} }}\n", "neither print nor exit")

    def test_unknown_modules_are_refused(self):
        self.assert_refused("src/utils/new.cpp", "", "is not a module")

    def test_a_file_that_is_named_is_there(self):
        self.assert_refused("docs/new.md", "See `src/sim/gird.h`.\n", "there is no src/sim/gird.h")
        self.assertEqual(complaints({"docs/new.md": "See `src/sim/grid.h`. build/src/sim/gird.h and src/sim/ are something else.\n"}), [])

    def test_paths_of_one_machine_are_refused(self):
        for name in ["scenes/new.toml", "scripts/new", "docs/new.md", "README.md"]:
            with self.subTest(name=name):
                self.assert_refused(name, 'mesh = "/' + 'tmp/x.stl"\n', "of one machine")


if __name__ == "__main__":
    unittest.main()
