# cmake -DSPIRV=x.spv -DNAME=x -DHEADER=x.h -P EmbedSpirv.cmake
# Writes a header with the module as an array of 32-bit words.
file(READ ${SPIRV} bytes HEX)
string(REGEX REPLACE "(..)(..)(..)(..)" "0x\\4\\3\\2\\1," words "${bytes}")
string(REGEX REPLACE "((0x........,)(0x........,)(0x........,)(0x........,))" "\\1\n" words "${words}")
file(WRITE ${HEADER} "#pragma once\n#include <cstdint>\nconst uint32_t ${NAME}[] = {\n${words}};\n")
