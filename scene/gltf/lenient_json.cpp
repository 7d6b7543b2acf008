#include "scene/gltf/lenient_json.hpp"

#include <algorithm>
#include <cctype>

namespace stromboli::gltf {
namespace {

bool isWordLetter(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '+' || c == '-' || c == '.';
}

bool isNoNumber(std::string_view word) {
    std::string small(word);
    std::ranges::transform(small, small.begin(), [](char c) {
        return char(std::tolower(static_cast<unsigned char>(c)));
    });
    std::string_view rest = small;
    if (rest.starts_with('-') || rest.starts_with('+')) rest.remove_prefix(1);
    return rest == "nan" || rest == "inf" || rest == "infinity";
}

class Corrector {
  public:
    explicit Corrector(std::string_view text) : text_(text) {}

    std::string run() {
        result_.reserve(text_.size());
        while (at_ < text_.size()) {
            const char c = text_[at_];
            if (c == '"')
                copyString();
            else if (text_.substr(at_, 2) == "//")
                skip(std::min(text_.find('\n', at_), text_.size()));
            else if (text_.substr(at_, 2) == "/*")
                skip(std::min(text_.find("*/", at_ + 2), text_.size() - 2) + 2);
            else if (isWordLetter(c))
                copyWord();
            else
                copyMark(c);
        }
        return std::move(result_);
    }

  private:
    void copyString() {
        const size_t begin = at_++;
        while (at_ < text_.size() && text_[at_] != '"')
            at_ += text_[at_] == '\\' ? 2 : 1;
        at_ = std::min(at_ + 1, text_.size());
        put(text_.substr(begin, at_ - begin));
    }

    void copyWord() {
        const size_t begin = at_;
        while (at_ < text_.size() && isWordLetter(text_[at_]))
            ++at_;
        const std::string_view word = text_.substr(begin, at_ - begin);
        put(isNoNumber(word) ? "null" : word);
    }

    void copyMark(char c) {
        ++at_;
        if ((c == ']' || c == '}') && comma_ != std::string::npos) result_[comma_] = ' ';
        if (c == ',') {
            result_ += c;
            comma_ = result_.size() - 1;
        } else if (c == ' ' || c == '\t' || c == '\n' || c == '\r') {
            result_ += c;
        } else {
            put({&c, 1});
        }
    }

    /// Line breaks stay, so that messages name the lines of the file.
    void skip(size_t end) {
        for (; at_ < end; ++at_)
            result_ += text_[at_] == '\n' ? '\n' : ' ';
    }

    void put(std::string_view part) {
        result_ += part;
        comma_ = std::string::npos;
    }

    std::string_view text_;
    size_t at_ = 0;
    std::string result_;
    size_t comma_ = std::string::npos; ///< the last one in the result, if only blanks follow it
};

} // namespace

std::string correctedJson(std::string_view text) {
    return Corrector(text).run();
}

} // namespace stromboli::gltf
