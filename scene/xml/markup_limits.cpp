#include "scene/xml/markup_limits.hpp"

#include "host/core/error.hpp"
#include "scene/build/read_file.hpp"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace stromboli::xml {
namespace {

/// The parser compares the name of every attribute with those of all others of its element. The
/// standard gives no element more than a dozen; with a thousand a comparison by pairs still takes
/// less than a hundredth of a second.
constexpr size_t kMostAttributes = 1000;

class Scanner {
  public:
    Scanner(const std::string& name, std::string_view text) : name_(name), text_(text) {}

    void run() {
        for (at_ = text_.find('<'); at_ < text_.size(); at_ = text_.find('<', at_)) {
            if (!skipped("<!--", "-->") && !skipped("<![CDATA[", "]]>") && !skipped("<?", "?>"))
                readTag();
        }
    }

    /// What there is at least once it is parsed: the text twice, once of which is ours, and an
    /// object for each element and each attribute.
    uint64_t bytesToParse() const {
        return 2 * uint64_t(text_.size()) + elements_ * sizeof(tinyxml2::XMLElement) +
               attributes_ * sizeof(tinyxml2::XMLAttribute);
    }

  private:
    /// If `begin` stands here, goes behind the next `end` and is true.
    bool skipped(std::string_view begin, std::string_view end) {
        if (!text_.substr(at_).starts_with(begin)) return false;
        const size_t found = text_.find(end, at_ + begin.size());
        at_ = found == std::string_view::npos ? text_.size() : found + end.size();
        return true;
    }

    /// Goes behind a tag. Each of its attributes has an equals sign outside of quotes.
    void readTag() {
        const size_t start = at_;
        size_t attributes = 0;
        if (!text_.substr(at_).starts_with("</")) ++elements_;
        for (++at_; at_ < text_.size() && text_[at_] != '>'; ++at_) {
            const char c = text_[at_];
            if (c == '<') break; // not well-formed, which the parser will say
            if (c == '=' && ++attributes > kMostAttributes) fail(start);
            if (c == '"' || c == '\'') at_ = std::min(text_.find(c, at_ + 1), text_.size() - 1);
        }
        attributes_ += attributes;
    }

    [[noreturn]] void fail(size_t tag) const {
        const auto lines = std::count(text_.begin(), text_.begin() + std::ptrdiff_t(tag), '\n');
        const size_t end = std::min(text_.find_first_of(" \t\r\n/>=", tag + 1), tag + 41);
        throw SceneError(name_, int(lines) + 1, std::string(text_.substr(tag + 1, end - tag - 1)),
                         fmt::format("has more than {} attributes", kMostAttributes));
    }

    const std::string& name_;
    std::string_view text_;
    size_t at_ = 0;
    uint64_t elements_ = 0, attributes_ = 0;
};

} // namespace

void checkMarkupLimits(const std::string& name, std::string_view text) {
    Scanner scanner(name, text);
    scanner.run();
    build::requireMemory(name, scanner.bytesToParse());
}

} // namespace stromboli::xml
