# cmake -DTABLE=layers.txt -DLIBRARY=name -DROOT=source_folder -DSTAMP=file -P CheckLayers.cmake
#
# Fails, with file, line and what is missing, if a file of a library includes a header that the
# library may not see, or calls a function that changes the process. A library sees its own headers
# and those of the libraries that it names in DEPENDS or PRIVATE_DEPENDS; its headers see those of
# DEPENDS alone, and none of the libraries whose headers are slow to compile. The table has a line per library of the program:
#     name|folder|its DEPENDS|its PRIVATE_DEPENDS        (lists separated by commas)
cmake_minimum_required(VERSION 3.22)

# Headers of libraries from elsewhere that not every file may include, and the target they belong to.
set(outside_prefixes
    "CLI/=CLI11::CLI11" "nlohmann/=nlohmann_json::nlohmann_json" "spdlog/=spdlog::spdlog"
    "tinyxml2.h=tinyxml2::tinyxml2" "zip.h=PkgConfig::libzip" "zstd.h=PkgConfig::libzstd"
    "httplib.h=PkgConfig::httplib" "toml++/=tomlplusplus::tomlplusplus"
    "png.h=PNG::PNG" "Imf=OpenEXR::OpenEXR"
    "jpeglib.h=JPEG::JPEG" "gif_lib.h=GIF::GIF" "webp/=PkgConfig::libwebp" "draco/=draco::draco_static"
    "meshoptimizer.h=meshoptimizer::meshoptimizer"
    "OpenEXR/=OpenEXR::OpenEXR" "zlib.h=ZLIB::ZLIB" "volk.h=stromboli_volk"
    "vulkan/=Vulkan::Headers" "pybind11/=pybind11::headers")
# Functions that change the process, which belongs to whoever runs the program, and the folders that
# may call them.
set(process_functions
    "(^|[^A-Za-z0-9_.>])(setenv|unsetenv|putenv|mallopt|sigaction|pthread_sigmask|signal|atexit)[ ]*\\(")
set(process_folders host/cli host/process)
# Templates that take seconds to compile: no header includes them.
set(slow_in_headers "^(CLI/|toml|httplib\\.h|nlohmann/json\\.hpp|spdlog/|fmt/|tbb/)")

file(STRINGS ${TABLE} rows)
foreach(row IN LISTS rows)
    string(REPLACE "|" ";" row "${row}")
    list(GET row 0 name)
    list(GET row 1 folder)
    string(REPLACE "/" "_" key "${folder}")
    set(owner_of_${key} ${name})
    if(name STREQUAL LIBRARY)
        list(GET row 2 public)
        list(GET row 3 private)
        string(REPLACE "," ";" public "${public}")
        string(REPLACE "," ";" private "${private}")
        set(own_folder ${folder})
    endif()
endforeach()

# The target a header belongs to, in `result`; empty where everybody may include it.
function(owner header result)
    set(${result} "" PARENT_SCOPE)
    if(header MATCHES "^(host|scene|shaders)/")
        get_filename_component(folder ${header} DIRECTORY)
        string(REPLACE "/" "_" key "${folder}")
        if(DEFINED owner_of_${key})
            set(${result} ${owner_of_${key}} PARENT_SCOPE)
        else()
            set(${result} "a library that owns ${folder}" PARENT_SCOPE)
        endif()
        return()
    endif()
    foreach(pair IN LISTS outside_prefixes)
        string(REGEX MATCH "^(.*)=(.*)$" ignored "${pair}")
        set(target ${CMAKE_MATCH_2})
        string(FIND "${header}" "${CMAKE_MATCH_1}" at)
        if(at EQUAL 0)
            set(${result} ${target} PARENT_SCOPE)
        endif()
    endforeach()
endfunction()

function(line_of file include result)
    file(READ ${file} text)
    string(FIND "${text}" "${include}" at)
    string(SUBSTRING "${text}" 0 ${at} before)
    string(REGEX REPLACE "[^\n]" "" before "${before}")
    string(LENGTH "${before}" line)
    math(EXPR line "${line} + 1")
    set(${result} ${line} PARENT_SCOPE)
endfunction()

file(GLOB files ${ROOT}/${own_folder}/*.cpp ${ROOT}/${own_folder}/*.hpp ${ROOT}/${own_folder}/*.h)
set(broken "")
foreach(file IN LISTS files)
    set(is_header FALSE)
    if(file MATCHES "\\.(hpp|h)$")
        set(is_header TRUE)
    endif()
    file(STRINGS ${file} includes REGEX "^[ \t]*#[ \t]*include")
    foreach(include IN LISTS includes)
        string(REGEX REPLACE "^[ \t]*#[ \t]*include[ \t]*[<\"]([^>\"]*)[>\"].*$" "\\1" header
               "${include}")
        owner("${header}" target)
        set(problem "")
        if(is_header AND header MATCHES "${slow_in_headers}")
            set(problem "is slow to compile; include it in a .cpp file")
        elseif(target STREQUAL "" OR target STREQUAL LIBRARY OR target IN_LIST public)
            # It may be seen.
        elseif(NOT target IN_LIST private)
            set(problem "belongs to ${target}, which ${LIBRARY} does not name in DEPENDS")
        elseif(is_header)
            set(problem "belongs to ${target}, which ${LIBRARY} names in PRIVATE_DEPENDS: a header needs DEPENDS")
        endif()
        if(problem)
            line_of(${file} "${include}" line)
            string(APPEND broken "${file}:${line}: ${header} ${problem}\n")
        endif()
    endforeach()
    if(NOT own_folder IN_LIST process_folders)
        file(STRINGS ${file} calls REGEX "${process_functions}")
        foreach(call IN LISTS calls)
            if(call MATCHES "^[ \t]*//")
                continue()
            endif()
            line_of(${file} "${call}" line)
            string(APPEND broken "${file}:${line}: this changes the process; only ${process_folders} may\n")
        endforeach()
    endif()
endforeach()

if(broken)
    message("${broken}")
    message(FATAL_ERROR "Layers: the lines above cross a boundary (docs/architecture.md).")
endif()
file(WRITE ${STAMP} "")
