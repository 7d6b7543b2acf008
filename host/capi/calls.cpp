// What all functions of the C API have in common: no exception leaves them.
#include "host/capi/calls.hpp"

#include "host/version/version.hpp"

#include <algorithm>
#include <cstring>

namespace stromboli::capi {

stromboli_code codeOf(ErrorKind kind) {
    switch (kind) {
    case ErrorKind::Usage:
        return STROMBOLI_ERROR_USAGE;
    case ErrorKind::Scene:
        return STROMBOLI_ERROR_SCENE;
    case ErrorKind::Device:
        return STROMBOLI_ERROR_DEVICE;
    case ErrorKind::DeviceLost:
        return STROMBOLI_ERROR_DEVICE_LOST;
    case ErrorKind::Output:
        return STROMBOLI_ERROR_OUTPUT;
    }
    return STROMBOLI_ERROR_INTERNAL;
}

void copyText(std::string_view text, char* to, size_t bytes) {
    if (bytes == 0) return;
    size_t length = std::min(text.size(), bytes - 1);
    if (length < text.size())
        while (length > 0 && (static_cast<unsigned char>(text[length]) & 0xC0) == 0x80)
            --length;
    std::memcpy(to, text.data(), length);
    to[length] = 0;
}

stromboli_code fail(stromboli_error* error, stromboli_code code, const char* message) {
    if (error) {
        error->code = code;
        copyText(message, error->message, sizeof error->message);
    }
    return code;
}

std::string textOf(const char* text, const char* what) {
    return &there(text, what);
}

std::vector<double> numbersOf(const double* values, size_t count) {
    if (count > 0) there(values, "values");
    return {values, values + count};
}

glm::dvec3 vectorOf(const double* values, const char* what) {
    there(values, what);
    return {values[0], values[1], values[2]};
}

} // namespace stromboli::capi

// --- Versions ------------------------------------------------------------------------------------

int32_t stromboli_version(void) {
    return STROMBOLI_VERSION;
}

const char* stromboli_version_text(void) {
    return stromboli::version();
}
