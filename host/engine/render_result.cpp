#include "host/engine/render_result.hpp"

#include "host/film/shown_film.hpp"

namespace stromboli {

void count(const Film& film, const RenderSettings& settings, RenderResult& r) {
    for (uint32_t i = 0; i < film.pixels.size(); ++i) {
        const PixelStatistics& p = film.pixels[i];
        r.samplesTaken += uint64_t(p.taken()) * settings.estimator.branches;
        r.samplesRejected += p.rejected;
        if (p.rejected == 0 || r.firstRejected) continue;
        const PixelPlace place = film.area.placeOf(i);
        r.firstRejected = SampleName{place.x, place.y, p.firstRejected};
    }
    r.pixelsUnreached += unreachedPixels(film);
}

} // namespace stromboli
