# cmake --install build/release --prefix P --component library: the header, libstromboli as a shared
# and as a static library, and what CMake and pkg-config find them by. Not part of an installation
# of the program.
include(CMakePackageConfigHelpers)

# The static library: the archives of all that the C API is made of as one, made anew each time,
# since ar would keep what has gone. Their functions are in the namespace stromboli.
get_property(rows GLOBAL PROPERTY STROMBOLI_LAYERS)
set(left stromboli_capi)
set(archives "")
set(seen "")
while(left)
    list(POP_FRONT left one)
    if(one IN_LIST seen OR NOT TARGET ${one})
        continue()
    endif()
    list(APPEND seen ${one})
    get_target_property(type ${one} TYPE)
    get_target_property(is_imported ${one} IMPORTED)
    if(type STREQUAL "STATIC_LIBRARY" AND NOT is_imported)
        list(APPEND archives ${one})
    endif()
    foreach(row IN LISTS rows)
        if(row MATCHES "^${one}\\|[^|]*\\|([^|]*)\\|(.*)$")
            string(REPLACE "," ";" names "${CMAKE_MATCH_1},${CMAKE_MATCH_2}")
            list(APPEND left ${names})
        endif()
    endforeach()
endwhile()
set(STROMBOLI_STATIC_LIBRARY ${CMAKE_BINARY_DIR}/lib/libstromboli.a)
set(script "create ${STROMBOLI_STATIC_LIBRARY}\n")
foreach(one IN LISTS archives)
    string(APPEND script "addlib $<TARGET_FILE:${one}>\n")
endforeach()
file(GENERATE OUTPUT ${CMAKE_BINARY_DIR}/lib/libstromboli.mri CONTENT "${script}save\nend\n")
add_custom_command(OUTPUT ${STROMBOLI_STATIC_LIBRARY}
    COMMAND ${CMAKE_COMMAND} -E rm -f ${STROMBOLI_STATIC_LIBRARY}
    COMMAND ${CMAKE_AR} -M < ${CMAKE_BINARY_DIR}/lib/libstromboli.mri
    DEPENDS ${archives} ${CMAKE_BINARY_DIR}/lib/libstromboli.mri
    COMMENT "Putting the static library together")
add_custom_target(stromboli_static ALL DEPENDS ${STROMBOLI_STATIC_LIBRARY})

set(rules COMPONENT library EXCLUDE_FROM_ALL)
install(FILES include/stromboli/stromboli.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/stromboli ${rules})
install(TARGETS stromboli_shared LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} ${rules}
        NAMELINK_COMPONENT library)
install(DIRECTORY scene/library/ DESTINATION ${CMAKE_INSTALL_DATADIR}/stromboli/scenes ${rules}
        FILES_MATCHING PATTERN *.dae PATTERN *.glb PATTERN *.xml PATTERN *.hdr PATTERN *.ply PATTERN *.png)
install(FILES ${STROMBOLI_STATIC_LIBRARY} DESTINATION ${CMAKE_INSTALL_LIBDIR} ${rules})

# What a program that links statically needs beside it.
set(STROMBOLI_PRIVATE_LIBRARIES
    "-ltbb -lfmt -ltinyxml2 -lpng -ljpeg -lwebp -lgif -lzip -lzstd -lz -lOpenEXR -lOpenEXRCore -lIlmThread -lIex -lImath -ldraco -lmeshoptimizer -lstdc++ -lm -ldl -lpthread")
string(REGEX REPLACE "[ ;]*-l" ";" STROMBOLI_PRIVATE_NAMES "${STROMBOLI_PRIVATE_LIBRARIES}")
list(REMOVE_ITEM STROMBOLI_PRIVATE_NAMES "")

file(RELATIVE_PATH STROMBOLI_PREFIX_FROM_PC ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
configure_file(${CMAKE_CURRENT_LIST_DIR}/package/stromboli.pc.in ${CMAKE_BINARY_DIR}/package/stromboli.pc @ONLY)
install(FILES ${CMAKE_BINARY_DIR}/package/stromboli.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig ${rules})

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/stromboli)
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/package/stromboli-config.cmake.in
    ${CMAKE_BINARY_DIR}/package/stromboli-config.cmake
    INSTALL_DESTINATION ${package_folder} PATH_VARS CMAKE_INSTALL_LIBDIR CMAKE_INSTALL_INCLUDEDIR)
# While the major number is 0, another minor one is another library.
write_basic_package_version_file(${CMAKE_BINARY_DIR}/package/stromboli-config-version.cmake
    VERSION ${PROJECT_VERSION} COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/package/stromboli-config.cmake
              ${CMAKE_BINARY_DIR}/package/stromboli-config-version.cmake
        DESTINATION ${package_folder} ${rules})
