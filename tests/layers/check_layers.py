#!/usr/bin/env python3
"""Proves the architecture from the text of the sources: python3 check_layers.py ROOT

Prints one line for each violation and exits with 1 when there is any. What is checked:
  * modules include only modules below them:  core <- sim, render, io <- scene <- study <- app;  sim, render and io do not know each other
  * every third-party header is used in its one home, and one without a home is refused
  * headers begin with #pragma once, an implementation includes its own header first, and no include leads nowhere
  * libraries neither print nor exit: only the application does
  * no file of the project names a directory of somebody's machine, and a file that is named (docs/physics.md) is there
"""
import re
import sys
from pathlib import Path

MAY_INCLUDE = {
    "core": {"core"},
    "sim": {"sim", "core"},
    "render": {"render", "core"},
    "io": {"io", "core"},
    "scene": {"scene", "sim", "render", "io", "core"},
    "study": {"study", "scene", "sim", "render", "io", "core"},
    "app": {"app", "study", "scene", "sim", "render", "io", "core"},
}

# Beginning of the header's path -> modules that may include it. Headers of the C++ library have neither '/' nor '.'.
EVERYWHERE = set(MAY_INCLUDE)
HOMES = {
    "Eigen/": EVERYWHERE,
    "fmt/": EVERYWHERE,
    "GL/": {"render"},
    "assimp/": {"io"},
    "png.h": {"io"},
    "toml++/": {"io"},
    "toml.hpp": {"io"},
    "CLI/": {"app"},
    "nlohmann/": {"app", "study"},
    "immintrin.h": {"sim"},
    "hwy/": {"sim"},
    "zlib.h": {"io"},
    "malloc.h": {"app"},
    "unistd.h": {"app", "io"},
    "sys/ioctl.h": {"app"},
    "sys/mman.h": {"app"},
    "sys/wait.h": {"app"},
    "spawn.h": {"app"},
    "fcntl.h": {"app"},
}

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')
CODE_NOISE = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])+\'', re.S)
PRINTS_OR_EXITS = re.compile(
    r"\b(?:std::(?:cout|cerr|clog|exit|quick_exit|abort|terminate|puts)|fmt::print|(?:f|std::)?printf|exit|abort)\b(?=\s*(?:\(|<<|;))")
NAMED_FILE = re.compile(r"(?<![\w./}$-])(?:src|tests|docs|scripts|scenes|assets|bench|cmake)/[\w./-]*\w\.[a-z]\w*")
MACHINE_PATH = re.compile(r"(?<![\w.$}])/(?:work|tmp|home|root)/")

SOURCE_SUFFIXES = {".h", ".cpp"}
TEXT_SUFFIXES = SOURCE_SUFFIXES | {".py", ".cmake", ".txt", ".md", ".toml", ".json", ".csv", ".sh", ".yml", ".glsl", ""}
TEXT_PLACES = ("src", "tests", "bench", "cmake", "scripts", "docs", "scenes", "assets", ".ci")


def included(path):
    """(line number, is quoted, header) of every #include of a file."""
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        found = INCLUDE.match(line)
        if found:
            yield number, found[1] == '"', found[2]


def first_code_line(text):
    for line in text.splitlines():
        if line.strip() and not line.lstrip().startswith("//"):
            return line.strip()
    return ""


def check_own_include(module, header, src):
    target = header.split("/")[0]
    if target not in MAY_INCLUDE:
        return f'"{header}" is not written as "module/file.h"'
    if target not in MAY_INCLUDE[module]:
        return f"{module} must not include {target} ({header})"
    if not (src / header).is_file() and not (src / (header + ".in")).is_file():  # .in: made by CMake
        return f"there is no src/{header}"
    return None


def check_foreign_include(module, header):
    if "/" not in header and "." not in header:
        return None
    for prefix, homes in HOMES.items():
        if header.startswith(prefix):
            if module in homes:
                return None
            return f"<{header}> has its home in {', '.join(sorted(homes))}, not in {module}"
    return f"<{header}> has no home: enter it in tests/layers/check_layers.py and docs/decisions/0002-dependencies.md"


def check_source(path, src):
    """Complaints about one file of src, as (line, text)."""
    relative = path.relative_to(src)
    module = relative.parts[0]
    if module not in MAY_INCLUDE:
        yield 1, f"'{module}' is not a module"
        return
    includes = list(included(path))
    for number, quoted, header in includes:
        complaint = check_own_include(module, header, src) if quoted else check_foreign_include(module, header)
        if complaint:
            yield number, complaint
    text = path.read_text(encoding="utf-8")
    if path.suffix == ".h":
        if first_code_line(text) != "#pragma once":
            yield 1, "a header begins with #pragma once"
    elif path.with_suffix(".h").is_file():
        own = relative.with_suffix(".h").as_posix()
        if not includes or includes[0][2] != own:
            yield 1, f'include "{own}" first, which proves that it compiles alone'
    if module != "app":
        for number, line in enumerate(without_noise(text).splitlines(), 1):
            if PRINTS_OR_EXITS.search(line):
                yield number, f"libraries neither print nor exit: {line.strip()}"


def without_noise(text):
    """The text with comments and literals blanked, lines kept."""
    return CODE_NOISE.sub(lambda noise: "\n" * noise[0].count("\n"), text)


def check_text(path, root):
    for number, line in enumerate(path.read_text(encoding="utf-8", errors="replace").splitlines(), 1):
        if MACHINE_PATH.search(line):
            yield number, f"names a directory of one machine: {line.strip()}"
        if "layers" not in path.parts:  # this check and its test talk about files that are not there
            for name in NAMED_FILE.findall(line):
                if not (root / name).exists():
                    yield number, f"there is no {name}"


def files_below(place, suffixes):
    return sorted(p for p in place.rglob("*") if p.is_file() and p.suffix in suffixes and "__pycache__" not in p.parts)


def violations(root):
    """All complaints about the tree at `root`, as lines of text."""
    root = Path(root)
    src = root / "src"
    sources = files_below(src, SOURCE_SUFFIXES)
    if not sources:
        yield f"{src}: no sources found"
    for path in sources:
        for number, text in check_source(path, src):
            yield f"{path.relative_to(root)}:{number}: {text}"
    texts = [p for p in root.iterdir() if p.is_file() and p.suffix in TEXT_SUFFIXES]
    for place in TEXT_PLACES:
        texts += files_below(root / place, TEXT_SUFFIXES)
    for path in texts:
        for number, text in check_text(path, root):
            yield f"{path.relative_to(root)}:{number}: {text}"


def main(arguments):
    if len(arguments) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    found = list(violations(arguments[1]))
    print("\n".join(found) if found else "The layers hold.")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv))
