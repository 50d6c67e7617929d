# SPDX-License-Identifier: MIT
"""The C++ examples against the installed package: they are configured, built and run by a project of their own, as a user would."""

import glob
import os
import re
import shutil
import subprocess
import tempfile
import unittest

from harness import SOURCE, STAGED, text

EXAMPLES = os.path.join(SOURCE, "examples/cpp")
HEADERS = os.path.join(STAGED, "usr/include/wholehand/cpp")


def run(*command, **options):
    done = subprocess.run(command, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, **options)
    return done.returncode, done.stdout


def named_headers():
    """Rows of the table in docs/library.md: header and example."""
    return re.findall(r"^\| `((?:base|core|sweeps)/[\w/]+\.h)` \|.*\| \[\w+\.cpp\]\(\.\./examples/cpp/(\w+\.cpp)\) \|$",
                      text(os.path.join(SOURCE, "docs/library.md")), re.MULTILINE)


class Cpp(unittest.TestCase):
    def test_every_named_header_is_installed_and_has_an_example(self):
        self.assertGreaterEqual(len(named_headers()), 8)
        for header, example in named_headers():
            self.assertTrue(os.path.exists(os.path.join(HEADERS, header)), header)
            self.assertIn(f'#include "{header}"', text(os.path.join(EXAMPLES, example)))
        programs = [name for name in os.listdir(EXAMPLES) if name.endswith(".cpp")]
        self.assertEqual(sorted(example for _, example in named_headers()), sorted(programs))

    def test_installed_headers_find_what_they_include(self):
        for folder, _, names in os.walk(HEADERS):
            for name in names:
                for included in re.findall(r'^#include "([^"]+)"', text(os.path.join(folder, name)), re.MULTILINE):
                    self.assertTrue(os.path.exists(os.path.join(HEADERS, included)), f"{folder}/{name} includes {included}")

    def test_installed_headers_compile_with_the_packages_that_are_recommended(self):
        (deb,) = glob.glob(STAGED + ".debs/libwholehand-dev*.deb")
        recommended = set(run("dpkg-deb", "-f", deb, "Recommends")[1].strip().split(", "))
        headers = sorted(glob.glob("**/*.h", root_dir=HEADERS, recursive=True))
        self.assertGreater(len(headers), 100)
        all_of_them = "".join(f'#include "{header}"\n' for header in headers)
        code, output = run("c++", "-std=c++20", "-M", "-I", HEADERS, "-x", "c++", "-", input=all_of_them)
        self.assertEqual(code, 0, output)
        # folders of /usr/include, but those of the compiler, which -dev packages of others have made
        used = {path for path in output.split() if path.startswith("/usr/include/") and not path.startswith("/usr/include/c++/")}
        owners = set(re.findall(r"^([\w.+-]+)(?::\w+)?: ", run("dpkg", "-S", *used)[1], re.MULTILINE))
        needed = owners - {"libc6-dev", "linux-libc-dev", "libstdc++-12-dev"}
        self.assertGreater(len(needed), 3)
        self.assertLessEqual(needed, recommended)

    def test_examples_build_and_run(self):
        with tempfile.TemporaryDirectory() as build:
            # these programs are in no prefix, and wholehand-common is not in /usr here: the scenes lie beside them
            shutil.copytree(f"{STAGED}/usr/share/wholehand", build + "/share/wholehand")
            for command in (["cmake", "-G", "Ninja", "-S", EXAMPLES, "-B", build, f"-DCMAKE_PREFIX_PATH={STAGED}/usr"],
                            ["cmake", "--build", build], ["ctest", "--test-dir", build, "--output-on-failure"]):
                code, output = run(*command)
                self.assertEqual(code, 0, output)
            self.assertIn(f"100% tests passed, 0 tests failed out of {len(named_headers())}", output)

    def test_a_project_in_c_alone_finds_the_library(self):
        with tempfile.TemporaryDirectory() as folder:
            with open(os.path.join(folder, "CMakeLists.txt"), "w") as file:
                file.write("cmake_minimum_required(VERSION 3.25)\nproject(p LANGUAGES C)\nfind_package(wholehand REQUIRED)\n"
                           "add_executable(mine mine.c)\ntarget_link_libraries(mine PRIVATE wholehand::wholehand)\n")
            with open(os.path.join(folder, "mine.c"), "w") as file:
                file.write("#include <stdio.h>\n#include <wholehand/wholehand.h>\n"
                           "int main(void) { return puts(wh_version()) < 0; }\n")
            for command in (["cmake", "-G", "Ninja", "-S", folder, "-B", folder + "/build", f"-DCMAKE_PREFIX_PATH={STAGED}/usr"],
                            ["cmake", "--build", folder + "/build"]):
                code, output = run(*command)
                self.assertEqual(code, 0, output)
            version = re.search(r"^project\(wholehand VERSION (\S+)", text(os.path.join(SOURCE, "CMakeLists.txt")), re.MULTILINE)[1]
            self.assertEqual(run(folder + "/build/mine"), (0, version + "\n"))

    def test_a_wrong_component_is_refused(self):
        with tempfile.TemporaryDirectory() as folder:
            with open(os.path.join(folder, "CMakeLists.txt"), "w") as file:
                file.write("cmake_minimum_required(VERSION 3.25)\nproject(p LANGUAGES CXX)\n"
                           "find_package(wholehand REQUIRED COMPONENTS nonsense)\n")
            code, output = run("cmake", "-S", folder, "-B", folder + "/build", f"-DCMAKE_PREFIX_PATH={STAGED}/usr")
            self.assertNotEqual(code, 0)
            self.assertIn("wholehand has no component nonsense; allowed: cpp", " ".join(output.split()))

    def test_pkg_config_finds_the_c_library_where_it_is(self):
        (path,) = (os.path.join(folder) for folder, _, names in os.walk(STAGED) if "wholehand.pc" in names)
        environment = dict(os.environ, PKG_CONFIG_PATH=path)
        found = {}
        for what in ("--variable=includedir", "--variable=libdir"):
            code, output = run("pkg-config", what, "wholehand", env=environment)
            self.assertEqual(code, 0, output)
            found[what] = output.strip()
        self.assertTrue(os.path.exists(os.path.join(found["--variable=includedir"], "wholehand/wholehand.h")), found)
        self.assertTrue(os.path.exists(os.path.join(found["--variable=libdir"], "libwholehand.so")), found)


if __name__ == "__main__":
    unittest.main()
