# SPDX-License-Identifier: MIT
# Packages for Debian by CPack: the library, and what is needed to build with it. Configured with
# the prefix /usr, GNUInstallDirs knows Debian's folders; the preset "package" does that, and
# `tests/run --packages` tries what comes out.
set(SPHG_PACKAGE_CONTACT "sphgrad authors <sphgrad@users.noreply.invalid>" CACHE STRING
    "Who answers for packages: name and address")
set(library libsphgrad${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}) # as Debian derives it from the SONAME

# What Debian wants beside the files: the licence and a changelog, in each package.
find_program(SPHG_GZIP gzip REQUIRED)
set(changelog ${CMAKE_CURRENT_BINARY_DIR}/changelog)
configure_file(${CMAKE_CURRENT_LIST_DIR}/debian/changelog.in ${changelog} @ONLY)
execute_process(COMMAND ${SPHG_GZIP} -9 -n -k -f ${changelog} COMMAND_ERROR_IS_FATAL ANY)
# Programs that link the library depend on this package; the loader hears of it when it is installed.
set(control ${CMAKE_CURRENT_BINARY_DIR}/control)
file(WRITE ${control}/shlibs
    "libsphgrad ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR} ${library} (>= ${PROJECT_VERSION})\n")
file(WRITE ${control}/triggers "activate-noawait ldconfig\n")
configure_file(${CMAKE_CURRENT_LIST_DIR}/debian/copyright.in ${CMAKE_CURRENT_BINARY_DIR}/copyright @ONLY)
foreach(component IN ITEMS Runtime Development)
    set(package ${library})
    if(component STREQUAL "Development")
        set(package libsphgrad-dev)
    endif()
    install(FILES ${changelog}.gz ${CMAKE_CURRENT_BINARY_DIR}/copyright
        DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/doc/${package}
        COMPONENT sphgrad_${component})
endforeach()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME sphgrad)
set(CPACK_PACKAGE_CONTACT "${SPHG_PACKAGE_CONTACT}")
set(CPACK_PACKAGE_VENDOR sphgrad)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE
    WORLD_READ WORLD_EXECUTE)
set(CPACK_COMPONENTS_ALL sphgrad_Runtime sphgrad_Development sphgrad_Cpp)
if(TARGET sphgrad_fortran)
    list(APPEND CPACK_COMPONENTS_ALL sphgrad_Fortran)
endif()
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(about "A C library for gradients, divergences, curls and Jacobians of fields
that SPH particles carry, corrected so that they are exact on linear
fields at free surfaces, too.")
set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME ${library})
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SECTION libs)
set(CPACK_POST_BUILD_SCRIPTS ${CMAKE_CURRENT_LIST_DIR}/debian/multiarch.cmake)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_CONTROL_EXTRA ${control}/shlibs ${control}/triggers)
set(CPACK_DEBIAN_RUNTIME_DESCRIPTION "${about}")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libsphgrad-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "${library} (= ${PROJECT_VERSION})")
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION "${about}
This package has the headers for C and C++, the source of the Fortran
module, the CMake package and the file for pkg-config.")

include(CPack)
include(CPackComponent)
cpack_add_component_group(runtime)
cpack_add_component_group(development)
cpack_add_component(sphgrad_Runtime GROUP runtime)
foreach(component IN ITEMS Development Cpp Fortran)
    cpack_add_component(sphgrad_${component} GROUP development)
endforeach()
