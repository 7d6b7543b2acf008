// Films as files: what comes back, damage, and files that are not finished.
#include "host/core/error.hpp"
#include "tests/farm/films.hpp"
#include "tests/film/temporary_folder.hpp"
#include "tests/support/refusal.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

namespace stromboli {
namespace {

using namespace test;
using testing::HasSubstr;

std::vector<SharedPixel> readAll(const std::filesystem::path& file) {
    FilmReader reader(file);
    std::vector<SharedPixel> all;
    const uint64_t pixels = reader.header().settings.area.pixelCount();
    while (all.size() < pixels) {
        const PackedRun run = reader.next();
        const size_t first = all.size();
        all.resize(first + run.size());
        run.addTo(std::span(all).subspan(first), 0);
    }
    return all;
}

std::string filmRefusal(const std::filesystem::path& file) {
    return test::refusalOf([&] { readAll(file); });
}

TEST(FilmFile, ComesBackAsItWas) {
    const TemporaryFolder folder;
    const FilmHeader header = ofShare(pictureOf(16, 4), {2, 4});
    const std::vector<SharedPixel> pixels = drawBlocks(header, uneven, 1);
    writeFilm(folder / "a.film", header, pixels);
    EXPECT_EQ(toBytes(FilmReader(folder / "a.film").header()), toBytes(header));
    EXPECT_EQ(readAll(folder / "a.film"), pixels);
    EXPECT_EQ(folder.size(), 1u);
}

/// In several runs of pixels, the last one shorter, and whatever parts the pixels come in.
TEST(FilmFile, OfManyRunsComesBackAsItWas) {
    const TemporaryFolder folder;
    FilmHeader header = ofShare(pictureOf(16, 16), {1, 1});
    header.settings.area = {1000, 150, {}};
    std::vector<SharedPixel> pixels(1000 * 150);
    for (uint32_t i = 0; i < pixels.size(); ++i)
        pixels[i].all.count = i, pixels[i].all.sum[1].words[2] = 3 * i;
    FilmWriter writer(folder / "a.film", header);
    writer.add(std::span(pixels).first(1));
    writer.add(std::span(pixels).subspan(1, 100'000));
    EXPECT_THROW(writer.finish(), std::logic_error); // not yet
    writer.add(std::span(pixels).subspan(100'001));
    EXPECT_THROW(writer.add(pixels), std::logic_error);
    writer.finish();
    EXPECT_EQ(readAll(folder / "a.film"), pixels);
}

/// Several runs, and layers of seven channels, which are in the film of the first share only.
TEST(FilmFile, LayersComeBackAsTheyWere) {
    const TemporaryFolder folder;
    FilmHeader picture = pictureOf(16, 4);
    picture.settings.area = {1000, 150, {}};
    picture.layers = {Layer::Normal, Layer::Depth, Layer::Position};
    picture.legend = {{"Objects", "[\"ball\"]"}};
    EXPECT_FALSE(ofShare(picture, {2, 4}).holdsLayers);
    const FilmHeader header = ofShare(picture, {1, 4});
    EXPECT_TRUE(header.holdsLayers);
    const size_t channels = header.layerChannels();
    EXPECT_EQ(channels, 7u);
    const std::vector<SharedPixel> pixels(1000 * 150);
    std::vector<float> layers(pixels.size() * channels);
    for (size_t i = 0; i < layers.size(); ++i)
        layers[i] = float(i) * 0.5f;
    FilmWriter writer(folder / "a.film", header);
    EXPECT_THROW(writer.add(pixels), std::logic_error); // without layers
    writer.add(std::span(pixels).first(77), std::span(layers).first(77 * channels));
    writer.add(std::span(pixels).subspan(77), std::span(layers).subspan(77 * channels));
    writer.finish();
    FilmReader reader(folder / "a.film");
    EXPECT_EQ(reader.header().layers, header.layers);
    EXPECT_EQ(reader.header().legend, header.legend);
    std::vector<float> all, some;
    while (all.size() < layers.size()) {
        const PackedRun run = reader.next();
        reader.nextLayers(some);
        EXPECT_EQ(some.size(), run.size() * channels);
        all.insert(all.end(), some.begin(), some.end());
    }
    EXPECT_EQ(all, layers);
}

TEST(FilmFile, AShareWithoutSamplesIsSmall) {
    const TemporaryFolder folder;
    const FilmHeader header = ofShare(pictureOf(4, 4), {1, 1000});
    EXPECT_TRUE(header.blocks.empty());
    writeFilm(folder / "a.film", header, {});
    EXPECT_LT(std::filesystem::file_size(folder / "a.film"), 1000u);
    EXPECT_EQ(readAll(folder / "a.film"), std::vector<SharedPixel>(kSide * kSide));
}

TEST(FilmFile, WithoutItsEndThereIsNoFile) {
    const TemporaryFolder folder;
    {
        const FilmHeader header = ofShare(pictureOf(4, 4), {1, 1});
        FilmWriter writer(folder / "a.film", header);
        writer.add(std::vector<SharedPixel>(kSide * kSide));
        EXPECT_FALSE(std::filesystem::exists(folder / "a.film"));
    }
    EXPECT_EQ(folder.size(), 0u);
}

TEST(FilmFile, DamageIsSeen) {
    const TemporaryFolder folder;
    const FilmHeader header = ofShare(pictureOf(4, 4), {1, 1});
    writeFilm(folder / "a.film", header, drawBlocks(header, uneven, 1));
    const std::string whole = contentOf(folder / "a.film");
    for (size_t i = 0; i < whole.size(); i += i < 700 ? 1 : 97) {
        std::string damaged = whole;
        damaged[i] = char(damaged[i] ^ 0x10);
        std::ofstream(folder / "b.film", std::ios::binary) << damaged;
        ASSERT_THAT(filmRefusal(folder / "b.film"), HasSubstr("/b.film: ")) << "byte " << i;
    }
    for (size_t size = 0; size < whole.size(); size += 131) {
        std::ofstream(folder / "b.film", std::ios::binary) << whole.substr(0, size);
        ASSERT_THAT(filmRefusal(folder / "b.film"), HasSubstr("/b.film: ")) << size;
    }
}

TEST(FilmFile, SaysWhatIsNoFilm) {
    const TemporaryFolder folder;
    std::ofstream(folder / "a.film") << "not a film at all";
    EXPECT_THAT(filmRefusal(folder / "a.film"), HasSubstr("not a film of this version"));
    EXPECT_THAT(filmRefusal(folder / "none.film"), HasSubstr("No such file"));
    EXPECT_THAT(filmRefusal(folder.path()), HasSubstr("it is no film"));
}

} // namespace
} // namespace stromboli
