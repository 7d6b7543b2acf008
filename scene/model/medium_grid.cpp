#include "scene/model/medium_grid.hpp"

#include <algorithm>

namespace stromboli {

template <class Value>
glm::dvec3 Grid<Value>::place(const glm::dvec3& world) const {
    glm::dvec3 p;
    for (int i = 0; i < 3; ++i) {
        const glm::dvec4& row = toUnit[size_t(i)];
        p[i] = glm::dot(glm::dvec3(row), world) + row.w;
    }
    return p;
}

template <class Value>
void Grid<Value>::setWorld(const glm::dmat4& matrix) {
    const glm::dmat4 rows = glm::transpose(glm::inverse(matrix));
    for (int i = 0; i < 3; ++i)
        toUnit[size_t(i)] = rows[i];
}

template <class Value>
typename Grid<Value>::Exact Grid<Value>::at(const glm::dvec3& place) const {
    for (int i = 0; i < 3; ++i)
        if (!(place[i] >= 0 && place[i] <= 1)) return Exact(0.0);
    return goingOn(place);
}

template <class Value>
typename Grid<Value>::Exact Grid<Value>::goingOn(const glm::dvec3& place) const {
    size_t low[3], high[3];
    double part[3];
    for (int i = 0; i < 3; ++i) {
        const double most = size[i] - 1.0;
        const double x = std::clamp(place[i] * size[i] - 0.5, 0.0, most);
        low[i] = size_t(x);
        high[i] = std::min(low[i] + 1, size_t(most));
        part[i] = x - double(low[i]);
    }
    Exact sum(0.0);
    for (unsigned corner = 0; corner < 8; ++corner) {
        size_t at[3];
        double weight = 1;
        for (unsigned i = 0; i < 3; ++i) {
            const bool isHigh = corner >> i & 1;
            at[i] = isHigh ? high[i] : low[i];
            weight *= isHigh ? part[i] : 1 - part[i];
        }
        sum += weight * Exact(values[at[0] + size.x * (at[1] + size_t(size.y) * at[2])]);
    }
    return sum;
}

template <class Value>
Value Grid<Value>::largest() const {
    Value most(0.0f);
    for (const Value& value : values)
        if constexpr (std::is_same_v<Value, float>)
            most = std::max(most, value);
        else
            most = glm::max(most, value);
    return most;
}

template struct Grid<float>;
template struct Grid<glm::vec3>;

DensityGrid largestChannels(const ColorGrid& colors) {
    DensityGrid grid;
    grid.size = colors.size;
    grid.toUnit = colors.toUnit;
    for (const glm::vec3& color : colors.values)
        grid.values.push_back(std::max({color.x, color.y, color.z}));
    return grid;
}

} // namespace stromboli
