# Settings every target of the project shares.
add_library(stromboli_settings INTERFACE)
target_compile_features(stromboli_settings INTERFACE cxx_std_20)
target_include_directories(stromboli_settings INTERFACE ${PROJECT_SOURCE_DIR})
# No contraction: a*b - c*d must stay two rounded products and a rounded difference, or the
# error bounds and the edge functions' antisymmetry no longer hold (docs/theory/numerics.md).
target_compile_options(stromboli_settings INTERFACE -Wall -Wextra -Wshadow -Wconversion
                       -Wno-sign-conversion -ffp-contract=off)
# Nothing reads errno or the flags of floating-point exceptions after a root or a comparison; for their
# sake alone the compiler would make no vectors of loops with either.
target_compile_options(stromboli_settings INTERFACE -fno-math-errno -fno-trapping-math)
# All code may become part of a shared library (host/capi, python), which shows nothing but what it
# says it shows. By an option and not by POSITION_INDEPENDENT_CODE, which is -fPIE for programs:
# tests could not use precompiled headers that libraries made.
target_compile_options(stromboli_settings INTERFACE -fPIC -fvisibility=hidden -fvisibility-inlines-hidden)
# g++ 12.2 vectorises double -> float -> double conversions of neighbouring members into nothing:
# the rounding to float is lost, and with it the rule that all backends see the same geometry.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(stromboli_settings INTERFACE -fno-tree-slp-vectorize)
    # False alarms on the sum of two std::strings (GCC bug 105329).
    target_compile_options(stromboli_settings INTERFACE -Wno-restrict)
endif()
# The compiler's garbage collection is a tenth of its time and frees little of the few hundred MB that a file takes.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(stromboli_settings INTERFACE --param=ggc-min-heapsize=500000)
endif()
# Vulkan's structures are filled by designated initialisers that leave the zero members out.
target_compile_options(stromboli_settings INTERFACE -Wno-missing-field-initializers)
if(STROMBOLI_WARNINGS_AS_ERRORS)
    target_compile_options(stromboli_settings INTERFACE -Werror)
endif()
if(STROMBOLI_SANITIZE)
    # Pointers to nothing and beyond an object: AddressSanitizer finds them where they are followed.
    # UndefinedBehaviorSanitizer's checks of each of them are an eighth of the compiler's time.
    target_compile_options(stromboli_settings INTERFACE -fsanitize=${STROMBOLI_SANITIZE}
                           -fno-sanitize=null,vptr,object-size
                           -fno-omit-frame-pointer -fno-sanitize-recover=all)
    target_link_options(stromboli_settings INTERFACE -fsanitize=${STROMBOLI_SANITIZE})
    # The checks that sanitizers add make g++ see uses of uninitialised members where there are none
    # (its manual warns of it), as in <regex>; the release build keeps the warning.
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
        target_compile_options(stromboli_settings INTERFACE -Wno-maybe-uninitialized)
    endif()
endif()

# Headers that most files include, of the standard library and of libraries, are parsed once and
# kept: about a second less for each file. A precompiled header is good for files that are compiled
# with the same definitions and options only, so that all get those of fmt, whose headers are in it.
option(STROMBOLI_PRECOMPILED_HEADERS "Parse the headers of libraries once" ON)
set(STROMBOLI_COMMON_HEADERS
    <algorithm> <array> <cmath> <cstdint> <cstring> <filesystem> <fstream> <functional> <limits>
    <memory> <optional> <span> <string> <string_view> <utility> <vector> <fmt/format.h>
    <glm/glm.hpp>)
target_link_libraries(stromboli_settings INTERFACE fmt::fmt glm::glm TBB::tbb)

# stromboli_precompiled(NAME [OPTIONS -O1 ...] HEADERS <a> ...): a precompiled header for the
# targets that have the same options.
function(stromboli_precompiled name)
    cmake_parse_arguments(ARG "" "" "OPTIONS;HEADERS;DEPENDS" ${ARGN})
    if(NOT STROMBOLI_PRECOMPILED_HEADERS)
        return()
    endif()
    file(WRITE ${CMAKE_BINARY_DIR}/precompiled/${name}.cpp "// Owns a precompiled header.\n")
    add_library(${name} OBJECT ${CMAKE_BINARY_DIR}/precompiled/${name}.cpp)
    target_link_libraries(${name} PRIVATE stromboli_settings ${ARG_DEPENDS})
    target_compile_options(${name} PRIVATE ${ARG_OPTIONS})
    target_precompile_headers(${name} PRIVATE ${ARG_HEADERS})
endfunction()

