# cmake -DINPUT=file -DOUTPUT=header.h -DNAME=identifier -P EmbedText.cmake
# Writes the bytes of a file as a C++ array. A string literal would be shorter to write, but
# compilers need not take one of more than 65,536 characters.
file(READ ${INPUT} bytes HEX)
string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${bytes}")
string(REGEX REPLACE "(................................................................................)"
       "\\1\n" bytes "${bytes}")
file(WRITE ${OUTPUT} "inline constexpr unsigned char ${NAME}[] = {\n${bytes}\n};\n")
