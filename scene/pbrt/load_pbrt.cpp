#include "scene/pbrt/load_pbrt.hpp"

#include "host/core/error.hpp"
#include "scene/pbrt/medium_grids.hpp"
#include "scene/pbrt/scene_reader.hpp"
#include "scene/pbrt/statement_reader.hpp"
#include "scene/pbrt/tokens.hpp"

#include <fmt/format.h>

#include <new>
#include <utility>

namespace stromboli {

Scene loadPbrt(const std::filesystem::path& file, const SceneConventions& conventions) try {
    build::SceneBuilder builder(file.string(), conventions);
    const pbrt::Files files(file, builder.report());
    std::vector<pbrt::Statement> statements =
        pbrt::StatementReader(files, builder.report()).read(file);
    const pbrt::VersionFound found = pbrt::versionOf(statements);
    builder.report().assume(
        fmt::format("the scene is one of pbrt-v{}{}", found.version == pbrt::Version::V3 ? 3 : 4,
                    found.sign.empty() ? ": nothing tells which" : ", as by " + found.sign));
    pbrt::Context context{builder, files, found.version};
    pbrt::SceneReader(context).read(std::move(statements));
    Scene scene = builder.finish();
    for (Medium& medium : scene.media)
        pbrt::strengthen(medium, context.imagingRatio);
    return scene;
} catch (const std::bad_alloc&) {
    throw SceneError(file.string(), 0, "", "does not fit in memory");
}

bool looksLikePbrt(std::string_view beginning) {
    pbrt::Tokens tokens(beginning);
    tokens.begin();
    const pbrt::Token first = tokens.take(), second = tokens.take();
    // The words of other formats are not followed by a string, a number or another directive.
    return first.kind == pbrt::Token::Kind::Word && pbrt::isDirective(first.text) &&
           second.kind != pbrt::Token::Kind::End;
}

} // namespace stromboli
