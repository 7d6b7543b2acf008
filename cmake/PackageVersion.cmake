# Read by cpack before it makes a package: the package has the version of the program in it, which
# may be newer than the configuration.
execute_process(COMMAND ${CPACK_STROMBOLI_PROGRAM} --version OUTPUT_VARIABLE said
                OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
string(REGEX REPLACE "^stromboli " "" CPACK_PACKAGE_VERSION "${said}")

# Packages of other versions are removed, so that stromboli_*.deb is the one that was made last.
if(CPACK_PACKAGE_DIRECTORY)
    file(GLOB earlier ${CPACK_PACKAGE_DIRECTORY}/stromboli_*.deb)
    if(earlier)
        file(REMOVE ${earlier})
    endif()
endif()
