# cmake -DBUILD=build_folder -DPREFIX=folder -P install.cmake: installs module and library into a
# folder that is empty before.
file(REMOVE_RECURSE ${PREFIX})
foreach(component python library)
    execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD} --prefix ${PREFIX} --component ${component}
                    RESULT_VARIABLE failed OUTPUT_QUIET)
    if(failed)
        message(FATAL_ERROR "installing ${component} failed")
    endif()
endforeach()
