# SPDX-License-Identifier: MIT
"""The Debian packages: their contents, and that the unpacked program runs wherever it lies."""

import glob
import os
import re
import shutil
import subprocess
import tempfile
import unittest

from harness import SOURCE, STAGED, text

HAS_PYTHON = os.environ["WHOLEHAND_PYTHON"] == "ON"  # of the build


VERSION = re.search(r"^project\(wholehand VERSION (\S+)", text(SOURCE + "/CMakeLists.txt"), re.MULTILINE)[1] + "-1"
ABI = re.search(r"^#define WH_ABI (\d+)$", text(STAGED + "/usr/include/wholehand/wholehand.h"), re.MULTILINE)[1]


def output(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def debs():
    return {output("dpkg-deb", "-f", path, "Package").strip(): path for path in glob.glob(STAGED + ".debs/*.deb")}


def field(package, name):
    return output("dpkg-deb", "-f", debs()[package], name).strip()


def rows(package):
    """Mode, owner and path of everything in a package."""
    lines = output("dpkg-deb", "-c", debs()[package]).splitlines()
    return [(line.split()[0], line.split()[1], line.split(None, 5)[5].split(" -> ")[0]) for line in lines]


def elf_files():
    patterns = ("usr/bin/*", "usr/lib/*/*.so.*.*.*", "usr/lib/python3/dist-packages/*/*.so")
    return [path for pattern in patterns for path in glob.glob(f"{STAGED}/{pattern}")]


class Contents(unittest.TestCase):
    def test_packages_need_each_other_in_the_same_version(self):
        self.assertIn(f"\nversion: {VERSION[:-2]}\n", text(SOURCE + "/CITATION.cff"))
        library = "libwholehand" + ABI
        expected = {"wholehand": "wholehand-common", "wholehand-common": None, library: "wholehand-common",
                    "libwholehand-dev": library, "python3-wholehand": "wholehand-common"}
        if not HAS_PYTHON:
            del expected["python3-wholehand"]
        self.assertEqual(set(expected), set(debs()))
        for package in debs():
            self.assertEqual(field(package, "Version"), VERSION, package)
            depends = field(package, "Depends")
            if expected[package]:
                self.assertIn(f"{expected[package]} (= {VERSION})", depends, package)
            else:
                self.assertEqual(depends, "", package)
            self.assertEqual(field(package, "Architecture") == "all", package == "wholehand-common", package)
        summaries = [field(package, "Description").split("\n")[0] for package in debs()]
        self.assertEqual(len(set(summaries)), len(summaries), summaries)

    def test_programs_need_the_packages_of_their_libraries(self):
        of_both = ("libc6", "libassimp5", "libvulkan1")
        for package, names in {"wholehand": (*of_both, "libnetcdf19"), "libwholehand" + ABI: of_both}.items():
            for name in names:
                self.assertRegex(field(package, "Depends"), rf"(^|, ){re.escape(name)}\b", package)

    def test_the_library_is_known_by_its_number(self):
        (path,) = glob.glob(f"{STAGED}/usr/lib/*/libwholehand.so.{ABI}")
        self.assertIn(f"[libwholehand.so.{ABI}]", output("readelf", "-d", path))
        (name,) = glob.glob(f"{STAGED}/usr/lib/*/libwholehand.so")
        self.assertEqual(os.path.realpath(name), os.path.realpath(path))
        control = output("sh", "-c", f"dpkg-deb --ctrl-tarfile '{debs()['libwholehand' + ABI]}' | tar -xO ./shlibs ./triggers")
        depends = f"libwholehand {ABI} libwholehand{ABI} (>= {VERSION.split('-')[0]})"
        self.assertEqual(sorted(control.splitlines()), ["activate-noawait ldconfig", depends])

    def test_nothing_is_left_of_the_build_in_programs(self):
        self.assertEqual(len(elf_files()), 3 if HAS_PYTHON else 2)
        for path in elf_files():
            self.assertNotIn(" .symtab ", output("readelf", "-SW", path), path)
            self.assertNotRegex(output("readelf", "-d", path), r"\((RPATH|RUNPATH)\)", path)

    def test_no_program_or_library_names_the_folder_of_its_sources(self):
        static = glob.glob(f"{STAGED}/usr/lib/*/wholehand/*.a")
        self.assertGreaterEqual(len(static), 10)
        source = os.path.realpath(SOURCE).encode()
        for path in elf_files() + static:
            with open(path, "rb") as file:
                self.assertNotIn(source, file.read(), path)

    def test_everything_belongs_to_root_and_nobody_else_may_write(self):
        for package in debs():
            for mode, owner, path in rows(package):
                self.assertEqual(owner, "root/root", path)
                self.assertIn(mode, {"d": ["drwxr-xr-x"], "l": ["lrwxrwxrwx"]}.get(mode[0], ["-rw-r--r--", "-rwxr-xr-x"]), path)
                self.assertEqual(mode == "-rwxr-xr-x", path.startswith("./usr/bin/") and mode[0] == "-", f"{mode} {path}")

    def test_every_package_says_who_may_copy_it_and_what_is_new(self):
        for package in debs():
            files = {path for _, _, path in rows(package)}
            for name in ("copyright", "changelog.gz", "changelog.Debian.gz"):
                self.assertIn(f"./usr/share/doc/{package}/{name}", files)
            packed = f"{STAGED}/usr/share/doc/{package}/changelog.Debian.gz"
            self.assertEqual(output("dpkg-parsechangelog", "-l", packed, "-S", "Version").strip(), VERSION, package)
        licence = text(SOURCE + "/LICENSE").split("\n\n", 2)[2].split()
        self.assertGreater(len(licence), 100)
        words = [word for word in text(f"{STAGED}/usr/share/doc/wholehand/copyright").split() if word != "."]
        self.assertIn(" ".join(licence), " ".join(words))

    def test_all_shipped_scenes_are_there(self):
        for ours, theirs in (("examples/scenes", "scenes"), ("examples/extreme", "extreme")):
            staged = os.listdir(f"{STAGED}/usr/share/wholehand/{theirs}")
            self.assertEqual(sorted(os.listdir(os.path.join(SOURCE, ours))), sorted(staged))

    def test_the_program_finds_scenes_beside_itself_and_writes_where_it_is_started(self):
        with tempfile.TemporaryDirectory() as folder:
            shutil.copytree(f"{STAGED}/usr/bin", folder + "/away/bin")
            shutil.copytree(f"{STAGED}/usr/share/wholehand", folder + "/away/share/wholehand")
            shutil.copy(folder + "/away/share/wholehand/scenes/small.toml", folder + "/away/share/wholehand/scenes/one_more.toml")
            os.mkdir(folder + "/here")
            command = [folder + "/away/bin/wholehand", "sweep", "one_more", "--on", "core"]
            done = subprocess.run(command, cwd=folder + "/here", env={}, capture_output=True, text=True)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn("one_more.nc", os.listdir(folder + "/here"))
            self.assertEqual(sorted(os.listdir(folder)), ["away", "here"])

    def test_the_program_takes_no_scenes_of_a_folder_that_is_not_its_prefix(self):
        with tempfile.TemporaryDirectory() as folder:
            shutil.copytree(f"{STAGED}/usr/share/wholehand", folder + "/share/wholehand")
            scenes = folder + "/share/wholehand/scenes/"
            shutil.copy(scenes + "small.toml", scenes + "one_more.toml")
            places = {"bin": True, "lib": True, "lib/x86_64-linux-gnu": True, ".": True, "deep": False, "deep/er": False,
                      "deep/bin": False}
            for place, is_known in places.items():
                program = os.path.join(folder, place, "wholehand")
                os.makedirs(os.path.dirname(program), exist_ok=True)
                shutil.copy(f"{STAGED}/usr/bin/wholehand", program)
                command = [program, "grip", "one_more", "--vessel", "tumbler", "--height-mm", "50"]
                done = subprocess.run(command, env={}, cwd="/", capture_output=True, text=True)
                self.assertEqual(done.returncode, 0 if is_known else 2, f"{place}: {done.stderr}")
                self.assertEqual("no scene file 'one_more'" in done.stderr, not is_known, f"{place}: {done.stderr}")


if __name__ == "__main__":
    unittest.main()