# The command line, what prints its results, and tests run once: nobody notices how fast they are,
# but half of the compiler's time went into making them fast.
set(STROMBOLI_COLD_CODE $<$<CONFIG:Release>:-O1>)
stromboli_precompiled(stromboli_precompiled_hot HEADERS ${STROMBOLI_COMMON_HEADERS})
stromboli_precompiled(stromboli_precompiled_cold OPTIONS ${STROMBOLI_COLD_CODE}
                      HEADERS ${STROMBOLI_COMMON_HEADERS})
if(STROMBOLI_TESTS)
    stromboli_precompiled(stromboli_precompiled_tests OPTIONS ${STROMBOLI_COLD_CODE} DEPENDS GTest::gtest_main GTest::gmock
                          HEADERS ${STROMBOLI_COMMON_HEADERS} <gmock/gmock.h> <gtest/gtest.h>)
endif()

function(stromboli_use_precompiled target header)
    if(STROMBOLI_PRECOMPILED_HEADERS)
        target_precompile_headers(${target} REUSE_FROM ${header})
    endif()
endfunction()

# Several files of a library or a test program are compiled as one: what their headers hold is read, and
# the templates that they share are made, once for all of them (docs/results.md). What a file
# keeps to itself must therefore have a name that no other file of its folder uses. For those who edit a
# file at a time OFF is better.
option(STROMBOLI_UNITY_BUILD "Compile several files of a library or a test program as one" ON)
set(STROMBOLI_FILES_AT_ONCE 6)
set(STROMBOLI_TEST_FILES_AT_ONCE 16) # nearly all of GoogleTest's templates are alike in them
function(stromboli_compile_together target count)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ${STROMBOLI_UNITY_BUILD} UNITY_BUILD_BATCH_SIZE ${count})
endfunction()

# stromboli_library(NAME [COLD] SOURCES a.cpp ... DEPENDS lib ... [PRIVATE_DEPENDS lib ...]): one
# folder of the program. COLD: compiled quickly and not for speed. PRIVATE_DEPENDS: libraries whose
# headers no header of this one includes.
function(stromboli_library name)
    cmake_parse_arguments(ARG "COLD" "" "SOURCES;DEPENDS;PRIVATE_DEPENDS" ${ARGN})
    add_library(${name} STATIC ${ARG_SOURCES})
    target_link_libraries(${name} PUBLIC stromboli_settings ${ARG_DEPENDS}
                          PRIVATE ${ARG_PRIVATE_DEPENDS})
    stromboli_compile_together(${name} ${STROMBOLI_FILES_AT_ONCE})
    if(ARG_COLD)
        target_compile_options(${name} PRIVATE ${STROMBOLI_COLD_CODE})
        stromboli_use_precompiled(${name} stromboli_precompiled_cold)
    else()
        stromboli_use_precompiled(${name} stromboli_precompiled_hot)
    endif()
    stromboli_layer(${name} DEPENDS ${ARG_DEPENDS} PRIVATE_DEPENDS ${ARG_PRIVATE_DEPENDS})
endfunction()

# stromboli_embed_text(TARGET NAME FILE): the bytes of a file as an array NAME, in the header
# embedded/NAME.h that the target's files include.
function(stromboli_embed_text target name file)
    set(header ${CMAKE_CURRENT_BINARY_DIR}/embedded/${name}.h)
    get_filename_component(source ${file} ABSOLUTE)
    add_custom_command(
        OUTPUT ${header}
        COMMAND ${CMAKE_COMMAND} -E make_directory ${CMAKE_CURRENT_BINARY_DIR}/embedded
        COMMAND ${CMAKE_COMMAND} -DINPUT=${source} -DOUTPUT=${header} -DNAME=${name}
                -P ${PROJECT_SOURCE_DIR}/cmake/EmbedText.cmake
        DEPENDS ${source} ${PROJECT_SOURCE_DIR}/cmake/EmbedText.cmake
        COMMENT "Embedding ${name}"
        VERBATIM)
    target_sources(${target} PRIVATE ${header})
    target_include_directories(${target} PRIVATE ${CMAKE_CURRENT_BINARY_DIR})
endfunction()

# stromboli_layer(NAME [FOLDER folder] [DEPENDS lib ...] [PRIVATE_DEPENDS lib ...]): the target owns
# the headers of the folder (by default the one its CMakeLists.txt is in) and sees those of the
# libraries it names.
function(stromboli_layer name)
    cmake_parse_arguments(ARG "" "FOLDER" "DEPENDS;PRIVATE_DEPENDS" ${ARGN})
    if(NOT ARG_FOLDER)
        file(RELATIVE_PATH ARG_FOLDER ${PROJECT_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR})
    endif()
    string(REPLACE ";" "," public "${ARG_DEPENDS}")
    string(REPLACE ";" "," private "${ARG_PRIVATE_DEPENDS}")
    set_property(GLOBAL APPEND PROPERTY STROMBOLI_LAYERS
                 "${name}|${ARG_FOLDER}|${public}|${private}")
