#include "host/core/json.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace stromboli {
namespace {

using Library = nlohmann::ordered_json;

Json fromLibrary(const Library& value) {
    switch (value.type()) {
    case Library::value_t::boolean:
        return value.get<bool>();
    case Library::value_t::number_integer:
        return value.get<int64_t>();
    case Library::value_t::number_unsigned:
        return value.get<uint64_t>();
    case Library::value_t::number_float:
        return value.get<double>();
    case Library::value_t::string:
        return value.get_ref<const std::string&>();
    case Library::value_t::array: {
        Json array = Json::array();
        for (const Library& element : value)
            array.push_back(fromLibrary(element));
        return array;
    }
    case Library::value_t::object: {
        Json object = Json::object();
        for (const auto& [name, member] : value.items())
            object[name] = fromLibrary(member);
        return object;
    }
    default:
        return nullptr;
    }
}

/// Makes the library's value of each alternative.
struct ToLibrary {
    Library operator()(const Json::Array& elements) const {
        Library array = Library::array();
        for (const Json& element : elements)
            array.push_back(element.visit(*this));
        return array;
    }
    Library operator()(const Json::Object& members) const {
        Library object = Library::object();
        for (const auto& [name, member] : members)
            object[name] = member.visit(*this);
        return object;
    }
    Library operator()(const auto& plain) const { return plain; }
};

bool isMember(const Json& pair) {
    return pair.isArray() && pair.elements().size() == 2 && pair.elements()[0].isText();
}

} // namespace

Json::Json(std::initializer_list<Json> list) {
    if (!std::all_of(list.begin(), list.end(), isMember)) {
        value_ = Array(list);
        return;
    }
    Object members;
    for (const Json& pair : list)
        members.emplace_back(pair.elements()[0].get<std::string>(), pair.elements()[1]);
    value_ = std::move(members);
}

Json Json::object() {
    Json json;
    json.value_ = Object{};
    return json;
}

const Json::Array& Json::elements() const {
    if (const Array* array = std::get_if<Array>(&value_)) return *array;
    throw JsonError("a value is not an array");
}

const Json* Json::find(std::string_view name) const {
    const Object* members = std::get_if<Object>(&value_);
    if (!members) return nullptr;
    const auto found = std::ranges::find(*members, name,
                                         [](const auto& m) -> std::string_view { return m.first; });
    return found == members->end() ? nullptr : &found->second;
}

const Json& Json::at(std::string_view name) const {
    if (const Json* found = find(name)) return *found;
    throw JsonError("there is no member '" + std::string(name) + "'");
}

Json& Json::operator[](std::string_view name) {
    if (isNull()) value_ = Object{};
    if (const Json* found = find(name)) return const_cast<Json&>(*found);
    if (!isObject()) throw JsonError("a value is not an object");
    return std::get<Object>(value_).emplace_back(std::string(name), nullptr).second;
}

Json& Json::operator[](size_t index) {
    return const_cast<Json&>(elements().at(index));
}

void Json::erase(std::string_view name) {
    if (isObject())
        std::erase_if(std::get<Object>(value_), [&](const auto& m) { return m.first == name; });
}

void Json::push_back(Json element) {
    if (isNull()) value_ = Array{};
    if (!isArray()) throw JsonError("a value is not an array");
    std::get<Array>(value_).push_back(std::move(element));
}

bool Json::flag() const {
    if (const bool* value = std::get_if<bool>(&value_)) return *value;
    throw JsonError("a value is not true or false");
}

const std::string& Json::text() const {
    if (const std::string* value = std::get_if<std::string>(&value_)) return *value;
    throw JsonError("a value is not a text");
}

std::string Json::dump(int indent) const {
    return visit(ToLibrary{}).dump(indent);
}

std::optional<Json> Json::parse(std::istream& text) {
    const Library value = Library::parse(text, nullptr, false);
    if (value.is_discarded()) return std::nullopt;
    return fromLibrary(value);
}

Json Json::parse(std::string_view text, int deepest) {
    const auto lineOf = [&](size_t byte) {
        return 1 + std::count(text.begin(), text.begin() + ptrdiff_t(std::min(byte, text.size())),
                              '\n');
    };
    const auto checkDepth = [&](int depth, Library::parse_event_t event, const Library&) {
        const bool opens = event == Library::parse_event_t::array_start ||
                           event == Library::parse_event_t::object_start;
        if (opens && depth >= deepest) // of the outermost it is 0
            throw JsonError("brackets go deeper than " + std::to_string(deepest) + " levels");
        return true;
    };
    try {
        return fromLibrary(Library::parse(text, checkDepth));
    } catch (const Library::parse_error& error) {
        throw JsonError("its JSON is wrong in line " + std::to_string(lineOf(error.byte)));
    } catch (const Library::exception&) { // numbers beyond the range of double
        throw JsonError("its JSON has a number beyond the range of double");
    }
}

} // namespace stromboli
