# Settings every target of the project shares.
add_library(stromboli_settings INTERFACE)
target_compile_features(stromboli_settings INTERFACE cxx_std_20)
target_include_directories(stromboli_settings INTERFACE ${PROJECT_SOURCE_DIR})
# No contraction: a*b - c*d must stay two rounded products and a rounded difference, or the
# error bounds and the edge functions' antisymmetry no longer hold (docs/numerics.md).
target_compile_options(stromboli_settings INTERFACE -Wall -Wextra -Wshadow -Wconversion
                       -Wno-sign-conversion -ffp-contract=off)
# g++ 12.2 vectorises double -> float -> double conversions of neighbouring members into nothing:
# the rounding to float is lost, and with it the rule that all backends see the same geometry.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(stromboli_settings INTERFACE -fno-tree-slp-vectorize)
    # False alarms on the sum of two std::strings (GCC bug 105329).
    target_compile_options(stromboli_settings INTERFACE -Wno-restrict)
endif()
# Vulkan's structures are filled by designated initialisers that leave the zero members out.
target_compile_options(stromboli_settings INTERFACE -Wno-missing-field-initializers)
if(STROMBOLI_WARNINGS_AS_ERRORS)
    target_compile_options(stromboli_settings INTERFACE -Werror)
endif()
if(STROMBOLI_SANITIZE)
    target_compile_options(stromboli_settings INTERFACE -fsanitize=${STROMBOLI_SANITIZE}
                           -fno-omit-frame-pointer -fno-sanitize-recover=all)
    target_link_options(stromboli_settings INTERFACE -fsanitize=${STROMBOLI_SANITIZE})
endif()

# stromboli_library(NAME SOURCES a.cpp ... DEPENDS lib ...): one folder of the program.
function(stromboli_library name)
    cmake_parse_arguments(ARG "" "" "SOURCES;DEPENDS" ${ARGN})
    add_library(${name} STATIC ${ARG_SOURCES})
    target_link_libraries(${name} PUBLIC stromboli_settings ${ARG_DEPENDS})
endfunction()

# stromboli_test(NAME SOURCES a.cpp ... DEPENDS lib ... [LABELS l ...] [TIMEOUT seconds]):
# one GoogleTest executable; each of its tests becomes a ctest entry. Tests that use a Vulkan device
# (label device) are left out under sanitizers: drivers leak, and software ones are slow already.
function(stromboli_test name)
    cmake_parse_arguments(ARG "" "TIMEOUT" "SOURCES;DEPENDS;LABELS" ${ARGN})
    set(left_out FALSE)
    if(STROMBOLI_SANITIZE AND "device" IN_LIST ARG_LABELS)
        set(left_out TRUE)
    endif()
    if(NOT ARG_TIMEOUT)
        set(ARG_TIMEOUT 300)
    endif()
    add_executable(${name} ${ARG_SOURCES})
    target_link_libraries(${name} PRIVATE stromboli_settings GTest::gtest_main GTest::gmock
                          ${ARG_DEPENDS})
    target_compile_definitions(${name} PRIVATE
        STROMBOLI_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
    if(left_out)
        set_target_properties(${name} PROPERTIES EXCLUDE_FROM_ALL TRUE)
        return()
    endif()
    # Tests leave nothing in the user's cache folder, and find nothing there.
    gtest_discover_tests(${name} DISCOVERY_MODE PRE_TEST
        PROPERTIES TIMEOUT ${ARG_TIMEOUT} ENVIRONMENT STROMBOLI_CACHE_DIR= LABELS "${ARG_LABELS}")
endfunction()
