# Writes the ctest entries of a GoogleTest program's suites, but of those LEFT_OUT:
# cmake -DPROGRAM=... -DLIST=... -DLEFT_OUT=... -DPROPERTIES=... -P
execute_process(COMMAND ${PROGRAM} --gtest_list_tests OUTPUT_VARIABLE tests COMMAND_ERROR_IS_FATAL ANY)
# Suites begin at the margin and end with a full stop; behind it may stand what type or value they have.
string(REGEX MATCHALL "\n[^ \n]+\\.[^\n]*" suites "\n${tests}")
if(NOT suites)
    message(FATAL_ERROR "${PROGRAM} lists no suites")
endif()
set(entries)
foreach(suite IN LISTS suites)
    string(REGEX REPLACE "^\n([^ \n]+)\\.[^.]*$" "\\1" suite "${suite}")
    list(FIND LEFT_OUT "${suite}" at)
    if(NOT at EQUAL -1)
        list(REMOVE_AT LEFT_OUT ${at})
        continue()
    endif()
    string(APPEND entries "add_test([=[${suite}]=] [=[${PROGRAM}]=] [=[--gtest_filter=${suite}.*]=])\n"
                          "set_tests_properties([=[${suite}]=] PROPERTIES ${PROPERTIES})\n")
endforeach()
if(LEFT_OUT)
    message(FATAL_ERROR "${PROGRAM} has no suites ${LEFT_OUT}")
endif()
string(REPLACE ";" " " entries "${entries}")
file(WRITE ${LIST} "${entries}")
