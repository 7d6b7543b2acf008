#include "scene/pbrt/statement_reader.hpp"

#include "scene/build/gunzip.hpp"
#include "scene/build/number_word.hpp"
#include "scene/build/read_file.hpp"
#include "scene/build/tolerate.hpp"
#include "scene/build/unicode.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace stromboli::pbrt {
namespace {

/// What follows a directive: so many strings, so many numbers, and parameters or none.
struct Directive {
    std::string_view name;
    size_t strings = 0, numbers = 0;
    bool hasParameters = false;
};

constexpr Directive kDirectives[] = {
    {"Accelerator", 1, 0, true},
    {"ActiveTransform", 1},
    {"AreaLightSource", 1, 0, true},
    {"Attribute", 1, 0, true},
    {"AttributeBegin"},
    {"AttributeEnd"},
    {"Camera", 1, 0, true},
    {"ColorSpace", 1},
    {"ConcatTransform", 0, 16},
    {"CoordSysTransform", 1},
    {"CoordinateSystem", 1},
    {"Film", 1, 0, true},
    {"Identity"},
    {"Import", 1},
    {"Include", 1},
    {"Integrator", 1, 0, true},
    {"LightSource", 1, 0, true},
    {"LookAt", 0, 9},
    {"MakeNamedMaterial", 1, 0, true},
    {"MakeNamedMedium", 1, 0, true},
    {"Material", 1, 0, true},
    {"MediumInterface", 2},
    {"NamedMaterial", 1},
    {"ObjectBegin", 1},
    {"ObjectEnd"},
    {"ObjectInstance", 1},
    {"Option", 0, 0, true},
    {"PixelFilter", 1, 0, true},
    {"Renderer", 1, 0, true},
    {"ReverseOrientation"},
    {"Rotate", 0, 4},
    {"Sampler", 1, 0, true},
    {"Scale", 0, 3},
    {"Shape", 1, 0, true},
    {"SurfaceIntegrator", 1, 0, true},
    {"Texture", 3, 0, true},
    {"Transform", 0, 16},
    {"TransformBegin"},
    {"TransformEnd"},
    {"TransformTimes", 0, 2},
    {"Translate", 0, 3},
    {"Volume", 1, 0, true},
    {"VolumeIntegrator", 1, 0, true},
    {"WorldBegin"},
    {"WorldEnd"},
};

const Directive* directive(std::string_view word) {
    const auto* found = std::ranges::find(kDirectives, word, &Directive::name);
    return found == std::end(kDirectives) ? nullptr : found;
}

constexpr size_t kMostLevels = 32, kMostIncludes = 10'000;

std::string shortened(std::string_view text) {
    return std::string(text.substr(0, 40));
}

/// Up to what begins the next statement.
void skipStatement(Tokens& tokens) {
    while (tokens.peek().kind != Token::Kind::End &&
           !(tokens.peek().kind == Token::Kind::Word && directive(tokens.peek().text)))
        tokens.take();
}

} // namespace

bool isDirective(std::string_view word) {
    return directive(word) != nullptr;
}

std::vector<Statement> StatementReader::read(const std::filesystem::path& file) {
    readFile(file, 0);
    return std::move(statements_);
}

void StatementReader::readFile(const std::filesystem::path& file, size_t depth) {
    const std::optional<std::string> text =
        build::textInUtf8(build::gunzipped(build::readFile(file), file.string()));
    if (!text) build::FilePlace{file.string(), 0, ""}.fail("begins as UTF-16, but is none");
    open_.push_back(file);
    readText(file.string(), *text, depth);
    open_.pop_back();
}

void StatementReader::readText(const std::string& file, std::string_view text, size_t depth) {
    Tokens tokens(text);
    tokens.begin();
    while (tokens.peek().kind != Token::Kind::End)
        if (!build::tolerate(report_, build::Shortfall::Node,
                             [&] { readStatement(file, tokens, depth); }))
            skipStatement(tokens);
}

