# SPDX-License-Identifier: MIT
"""Builds the wheel: setuptools, and cmake for the part in C++."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

from setuptools.build_meta import *  # noqa: F401,F403  (this is the backend)
from setuptools.command.build_py import build_py
from wheel.bdist_wheel import bdist_wheel

ROOT = Path(__file__).resolve().parents[2]
VERSION = re.search(r"project\(gatewalk VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text()).group(1)


class BuildWithCore(build_py):
    """Python files, and the module _core beside them."""

    def run(self):
        super().run()
        built = os.environ.get("GATEWALK_BUILD")  # a build of these sources with GATEWALK_PYTHON=ON
        folder = Path(built or ROOT / "build-python").resolve()
        if not built:
            generator = ["-G", "Ninja"] if shutil.which("ninja") else []
            subprocess.run(["cmake", "-S", ROOT, "-B", folder, "-DCMAKE_BUILD_TYPE=Release", "-DGATEWALK_PYTHON=ON",
                            "-DBUILD_TESTING=OFF", f"-DPython_EXECUTABLE={sys.executable}", *generator], check=True)
            subprocess.run(["cmake", "--build", folder, "--target", "_core", "--parallel"], check=True)
        for core in (folder / "python/gatewalk").glob("_core.*.so"):
            self.copy_file(str(core), os.path.join(self.build_lib, "gatewalk", core.name))


class PlatformWheel(bdist_wheel):
    """For this Python, on this kind of machine."""

    def finalize_options(self):
        super().finalize_options()
        self.root_is_pure = False
