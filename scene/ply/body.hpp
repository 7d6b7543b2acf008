#pragma once

#include "host/core/error.hpp"
#include "scene/build/report.hpp"
#include "scene/ply/header.hpp"

#include <cstdint>
#include <string>
#include <string_view>

namespace stromboli::ply {

/// The file ends before all that its header promises: what there is may be shown.
class Truncated : public SceneError {
  public:
    explicit Truncated(const SceneError& error) : SceneError(error) {}
};

/// Takes the numbers of a file's elements one after the other.
class Body {
  public:
    /// `file`, `bytes`, `header` and `report` must outlive the body.
    Body(const std::string& file, std::string_view bytes, const Header& header,
         build::Report& report)
        : file_(file), bytes_(bytes), encoding_(header.encoding), report_(report), at_(header.end),
          line_(header.lines + 1) {}

    /// Before the first element of a kind: throws Truncated if the bytes that are left cannot hold
    /// as many as the header says, so that memory can be taken for them.
    void begin(const Element& kind);
    /// How many of a kind the bytes that are left may hold at most.
    uint64_t mostOf(const Element& kind) const;
    /// Before and after each one.
    void beginElement(uint64_t number);
    void endElement();

    /// NaN and infinity are returned as they are. Throws Truncated at the end of the file, as the
    /// others do.
    double number(ScalarType type);
    /// The length of a list, of which the bytes that are left can hold as many elements.
    uint64_t listLength(const Property& property);
    void skip(const Property& property);

    [[noreturn]] void fail(const std::string& message) const { place().fail(message); }
    build::FilePlace place() const;

  private:
    [[noreturn]] void failAtEnd(const std::string& message) const;
    uint64_t bytesLeft() const { return bytes_.size() - at_; }
    std::string_view word();
    double textNumber();
    double binaryNumber(ScalarType type);

    const std::string& file_;
    std::string_view bytes_;
    Encoding encoding_;
    build::Report& report_;
    size_t at_;
    int line_; ///< that the next byte is on; of ASCII files
    const Element* kind_ = nullptr;
    uint64_t number_ = 0; ///< of the present element
};

} // namespace stromboli::ply
