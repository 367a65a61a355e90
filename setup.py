# SPDX-License-Identifier: BSD-3-Clause
"""Builds the CMake tree and puts what it installs into the package: module, program and what is shipped with it.

The tree is build/pip, where a second installation finds what the first one compiled. TOUCHDOWN_BUILD_DIR names another
one; what is configured already is taken as it was built.
"""
import os
import re
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = Path(__file__).resolve().parent
TREE = Path(os.environ.get("TOUCHDOWN_BUILD_DIR") or ROOT / "build" / "pip").resolve()
OWN = TREE == ROOT / "build" / "pip"
AT_WORK = ROOT / "build" / "pip_work"  # what setuptools writes
SUFFIX = sysconfig.get_config_var("EXT_SUFFIX")


def version():
    text = (ROOT / "CMakeLists.txt").read_text(encoding="utf-8")
    return re.search(r"^project\(touchdown VERSION (\S+)", text, re.MULTILINE)[1]


class BuildByCMake(build_ext):
    def build_extension(self, ext):
        if self.inplace:
            raise SystemExit("It cannot be installed in place: PYTHONPATH=build/release/python does that.")
        if OWN or not (TREE / "CMakeCache.txt").is_file():
            self.make()
        package = Path(self.get_ext_fullpath(ext.name)).resolve().parent
        shutil.rmtree(package, ignore_errors=True)
        stage = Path(self.build_temp).resolve() / "stage"
        shutil.rmtree(stage, ignore_errors=True)
        self.install("python", stage)
        modules = list(stage.glob("lib/python*/dist-packages/touchdown/_touchdown" + SUFFIX))
        if not modules:
            raise SystemExit(f"{TREE}: it holds no module for {sys.executable}.")
        shutil.copytree(modules[0].parent, package)
        self.install("program", package)

    def make(self):
        command = ["cmake", "--preset", "release", "-S", ROOT, "-B", TREE]
        command += ["-DTOUCHDOWN_BUILD_TESTS=OFF", "-DTOUCHDOWN_BUILD_BENCHMARKS=OFF", "-DTOUCHDOWN_BUILD_PYTHON=ON"]
        command += [f"-DTOUCHDOWN_PYTHON={sys.executable}"]
        command += [] if shutil.which("ccache") else ["-DCMAKE_CXX_COMPILER_LAUNCHER="]
        subprocess.check_call(command, cwd=ROOT)
        jobs = str(os.cpu_count() or 1)
        subprocess.check_call(["cmake", "--build", TREE, "-j", jobs, "--target", "touchdown", "touchdown_python"])

    def install(self, component, prefix):
        command = ["cmake", "--install", TREE, "--component", component, "--prefix", prefix, "--strip"]
        subprocess.check_call(command, stdout=subprocess.DEVNULL)


AT_WORK.mkdir(parents=True, exist_ok=True)
setup(
    version=version(),
    ext_modules=[Extension("touchdown._touchdown", sources=[])],
    cmdclass={"build_ext": BuildByCMake},
    packages=[],
    options={
        "build": {"build_base": str(AT_WORK)},
        "egg_info": {"egg_base": str(AT_WORK)},
    },
)
