# stromboli_rendering_code(source tools result): 16 hexadecimal digits that differ where the code
# differs that makes a sample of a scene in memory: the files below, and the tools (their names and
# versions, in words) that translate it. Documents, tests, loaders, and what prints and writes leave
# it alone: what a loader made of a file is compared by itself (host/checkpoint/scene_identity.hpp).

function(stromboli_rendering_code source tools result)
    set(patterns)
    foreach(folder shaders host/bvh host/core host/film host/kernel host/reference host/render
                   host/vulkan scene/camera scene/model)
        foreach(kind *.cpp *.hpp *.h *.glsl *.comp CMakeLists.txt)
            list(APPEND patterns ${source}/${folder}/${kind})
        endforeach()
    endforeach()
    file(GLOB_RECURSE files RELATIVE ${source} ${patterns})
    list(APPEND files cmake/StromboliTargets.cmake cmake/EmbedSpirv.cmake)
    list(SORT files)
    set(sums "${tools}")
    foreach(file IN LISTS files)
        if(EXISTS ${source}/${file})
            file(SHA256 ${source}/${file} sum)
            string(APPEND sums "\n${file} ${sum}")
        endif()
    endforeach()
    string(SHA256 all "${sums}")
    string(SUBSTRING ${all} 0 16 all)
    set(${result} ${all} PARENT_SCOPE)
endfunction()