endfunction()

# Makes the build of each library fail where one of its files includes what it may not see
# (cmake/CheckLayers.cmake). To be called when all of them are known.
function(stromboli_check_layers)
    set(table ${CMAKE_BINARY_DIR}/layers.txt)
    get_property(rows GLOBAL PROPERTY STROMBOLI_LAYERS)
    list(JOIN rows "\n" text)
    file(CONFIGURE OUTPUT ${table} CONTENT "${text}\n" @ONLY)
    foreach(row IN LISTS rows)
        string(REPLACE "|" ";" row "${row}")
        list(GET row 0 name)
        list(GET row 1 folder)
        file(GLOB files CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${folder}/*.cpp
             ${PROJECT_SOURCE_DIR}/${folder}/*.hpp ${PROJECT_SOURCE_DIR}/${folder}/*.h)
        set(stamp ${CMAKE_BINARY_DIR}/layers/${name})
        add_custom_command(
            OUTPUT ${stamp}
            COMMAND ${CMAKE_COMMAND} -DTABLE=${table} -DLIBRARY=${name} -DROOT=${PROJECT_SOURCE_DIR}
                    -DSTAMP=${stamp} -P ${PROJECT_SOURCE_DIR}/cmake/CheckLayers.cmake
            DEPENDS ${files} ${table} ${PROJECT_SOURCE_DIR}/cmake/CheckLayers.cmake
            COMMENT "Checking what ${name} includes"
            VERBATIM)
        add_custom_target(${name}_layers DEPENDS ${stamp})
        add_dependencies(${name} ${name}_layers)
    endforeach()
endfunction()

# stromboli_suites(NAME LEFT_OUT QUICK ENVIRONMENT property value ...): makes a ctest entry of each suite of a
# GoogleTest program, which is asked for them once it is linked, but of those of the list LEFT_OUT. Those of the list
# QUICK have the other environment.
function(stromboli_suites name left_out quick environment)
    set(list ${CMAKE_CURRENT_BINARY_DIR}/${name}_suites.cmake)
    add_custom_command(TARGET ${name} POST_BUILD
        COMMAND ${CMAKE_COMMAND} -DPROGRAM=$<TARGET_FILE:${name}> -DLIST=${list}
                "-DLEFT_OUT=${left_out}" "-DPROPERTIES=${ARGN}"
                "-DQUICK=${quick}" "-DENVIRONMENT=${environment}"
                -P ${PROJECT_SOURCE_DIR}/cmake/ListSuites.cmake
        BYPRODUCTS ${list}
        VERBATIM)
    set(entries ${CMAKE_CURRENT_BINARY_DIR}/${name}_entries.cmake)
    file(WRITE ${entries} "if(EXISTS \"${list}\")
  include(\"${list}\")
else()
  add_test(${name}_NOT_BUILT ${name}_NOT_BUILT)
endif()
")
    set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${entries})
endfunction()

# stromboli_test_objects(NAME SOURCES a.cpp ... DEPENDS lib ...): files that several test programs have, compiled once.
# Programs name it among what they depend on.
function(stromboli_test_objects name)
    cmake_parse_arguments(ARG "" "" "SOURCES;DEPENDS" ${ARGN})
    add_library(${name} OBJECT EXCLUDE_FROM_ALL ${ARG_SOURCES})
    target_link_libraries(${name} PUBLIC stromboli_settings GTest::gtest_main GTest::gmock ${ARG_DEPENDS})
    target_compile_options(${name} PRIVATE ${STROMBOLI_COLD_CODE})
    stromboli_compile_together(${name} ${STROMBOLI_TEST_FILES_AT_ONCE})
    stromboli_use_precompiled(${name} stromboli_precompiled_tests)
endfunction()

# stromboli_test(NAME SOURCES a.cpp ... DEPENDS lib ... [LABELS l] [TIMEOUT seconds] [MANY_KERNELS]
#                [BY_SUITES] [QUICK_KERNELS suite ...] [NOT_SANITIZED] [SUITES_NOT_SANITIZED suite ...]):
# one GoogleTest executable; each of its tests becomes a ctest entry. Tests that use a Vulkan device
# (label device) are left out under sanitizers: drivers leak, and software ones are slow already.
# NOT_SANITIZED ones are, too: of commands that measure, print and install, and read no file but the
# program's own, whose libraries are a third of what the compiler would have to do; and whole pictures
# of files that other tests read.
# SUITES_NOT_SANITIZED: suites of statistics, which do a thousand times what other tests do once.
# MANY_KERNELS: leaves out the core checks of the Vulkan validation layer, which optimise and validate
# each specialised kernel anew and take up to three quarters of a test that compiles one. For tests
# that ask of the device what others ask that keep the checks.
# QUICK_KERNELS: suites, or ALL, of a program BY_SUITES for which lavapipe's compiler takes longer than their kernels run:
# it leaves out optimisation, which halves its time, makes kernels two to three times slower and leaves every bit as it
# is. Other drivers do not know the setting. For tests of what the shaders say: that the compiler optimises them rightly
# is asked by those that compare kernels with plain ones, and by all others, which have it.
# BY_SUITES: the ctest entries are the program's test suites, not its tests: where the device takes longer
# to open, and kernels that tests share longer to compile, than the tests take to run.
function(stromboli_test name)
    cmake_parse_arguments(ARG "MANY_KERNELS;BY_SUITES;NOT_SANITIZED" "TIMEOUT;LABELS"
                          "SOURCES;DEPENDS;QUICK_KERNELS;SUITES_NOT_SANITIZED" ${ARGN})
    set(left_out FALSE)
    if(STROMBOLI_SANITIZE AND (ARG_NOT_SANITIZED OR "device" IN_LIST ARG_LABELS))
        set(left_out TRUE)
    endif()
    if(NOT ARG_TIMEOUT)
        set(ARG_TIMEOUT 300)
    endif()
    if(STROMBOLI_SANITIZE)
        set(ARG_TIMEOUT 2400)
    endif()
    add_executable(${name} ${ARG_SOURCES})
    target_link_libraries(${name} PRIVATE stromboli_settings GTest::gtest_main GTest::gmock
                          ${ARG_DEPENDS})
    target_compile_options(${name} PRIVATE ${STROMBOLI_COLD_CODE})
    stromboli_compile_together(${name} ${STROMBOLI_TEST_FILES_AT_ONCE})
    stromboli_use_precompiled(${name} stromboli_precompiled_tests)
    if(left_out)
        set_target_properties(${name} PROPERTIES EXCLUDE_FROM_ALL TRUE)
        return()
    endif()
    set(checks)
    if(ARG_MANY_KERNELS)
        set(checks ENVIRONMENT_MODIFICATION
            VK_LAYER_DISABLES=set:VK_VALIDATION_FEATURE_DISABLE_CORE_CHECKS_EXT)
    endif()
    # Tests leave nothing in the user's cache folder, and find nothing there.
    set(environment STROMBOLI_CACHE_DIR=)
    set(properties TIMEOUT ${ARG_TIMEOUT} ENVIRONMENT ${environment} ${checks})
    if(ARG_LABELS)
        list(APPEND properties LABELS ${ARG_LABELS})
    endif()
    # Under sanitizers a process takes longer to start than most tests to run.
    if(STROMBOLI_SANITIZE)
        stromboli_suites(${name} "${ARG_SUITES_NOT_SANITIZED}" "" "" ${properties})
    elseif(ARG_BY_SUITES)
        stromboli_suites(${name} "" "${ARG_QUICK_KERNELS}" "${environment};GALLIVM_PERF=nopt" ${properties})
    else()
        gtest_discover_tests(${name} DISCOVERY_MODE PRE_TEST NO_PRETTY_VALUES PROPERTIES ${properties})
    endif()
endfunction()

# stromboli_export(TARGET): libraries.cmake in the build folder, which gives another build (STROMBOLI_BUILT) the libraries
# that the target is made of.
function(stromboli_export target)
    get_target_property(left ${target} LINK_LIBRARIES)
    set(exported "")
    while(left)
        list(POP_FRONT left one)
        string(REGEX REPLACE "^[$]<LINK_ONLY:(.*)>$" "\\1" one "${one}")
        if(NOT TARGET ${one} OR one IN_LIST exported)
            continue()
        endif()
        get_target_property(is_imported ${one} IMPORTED)
        if(is_imported)
            continue()
        endif()
        list(APPEND exported ${one})
        get_target_property(further ${one} INTERFACE_LINK_LIBRARIES)
        if(further)
            list(APPEND left ${further})
        endif()
    endwhile()
    export(TARGETS ${exported} NAMESPACE built:: FILE ${CMAKE_BINARY_DIR}/libraries.cmake)
endfunction()
