#pragma once

#include <string_view>

namespace stromboli::pbrt {

/// A word of a file: a string in quotes, a bracket, or anything else between spaces.
struct Token {
    enum class Kind { End, Word, String, Open, Close };
    Kind kind = Kind::End;
    std::string_view text; ///< without quotes
    int line = 0;
    bool isCutOff = false; ///< a string whose end is missing on its line
};

/// Takes the words of a text one after the other. Comments go from # to the end of a line.
class Tokens {
  public:
    /// `text` must outlive the tokens.
    explicit Tokens(std::string_view text) : rest_(text) {}

    const Token& peek() const { return next_; }
    Token take();
    void begin() { take(); }

  private:
    void skipBlanks();

    std::string_view rest_;
    int line_ = 1;
    Token next_;
};

} // namespace stromboli::pbrt
