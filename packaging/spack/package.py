# SPDX-License-Identifier: MIT
from spack.package import *


class Sphgrad(CMakePackage):
    """Corrected derivatives of fields that SPH particles carry: KGC, MLS, RKPM."""

    # Set by who publishes it: homepage, url or git, and a version() with its checksum for each release.
    license("MIT")
    version("main", branch="main")

    variant("openmp", default=True, description="Threads by OpenMP; the host's own work without it")
    variant("shared", default=True, description="A shared library")
    variant("fortran", default=False, description="The Fortran module")

    depends_on("c", type="build")
    depends_on("fortran", type="build", when="+fortran")
    depends_on("cmake@3.22:", type="build")
    conflicts("%gcc@:10", msg="GCC 11 or newer")
    conflicts("%clang@:13", msg="Clang 14 or newer")

    def cmake_args(self):
        return [
            self.define_from_variant("BUILD_SHARED_LIBS", "shared"),
            self.define_from_variant("SPHG_OPENMP", "openmp"),
            self.define_from_variant("SPHG_BUILD_FORTRAN", "fortran"),
            self.define("SPHG_BUILD_PYTHON", False),
            self.define("SPHG_BUILD_TESTS", False),
            self.define("SPHG_BUILD_BENCH", False),
            self.define("SPHG_BUILD_EXAMPLES", False),
        ]