void StatementReader::readStatement(const std::string& file, Tokens& tokens, size_t depth) {
    const Token first = tokens.take();
    Statement statement;
    statement.place = {file, first.line, ""};
    const Directive* kind = first.kind == Token::Kind::Word ? directive(first.text) : nullptr;
    if (!kind) statement.place.fail(fmt::format("'{}' is no directive", shortened(first.text)));
    statement.place.element = kind->name;
    for (size_t i = 0; i < kind->strings; ++i) {
        const Token& token = tokens.peek();
        // ActiveTransform has a word without quotes; one medium may stand for both sides.
        const bool isWord = kind->name == "ActiveTransform" && token.kind == Token::Kind::Word;
        if (token.kind != Token::Kind::String && !isWord) {
            if (kind->name == "MediumInterface" && i == 1) break;
            statement.place.fail(
                fmt::format("has '{}', expected a name in quotes", shortened(token.text)));
        }
        statement.words.emplace_back(tokens.take().text);
    }
    readNumbers(tokens, kind->numbers, statement);
    while (kind->hasParameters && tokens.peek().kind == Token::Kind::String)
        readParameter(tokens, statement);
    if (kind->name == "Include" || kind->name == "Import")
        include(statement, depth);
    else
        statements_.push_back(std::move(statement));
}

void StatementReader::readNumbers(Tokens& tokens, size_t count, Statement& statement) {
    const bool isListed = count > 0 && tokens.peek().kind == Token::Kind::Open;
    if (isListed) tokens.take();
    for (size_t i = 0; i < count; ++i) {
        const Token& token = tokens.peek();
        const std::optional<double> number =
            token.kind == Token::Kind::Word ? build::realIn(token.text) : std::nullopt;
        if (!number)
            statement.place.fail(
                fmt::format("has '{}', expected {} numbers", shortened(token.text), count));
        statement.numbers.push_back(*number);
        tokens.take();
    }
    if (!isListed) return;
    if (tokens.peek().kind != Token::Kind::Close)
        statement.place.fail(fmt::format("has more than {} numbers", count));
    tokens.take();
}

/// The type and the name stand in one string. One value may stand without brackets.
void StatementReader::readParameter(Tokens& tokens, Statement& statement) {
    const Token head = tokens.take();
    Parameter parameter;
    parameter.line = head.line;
    build::FilePlace where = statement.place;
    where.line = head.line;
    constexpr std::string_view kBlanks = " \t";
    const size_t type = head.text.find_first_not_of(kBlanks);
    const size_t typeEnd = std::min(head.text.find_first_of(kBlanks, type), head.text.size());
    const size_t name = std::min(head.text.find_first_not_of(kBlanks, typeEnd), head.text.size());
    const size_t nameEnd = std::min(head.text.find_first_of(kBlanks, name), head.text.size());
    if (type != std::string_view::npos) parameter.type = head.text.substr(type, typeEnd - type);
    parameter.name = head.text.substr(name, nameEnd - name);
    if (head.isCutOff || parameter.name.empty())
        where.fail(fmt::format("has \"{}\", expected the type and the name of a parameter",
                               shortened(head.text)));
    if (tokens.peek().kind == Token::Kind::Open) {
        tokens.take();
        while (tokens.peek().kind != Token::Kind::Close) {
            if (tokens.peek().kind == Token::Kind::End)
                where.fail(fmt::format("'{}' has no ']'", parameter.name));
            addValue(tokens.peek(), statement, parameter);
            tokens.take();
        }
        tokens.take();
    } else {
        addValue(tokens.peek(), statement, parameter);
        tokens.take();
    }
    statement.parameters.push_back(std::move(parameter));
}

void StatementReader::addValue(const Token& token, Statement& statement, Parameter& parameter) {
    const bool isWord = token.kind == Token::Kind::Word;
    if (token.kind == Token::Kind::String || token.text == "true" || token.text == "false") {
        parameter.words.emplace_back(token.text);
        return;
    }
    const std::optional<double> number = isWord ? build::anyRealIn(token.text) : std::nullopt;
    if (number) return parameter.numbers.push_back(*number);
    build::FilePlace where = statement.place;
    where.line = token.line;
    where.fail(fmt::format("'{}' has the value '{}', expected a number, a string or a list",
                           parameter.name, shortened(token.text)));
}

void StatementReader::include(const Statement& statement, size_t depth) {
    if (depth + 1 > kMostLevels)
        statement.place.fail(fmt::format("is more than {} files deep", kMostLevels));
    if (++includes_ > kMostIncludes)
        statement.place.fail(fmt::format("is one of more than {} files", kMostIncludes));
    const std::filesystem::path file = files_.find(statement.place, statement.words.front());
    // Two such statements in a file would double it at each level.
    std::error_code failed;
    for (const std::filesystem::path& open : open_)
        if (std::filesystem::equivalent(open, file, failed))
            statement.place.fail(fmt::format("'{}' would include itself", statement.words.front()));
    readFile(file, depth + 1);
}

} // namespace stromboli::pbrt
