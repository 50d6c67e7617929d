# SPDX-License-Identifier: MIT
"""Builds wholehand._core with CMake, and packs the shipped scenes beside it, where the module looks for them (core/reader/shipped.cpp)."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = Path(__file__).parent.resolve()


class CMakeBuild(build_ext):
    """Only what the module needs: no tests, no program."""

    def build_extension(self, extension: Extension) -> None:
        module = Path(self.get_ext_fullpath(extension.name)).resolve()
        build = Path(self.build_temp).resolve()
        build.mkdir(parents=True, exist_ok=True)
        options = {
            "CMAKE_BUILD_TYPE": "Release",
            "WHOLEHAND_TESTS": "OFF",
            "WHOLEHAND_PYTHON": "ON",
            "Python_EXECUTABLE": sys.executable,
        }
        subprocess.run(
            ["cmake", "-S", ROOT, "-B", build, "-G", "Ninja", *(f"-D{key}={value}" for key, value in options.items())], check=True
        )
        # CMAKE_BUILD_PARALLEL_LEVEL says on how many cores, as for any CMake build
        subprocess.run(["cmake", "--build", build, "--target", "wholehand_python"], check=True)
        module.parent.mkdir(parents=True, exist_ok=True)
        (built,) = (build / "python").glob("_core*.so")
        shutil.copy2(built, module)
        subprocess.run(["strip", "--strip-unneeded", module], check=True)
        for folder in ("scenes", "extreme"):
            shutil.copytree(ROOT / "examples" / folder, module.parent / "share/wholehand" / folder, dirs_exist_ok=True)


version = re.search(r"project\(wholehand VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text())
assert version
os.chdir(ROOT)
setup(version=version[1], ext_modules=[Extension("wholehand._core", [])], cmdclass={"build_ext": CMakeBuild})
