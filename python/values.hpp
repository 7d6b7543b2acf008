#pragma once

#include "host/api/named_settings.hpp"
#include "host/core/json.hpp"
#include "host/engine/render_request.hpp"
#include "host/film/image.hpp"
#include "host/render/picture_noise.hpp"

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace py = pybind11;

namespace stromboli::python {

// --- Values --------------------------------------------------------------------------------------

using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Floats = py::array_t<float, py::array::c_style | py::array::forcecast>;
using Bytes = py::array_t<uint8_t, py::array::c_style | py::array::forcecast>;
using Indices = py::array_t<uint32_t, py::array::c_style | py::array::forcecast>;

template <class Array>
auto spanOf(const Array& array) {
    return std::span(array.data(), size_t(array.size()));
}

/// Words and numbers as they are, yes and no as 1 and 0, and whatever numpy makes numbers of.
/// Throws UsageError for all else.
api::Value valueOf(const py::handle& object);

template <class Set>
void forEach(const py::dict& settings, const Set& set) {
    for (const auto& [name, value] : settings)
        set(py::cast<std::string>(name), valueOf(value));
}

DeviceRequest deviceOf(const py::dict& settings);
RenderRequest requestOf(const py::dict& settings);
py::dict dictOf(const std::vector<api::NamedThing>& names);
py::object objectOf(const Json& json);

// --- Pictures ------------------------------------------------------------------------------------

/// Arrays of height x width numbers, by the channels' names.
py::dict channelsOf(const FloatImage& image);
/// Throws UsageError for a picture without pixels, or of channels of different sizes.
FloatImage imageOf(const py::dict& channels, uint32_t branches);
/// The estimate and its range; None where it is not known.
py::object noiseOf(const PictureNoise& noise);

} // namespace stromboli::python
