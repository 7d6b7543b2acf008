#pragma once

#include <concepts>
#include <cstdint>
#include <initializer_list>
#include <istream>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace stromboli {

/// A JSON value that is not what the reader expects.
class JsonError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// A JSON value in memory. Members of objects keep the order in which they were added. Text is
/// written and read by nlohmann/json, whose headers, which are slow to compile, are in json.cpp
/// alone.
class Json {
  public:
    using Array = std::vector<Json>;
    using Object = std::vector<std::pair<std::string, Json>>;

    Json(std::nullptr_t = nullptr) {}
    Json(bool value) : value_(value) {}
    template <std::floating_point T>
    Json(T value) : value_(double(value)) {}
    template <std::signed_integral T>
    Json(T value) {
        if (value >= 0)
            value_ = uint64_t(value);
        else
            value_ = int64_t(value);
    }
    template <std::unsigned_integral T>
    requires(!std::same_as<T, bool>) Json(T value) : value_(uint64_t(value)) {}
    Json(const char* text) : value_(std::string(text)) {}
    Json(std::string_view text) : value_(std::string(text)) {}
    Json(std::string text) : value_(std::move(text)) {}
    /// An array of the elements of a container.
    template <class Container>
    requires requires(const Container& c) {
        Json(*std::begin(c));
    } &&(!std::convertible_to<const Container&, std::string_view>)Json(const Container& elements)
        : value_(Array(std::begin(elements), std::end(elements))) {
    }
    /// An object of the elements of a map.
    template <class T>
    Json(const std::map<std::string, T>& members)
        : value_(Object(members.begin(), members.end())) {}
    /// `{{"name", value}, ...}` is an object, any other list an array.
    Json(std::initializer_list<Json> list);

    static Json array() { return Json(Array{}); }
    static Json object();

    bool isNull() const { return std::holds_alternative<std::nullptr_t>(value_); }
    bool isText() const { return std::holds_alternative<std::string>(value_); }
    bool isArray() const { return std::holds_alternative<Array>(value_); }
    bool isObject() const { return std::holds_alternative<Object>(value_); }

    /// The elements of an array; throws JsonError if it is none.
    const Array& elements() const;
    /// The value as a bool, a number or a std::string; throws JsonError if it is of another kind.
    template <class T>
    T get() const {
        if constexpr (std::same_as<T, bool>)
            return flag();
        else if constexpr (std::is_arithmetic_v<T>)
            return T(number<T>());
        else
            return text();
    }

    /// The member of an object; throws JsonError if there is none.
    const Json& at(std::string_view name) const;
    /// The member of an object, or `otherwise` if there is none.
    template <class T>
    T value(std::string_view name, T otherwise) const {
        const Json* found = find(name);
        return found ? found->get<T>() : otherwise;
    }
    /// The member of an object, added if need be; null becomes an object.
    Json& operator[](std::string_view name);
    Json& operator[](const char* name) { return (*this)[std::string_view(name)]; }
    /// The element of an array.
    Json& operator[](size_t index);
    /// Removes the member of an object, if it is there.
    void erase(std::string_view name);
    /// Adds to an array; null becomes one.
    void push_back(Json element);

    /// Calls the visitor with what the value is: nullptr, a bool, an int64_t (below 0), a uint64_t,
    /// a double, a std::string, an Array or an Object.
    auto visit(const auto& visitor) const { return std::visit(visitor, value_); }

    friend bool operator==(const Json&, const Json&) = default;

    /// The text, without a line break at its end; on one line unless `indent` spaces are asked
    /// for. Numbers that are not finite become null.
    std::string dump(int indent = -1) const;
    /// What the text means; nothing if it is not JSON.
    static std::optional<Json> parse(std::istream& text);
    /// The value that a text from elsewhere states; throws JsonError, with the line of what is
    /// wrong, also where brackets within each other go deeper than `deepest`.
    static Json parse(std::string_view text, int deepest);

  private:
    explicit Json(Array elements) : value_(std::move(elements)) {}

    const Json* find(std::string_view name) const;
    bool flag() const;
    const std::string& text() const;
    template <class T>
    T number() const {
        if (const auto* u = std::get_if<uint64_t>(&value_)) return T(*u);
        if (const auto* i = std::get_if<int64_t>(&value_)) return T(*i);
        if (const auto* d = std::get_if<double>(&value_)) return T(*d);
        throw JsonError("a value is not a number");
    }

    std::variant<std::nullptr_t, bool, int64_t, uint64_t, double, std::string, Array, Object>
        value_ = nullptr;
};

} // namespace stromboli
