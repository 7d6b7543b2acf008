#include "python/values.hpp"

#include "host/api/picture_session.hpp"
#include "host/core/error.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace stromboli::python {

api::Value valueOf(const py::handle& object) {
    if (py::isinstance<py::str>(object)) return object.cast<std::string>();
    const Doubles numbers = Doubles::ensure(object);
    if (!numbers)
        throw UsageError("expected a word or numbers, not " + py::repr(object).cast<std::string>());
    return std::vector<double>(numbers.data(), numbers.data() + numbers.size());
}

DeviceRequest deviceOf(const py::dict& settings) {
    DeviceRequest request;
    forEach(settings, [&](const std::string& name, const api::Value& value) {
        api::setDevice(request, name, value);
    });
    return request;
}

RenderRequest requestOf(const py::dict& settings) {
    api::PictureSettings all;
    forEach(settings,
            [&](const std::string& name, const api::Value& value) { all.set(name, value); });
    return all.request();
}

py::dict dictOf(const std::vector<api::NamedThing>& names) {
    py::dict result;
    for (const api::NamedThing& thing : names)
        result[py::str(thing.name)] = thing.meaning;
    return result;
}

py::object objectOf(const Json& json) {
    return py::module_::import("json").attr("loads")(json.dump());
}

py::dict channelsOf(const FloatImage& image) {
    py::dict result;
    for (const auto& [name, values] : image.channels) {
        Floats array({py::ssize_t(image.height), py::ssize_t(image.width)});
        std::copy(values.begin(), values.end(), array.mutable_data());
        result[py::str(name)] = array;
    }
    return result;
}

FloatImage imageOf(const py::dict& channels, uint32_t branches) {
    FloatImage image;
    for (const auto& [name, values] : channels) {
        const Floats array = Floats::ensure(values);
        if (!array || array.ndim() != 2)
            throw UsageError("a channel of a picture is an array of height x width numbers");
        const auto height = uint32_t(array.shape(0)), width = uint32_t(array.shape(1));
        if (image.channels.empty()) image = FloatImage(width, height);
        if (width != image.width || height != image.height)
            throw UsageError("the channels of a picture have different sizes");
        image.channel(name.cast<std::string>()).assign(array.data(), array.data() + array.size());
    }
    if (image.channels.empty() || image.width == 0 || image.height == 0)
        throw UsageError("a picture without pixels");
    image.branches = branches;
    return image;
}

py::object noiseOf(const PictureNoise& noise) {
    if (!noise.known()) return py::none();
    return py::make_tuple(noise.estimate, noise.least, noise.most);
}

} // namespace stromboli::python
