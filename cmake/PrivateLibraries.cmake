# Run at the installation of the component private_libraries, which is the Debian package's: copies the shared libraries
# `names` of `program`, and the licences of what is in the package by way of the script `copyrights`.
file(GET_RUNTIME_DEPENDENCIES EXECUTABLES ${program} RESOLVED_DEPENDENCIES_VAR found
     PRE_INCLUDE_REGEXES "^lib(${names})[.]so" PRE_EXCLUDE_REGEXES ".")
string(REPLACE "|" ";" wanted "${names}")
foreach(name IN LISTS wanted)
    if(NOT found MATCHES "/lib${name}[.]so")
        message(FATAL_ERROR "${program} is not linked with lib${name}, which its package was to bring along")
    endif()
endforeach()
file(INSTALL ${found} DESTINATION ${CMAKE_INSTALL_PREFIX}/lib/stromboli TYPE SHARED_LIBRARY FOLLOW_SYMLINK_CHAIN)
# They find each other there.
file(GLOB copies $ENV{DESTDIR}${CMAKE_INSTALL_PREFIX}/lib/stromboli/*)
find_program(PATCHELF patchelf REQUIRED)
execute_process(COMMAND ${PATCHELF} --set-rpath "$ORIGIN" ${copies} COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${copyrights} $ENV{DESTDIR}${CMAKE_INSTALL_PREFIX}/share/doc/stromboli/libraries ${found}
                COMMAND_ERROR_IS_FATAL ANY)
