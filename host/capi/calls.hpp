#pragma once

#include "stromboli/stromboli.h"

#include "host/core/error.hpp"

#include <glm/glm.hpp>

#include <cstddef>
#include <exception>
#include <new>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace stromboli::capi {

// --- Errors --------------------------------------------------------------------------------------

stromboli_code codeOf(ErrorKind kind);
/// Copies what there is room for, without cutting a UTF-8 character in two, and ends it with 0.
void copyText(std::string_view text, char* to, size_t bytes);
/// Tells of a failure where `error` leads somewhere. Returns the code.
stromboli_code fail(stromboli_error* error, stromboli_code code, const char* message);

/// Runs what a function of the API does.
template <class Work>
stromboli_code guarded(stromboli_error* error, const Work& work) noexcept {
    try {
        work();
        return STROMBOLI_OK;
    } catch (const Error& e) {
        return fail(error, codeOf(e.kind()), e.what());
    } catch (const std::bad_alloc&) {
        return fail(error, STROMBOLI_ERROR_MEMORY, "there is not enough memory");
    } catch (const std::exception& e) {
        return fail(error, STROMBOLI_ERROR_INTERNAL, e.what());
    } catch (...) {
        return fail(error, STROMBOLI_ERROR_INTERNAL, "an unknown error");
    }
}

// --- Arguments -----------------------------------------------------------------------------------

/// Throws UsageError if a pointer that has to lead somewhere does not.
template <class T>
T& there(T* pointer, const char* what) {
    if (!pointer) throw UsageError(std::string(what) + " is NULL");
    return *pointer;
}

std::string textOf(const char* text, const char* what);
std::vector<double> numbersOf(const double* values, size_t count);
glm::dvec3 vectorOf(const double* values, const char* what);

template <class T>
std::span<const T> spanOf(const T* values, size_t count) {
    return values ? std::span(values, count) : std::span<const T>();
}

} // namespace stromboli::capi
