#include "scene/build/gunzip.hpp"

#include "host/core/error.hpp"
#include "scene/build/read_file.hpp"

#include <zlib.h>

#include <algorithm>
#include <memory>

namespace stromboli::build {

std::string gunzipped(std::string bytes, const std::string& file) {
    if (!bytes.starts_with("\x1f\x8b")) return bytes;
    z_stream stream{};
    constexpr int kGzip = 16 + MAX_WBITS;
    if (inflateInit2(&stream, kGzip) != Z_OK) throw SceneError(file, 0, "", "zlib does not start");
    const std::unique_ptr<z_stream, int (*)(z_stream*)> end(&stream, inflateEnd);
    std::string text;
    constexpr size_t kStep = size_t(1) << 20, kMostInput = size_t(1) << 30;
    std::string step(kStep, '\0');
    size_t given = 0;
    for (int state = Z_OK; state != Z_STREAM_END;) {
        if (stream.avail_in == 0) {
            const size_t more = std::min(bytes.size() - given, kMostInput);
            stream.next_in = reinterpret_cast<Bytef*>(bytes.data() + given);
            stream.avail_in = uInt(more);
            given += more;
        }
        stream.next_out = reinterpret_cast<Bytef*>(step.data());
        stream.avail_out = uInt(kStep);
        state = inflate(&stream, Z_NO_FLUSH);
        if (state != Z_OK && state != Z_STREAM_END)
            throw SceneError(file, 0, "", "is packed by gzip, and damaged");
        text.append(step, 0, kStep - stream.avail_out);
        requireMemory(file, text.size() * 2);
    }
    return text;
}

} // namespace stromboli::build
