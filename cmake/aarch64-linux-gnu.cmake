# SPDX-License-Identifier: MIT
# AArch64 Linux from another machine: Debian's cross compiler, and qemu to run what it made. Libraries
# that do not come with the compiler are taken from SPHG_AARCH64_ROOT, where `tests/run --neon` unpacks
# them.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)

list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES SPHG_AARCH64_ROOT)
get_filename_component(build ${CMAKE_CURRENT_LIST_DIR}/../build ABSOLUTE)
set(SPHG_AARCH64_ROOT ${build}/aarch64-packages CACHE PATH "Packages for AArch64, unpacked")
set(system /usr/aarch64-linux-gnu)
set(libraries ${SPHG_AARCH64_ROOT}/usr/lib/aarch64-linux-gnu)

set(CMAKE_FIND_ROOT_PATH ${SPHG_AARCH64_ROOT} ${system})
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
set(ENV{PKG_CONFIG_SYSROOT_DIR} ${SPHG_AARCH64_ROOT})
set(ENV{PKG_CONFIG_LIBDIR} ${libraries}/pkgconfig)

set(CMAKE_EXE_LINKER_FLAGS_INIT -Wl,-rpath-link=${libraries})
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-aarch64 -L ${system} -E LD_LIBRARY_PATH=${libraries})
