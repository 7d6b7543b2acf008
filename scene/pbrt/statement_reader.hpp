#pragma once

#include "scene/build/report.hpp"
#include "scene/pbrt/files.hpp"
#include "scene/pbrt/statement.hpp"
#include "scene/pbrt/tokens.hpp"

#include <filesystem>
#include <string_view>
#include <vector>

namespace stromboli::pbrt {

/// True for the name of a directive of pbrt-v3 or pbrt-v4.
bool isDirective(std::string_view word);

/// Reads the statements of a file and of those that it includes, which take the place of Include
/// and Import. What is wrong in a statement costs that statement.
class StatementReader {
  public:
    StatementReader(const Files& files, build::Report& report) : files_(files), report_(report) {}

    /// Throws SceneError if the file cannot be read.
    std::vector<Statement> read(const std::filesystem::path& file);

  private:
    void readFile(const std::filesystem::path& file, size_t depth);
    void readText(const std::string& file, std::string_view text, size_t depth);
    void readStatement(const std::string& file, Tokens& tokens, size_t depth);
    void readNumbers(Tokens& tokens, size_t count, Statement& statement);
    void readParameter(Tokens& tokens, Statement& statement);
    static void addValue(const Token& token, Statement& statement, Parameter& parameter);
    void include(const Statement& statement, size_t depth);

    const Files& files_;
    build::Report& report_;
    std::vector<Statement> statements_;
    std::vector<std::filesystem::path> open_; ///< each included by the one before
    size_t includes_ = 0;
};

} // namespace stromboli::pbrt
