# SPDX-License-Identifier: MIT
import os

from conan import ConanFile
from conan.tools.cmake import CMake, cmake_layout, CMakeToolchain
from conan.tools.files import copy


class Sphgrad(ConanFile):
    name = "sphgrad"
    version = "0.1.0"
    license = "MIT"
    description = "Corrected derivatives of fields that SPH particles carry"
    settings = "os", "compiler", "build_type", "arch"
    languages = "C"
    options = {"shared": [True, False], "fPIC": [True, False], "openmp": [True, False]}
    default_options = {"shared": False, "fPIC": True, "openmp": True}
    implements = ["auto_shared_fpic"]

    def export_sources(self):
        sources = os.path.join(self.recipe_folder, "..", "..")
        for pattern in ("CMakeLists.txt", "LICENSE", "include/*", "src/*"):
            copy(self, pattern, src=sources, dst=self.export_sources_folder)

    def layout(self):
        cmake_layout(self)

    def generate(self):
        toolchain = CMakeToolchain(self)
        toolchain.cache_variables["SPHG_OPENMP"] = bool(self.options.openmp)
        for part in ("TESTS", "BENCH", "EXAMPLES", "PYTHON", "FORTRAN"):
            toolchain.cache_variables["SPHG_BUILD_" + part] = False
        toolchain.generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        CMake(self).install()

    def package_info(self):
        # The CMake package and the pkg-config file that were installed are those to use.
        self.cpp_info.set_property("cmake_find_mode", "none")
        self.cpp_info.libs = ["sphgrad"]
        self.cpp_info.builddirs = ["lib/cmake/sphgrad"]
