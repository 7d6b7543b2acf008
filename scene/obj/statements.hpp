#pragma once

#include "scene/build/file_place.hpp"

#include <optional>
#include <string>
#include <string_view>

namespace stromboli::obj {

/// Takes words off the beginning of a text; white space separates them.
class Words {
  public:
    explicit Words(std::string_view text) : rest_(text) { skipSpace(); }

    bool atEnd() const { return rest_.empty(); }
    std::string_view next(); ///< empty at the end
    /// What has not been taken, without white space around it.
    std::string_view rest() const { return rest_; }

  private:
    void skipSpace();
    std::string_view rest_;
};

/// The statements of an OBJ or MTL file: a keyword and what follows it on its line, which a
/// backslash at the end continues on the next one. Empty lines and comments are no statements, but
/// those of kPaintKeyword are.
class Statements {
  public:
    /// `text` is UTF-8, or anything with ASCII in it, or UTF-16. Throws SceneError if it is damaged
    /// UTF-16.
    Statements(std::string file, std::string text);

    /// Goes to the next statement; false at the end.
    bool next();

    std::string_view keyword() const { return keyword_; }
    /// The whole rest of the line: names may contain spaces and '#'.
    std::string_view rest() const { return rest_; }
    /// The rest of the line up to a comment, for statements of numbers.
    /// A '#' within a word is none: programs write 1.#IND for what is no number.
    std::string_view values() const;
    int line() const { return line_; }
    build::FilePlace place() const { return {file_, line_, std::string(keyword_.substr(0, 40))}; }
    [[noreturn]] void fail(const std::string& message) const { place().fail(message); }

    /// The next word as a finite number; throws SceneError if it is none.
    double number(Words& words) const;
    /// The next word as a number, or NaN where it says so.
    double numberOrNan(Words& words) const;

  private:
    std::string_view physicalLine();

    std::string file_, text_, joined_;
    size_t at_ = 0;
    int nextLine_ = 1, line_ = 0;
    std::string_view keyword_, rest_;
};

/// A comment to other programs, in which ZBrush writes colours of vertices.
inline constexpr std::string_view kPaintKeyword = "#MRGB";

/// Keywords and names in the letters by which they are compared.
std::string inSmallLetters(std::string_view text);

/// True for the keywords of the format, those that are not read included.
bool isObjKeyword(std::string_view keyword);

/// A word of a file as messages quote it: no longer than a line.
std::string shortened(std::string_view word);

} // namespace stromboli::obj
