# SPDX-License-Identifier: MIT
# SOURCE_PATH is the checkout that this file lies in: an overlay port. A port of a release fetches its
# archive instead (vcpkg_from_github).
get_filename_component(SOURCE_PATH "${CURRENT_PORT_DIR}/../.." ABSOLUTE)
vcpkg_check_features(OUT_FEATURE_OPTIONS features FEATURES openmp SPHG_OPENMP)
vcpkg_cmake_configure(
    SOURCE_PATH "${SOURCE_PATH}"
    OPTIONS ${features}
        -DSPHG_BUILD_TESTS=OFF -DSPHG_BUILD_BENCH=OFF -DSPHG_BUILD_EXAMPLES=OFF
        -DSPHG_BUILD_PYTHON=OFF -DSPHG_BUILD_FORTRAN=OFF)
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(CONFIG_PATH lib/cmake/sphgrad)
vcpkg_fixup_pkgconfig()
file(REMOVE_RECURSE "${CURRENT_PACKAGES_DIR}/debug/include" "${CURRENT_PACKAGES_DIR}/debug/share")
vcpkg_install_copyright(FILE_LIST "${SOURCE_PATH}/LICENSE")
