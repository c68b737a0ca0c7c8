# SPDX-License-Identifier: MIT
"""The wheel: modules in Python, and the shared library as a file beside them. Nothing is compiled; the
CMake target python_wheel puts the files together."""
import re
import pathlib
from setuptools import Distribution, setup
from wheel.bdist_wheel import bdist_wheel


class ForAnyPython(bdist_wheel):
    """One wheel for every Python 3 of the platform: it is the library that is bound to it."""

    def finalize_options(self):
        super().finalize_options()
        self.root_is_pure = False

    def get_tag(self):
        return "py3", "none", super().get_tag()[2]


class WithLibrary(Distribution):
    def has_ext_modules(self):
        return True


source = pathlib.Path(__file__).parent.joinpath("sphgrad", "_c.py").read_text()
version = ".".join(re.search(r"^VERSION = \((\d+), (\d+), (\d+)\)", source, re.M).groups())

setup(
    name="sphgrad",
    version=version,
    description="Corrected first-order SPH derivatives (KGC, MLS, RKPM) on NumPy arrays",
    license="MIT",
    license_files=["LICENSE"],
    packages=["sphgrad"],
    package_data={"sphgrad": ["*"]},
    python_requires=">=3.8",
    install_requires=["numpy"],
    extras_require={"pairs": ["scipy"]},
    distclass=WithLibrary,
    cmdclass={"bdist_wheel": ForAnyPython},
    zip_safe=False,
)
