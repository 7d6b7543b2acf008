# cmake -DSOURCE=folder -DBASE=0.1.0 -DTOOLS=words -DINPUT=version.cpp.in -DOUTPUT=version.cpp
#       -P GitVersion.cmake
# or include()d, for the function alone. Writes the version, and what RenderingCode.cmake says of
# the folder and the tools.
#
# The version of a source folder: the project's version; in a git checkout with the commits since
# the tag of that version (v0.1.0; where there is no such tag: all commits) and the commit, as
# 0.1.0+12.gabcdef1, with ".changed" at the end where files differ from the commit. A checkout of
# the tag itself, and an unpacked archive, have the project's version alone.

function(stromboli_git_version source base result)
    set(${result} ${base} PARENT_SCOPE)
    find_program(GIT git)
    # An archive that was unpacked inside somebody else's checkout is not of that checkout.
    if(NOT GIT OR NOT EXISTS ${source}/.git)
        return()
    endif()
    macro(git output)
        execute_process(COMMAND ${GIT} -C ${source} ${ARGN} OUTPUT_VARIABLE ${output}
                        RESULT_VARIABLE failed ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
    endmacro()
    git(commit rev-parse --short=7 --verify HEAD)
    if(failed) # no commit yet, or a checkout that belongs to somebody else
        return()
    endif()
    git(ignored rev-parse --verify --quiet v${base}^{commit})
    set(commits HEAD)
    if(NOT failed)
        set(commits v${base}..HEAD)
    endif()
    git(count rev-list --count ${commits})
    # --no-optional-locks: to look must not be in the way of a git command that runs meanwhile.
    git(changes --no-optional-locks status --porcelain --untracked-files=no)
    set(version ${base})
    if(NOT count EQUAL 0)
        string(APPEND version +${count}.g${commit})
    endif()
    if(changes AND count EQUAL 0)
        string(APPEND version +changed)
    elseif(changes)
        string(APPEND version .changed)
    endif()
    set(${result} ${version} PARENT_SCOPE)
endfunction()

if(DEFINED OUTPUT)
    include(${CMAKE_CURRENT_LIST_DIR}/RenderingCode.cmake)
    stromboli_git_version(${SOURCE} ${BASE} version)
    stromboli_rendering_code(${SOURCE} "${TOOLS}" rendering_code)
    configure_file(${INPUT} ${OUTPUT} @ONLY) # leaves a file alone that would not change
endif()
