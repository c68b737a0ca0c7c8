# SPDX-License-Identifier: MIT
# Run by CPack behind its work: packages of several architectures may be installed side by side, which CPack
# itself can say from CMake 3.31 on only.
foreach(package IN LISTS CPACK_PACKAGE_FILES)
    set(tree ${package}.tree)
    file(REMOVE_RECURSE ${tree})
    execute_process(COMMAND dpkg-deb --raw-extract ${package} ${tree} COMMAND_ERROR_IS_FATAL ANY)
    file(READ ${tree}/DEBIAN/control control)
    if(NOT control MATCHES "\nMulti-Arch:")
        string(STRIP "${control}" control) # an empty line would end it
        file(WRITE ${tree}/DEBIAN/control "${control}\nMulti-Arch: same\n")
        execute_process(COMMAND dpkg-deb --root-owner-group --build ${tree} ${package}
            COMMAND_ERROR_IS_FATAL ANY OUTPUT_QUIET)
    endif()
    file(REMOVE_RECURSE ${tree})
endforeach()
