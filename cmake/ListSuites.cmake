# Writes the ctest entries of a GoogleTest program's suites: cmake -DPROGRAM=... -DLIST=... -DPROPERTIES=... -P
execute_process(COMMAND ${PROGRAM} --gtest_list_tests OUTPUT_VARIABLE tests COMMAND_ERROR_IS_FATAL ANY)
# Suites begin at the margin and end with a full stop; behind it may stand what type or value they have.
string(REGEX MATCHALL "\n[^ \n]+\\.[^\n]*" suites "\n${tests}")
if(NOT suites)
    message(FATAL_ERROR "${PROGRAM} lists no suites")
endif()
set(entries)
foreach(suite IN LISTS suites)
    string(REGEX REPLACE "^\n([^ \n]+)\\.[^.]*$" "\\1" suite "${suite}")
    string(APPEND entries "add_test([=[${suite}]=] [=[${PROGRAM}]=] [=[--gtest_filter=${suite}.*]=])\n"
                          "set_tests_properties([=[${suite}]=] PROPERTIES ${PROPERTIES})\n")
endforeach()
string(REPLACE ";" " " entries "${entries}")
file(WRITE ${LIST} "${entries}")
