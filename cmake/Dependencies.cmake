# Everything comes from Debian 12 packages; ./stromboli installs them (see README, "Libraries").
find_package(Threads REQUIRED)
find_package(TBB REQUIRED)
find_package(glm REQUIRED)
find_package(tinyxml2 REQUIRED)
# Debian 13's tinyxml2 asks for _FILE_OFFSET_BITS, which means nothing where addresses have 64 bits,
# and with which a precompiled header that was made without it cannot be used.
get_target_property(tinyxml2_definitions tinyxml2::tinyxml2 INTERFACE_COMPILE_DEFINITIONS)
if(tinyxml2_definitions AND CMAKE_SIZEOF_VOID_P EQUAL 8)
    list(REMOVE_ITEM tinyxml2_definitions _FILE_OFFSET_BITS=64)
    set_target_properties(tinyxml2::tinyxml2 PROPERTIES
                          INTERFACE_COMPILE_DEFINITIONS "${tinyxml2_definitions}")
endif()
find_package(fmt REQUIRED)
find_package(spdlog REQUIRED)
find_package(CLI11 REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(PNG REQUIRED)
find_package(ZLIB REQUIRED)
find_package(OpenEXR REQUIRED)
# Debian's CMake package of libzip also wants tools of other packages.
find_package(PkgConfig REQUIRED)
pkg_check_modules(libzip REQUIRED IMPORTED_TARGET libzip)
pkg_check_modules(libzstd REQUIRED IMPORTED_TARGET libzstd)
find_package(VulkanHeaders REQUIRED)
find_program(GZIP gzip REQUIRED)
find_program(GLSLANG_VALIDATOR glslangValidator REQUIRED)
find_program(SPIRV_OPT spirv-opt REQUIRED)
find_program(SPIRV_VAL spirv-val REQUIRED)
# What Stromboli is measured against: only for `stromboli bench` and its tests.
find_package(embree 3 QUIET)
if(STROMBOLI_TESTS)
    find_package(GTest REQUIRED)
    include(GoogleTest)
endif()

# Debian ships volk as a header and one source file, so it is compiled here.
find_path(VOLK_INCLUDE_DIR volk.h REQUIRED)
find_file(VOLK_SOURCE volk.c PATHS ${VOLK_INCLUDE_DIR} REQUIRED NO_DEFAULT_PATH)
add_library(stromboli_volk STATIC ${VOLK_SOURCE})
target_include_directories(stromboli_volk SYSTEM PUBLIC ${VOLK_INCLUDE_DIR})
target_link_libraries(stromboli_volk PUBLIC ${CMAKE_DL_LIBS})
