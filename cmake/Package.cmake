# A Debian package: ./stromboli package, or the target package_deb, or cpack after a build.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME stromboli)
set(CPACK_PACKAGE_CONTACT "The Stromboli maintainers <stromboli@localhost>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PACKAGE_DIRECTORY ${CMAKE_BINARY_DIR}/packages)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "path tracer in Vulkan compute shaders")
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION
    "Stromboli renders scenes in glTF, COLLADA, Mitsuba, pbrt, OBJ and PLY to PNG, JPEG,
WebP or EXR on any Vulkan 1.1 device, without a ray-tracing extension, and on
machines without a GPU through Mesa's lavapipe. A second path tracer, in double
precision, checks it.")
# Libraries that the program is linked with are found by dpkg-shlibdeps. The Vulkan loader is opened
# when it runs, and finds a driver: Mesa's has a device that is a CPU, so that any machine renders.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_DEPENDS "libvulkan1, mesa-vulkan-drivers | vulkan-icd")
# What `stromboli bench` measures against, and STROMBOLI_VALIDATION=1.
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "libembree3-3, vulkan-validationlayers")
# Opened when a file needs them: STL, FBX, 3DS and others; TIFF pictures.
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "libassimp5, libtiff6")

# The package made on Debian 12 is for 13 too, where these libraries have other sonames: it brings them along, in a folder
# that the program alone looks into (INSTALL_RPATH in host/cli). All others are found by dpkg-shlibdeps, and both
# releases have them under one soname. Draco is linked statically.
set(private_libraries cpp-httplib fmt spdlog tinyxml2 zip)
list(JOIN private_libraries "|" names)
install(CODE "set(program $<TARGET_FILE:stromboli>)
set(names \"${names}\")
set(copyrights ${CMAKE_CURRENT_LIST_DIR}/package/copyrights)"
        COMPONENT private_libraries EXCLUDE_FROM_ALL)
install(SCRIPT ${CMAKE_CURRENT_LIST_DIR}/PrivateLibraries.cmake COMPONENT private_libraries EXCLUDE_FROM_ALL)
set(CPACK_INSTALL_CMAKE_PROJECTS "${CMAKE_BINARY_DIR};${PROJECT_NAME};ALL;/"
    "${CMAKE_BINARY_DIR};${PROJECT_NAME};private_libraries;/")
set(CPACK_PROJECT_CONFIG_FILE ${CMAKE_CURRENT_LIST_DIR}/PackageVersion.cmake)
set(CPACK_STROMBOLI_PROGRAM ${CMAKE_BINARY_DIR}/bin/stromboli)
include(CPack)

# The tests, which `all` may hold, are not needed for it.
add_custom_target(package_deb
    COMMAND ${CMAKE_CPACK_COMMAND} -G DEB
    WORKING_DIRECTORY ${CMAKE_BINARY_DIR}
    COMMENT "Making a Debian package"
    VERBATIM)
add_dependencies(package_deb stromboli stromboli_manual_files stromboli_changelog)
