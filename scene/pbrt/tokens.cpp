#include "scene/pbrt/tokens.hpp"

#include <algorithm>

namespace stromboli::pbrt {
namespace {

bool isBlank(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\f' || c == '\v' || c == '\0';
}

bool endsWord(char c) {
    return isBlank(c) || c == '"' || c == '[' || c == ']' || c == '#';
}

} // namespace

void Tokens::skipBlanks() {
    while (!rest_.empty()) {
        if (rest_.front() == '#') {
            rest_.remove_prefix(std::min(rest_.find('\n'), rest_.size()));
        } else if (isBlank(rest_.front())) {
            if (rest_.front() == '\n') ++line_;
            rest_.remove_prefix(1);
        } else {
            return;
        }
    }
}

Token Tokens::take() {
    const Token taken = next_;
    skipBlanks();
    next_ = {Token::Kind::End, {}, line_, false};
    if (rest_.empty()) return taken;
    const char first = rest_.front();
    size_t length = 1, skipped = 0;
    if (first == '[' || first == ']') {
        next_.kind = first == '[' ? Token::Kind::Open : Token::Kind::Close;
        next_.text = rest_.substr(0, 1);
    } else if (first == '"') {
        const size_t end = std::min(rest_.find_first_of("\"\n", 1), rest_.size());
        next_.kind = Token::Kind::String;
        next_.text = rest_.substr(1, end - 1);
        next_.isCutOff = end == rest_.size() || rest_[end] == '\n';
        length = end;
        skipped = next_.isCutOff ? 0 : 1;
    } else {
        length = size_t(std::ranges::find_if(rest_, endsWord) - rest_.begin());
        next_.kind = Token::Kind::Word;
        next_.text = rest_.substr(0, length);
    }
    rest_.remove_prefix(length + skipped);
    return taken;
}

} // namespace stromboli::pbrt
