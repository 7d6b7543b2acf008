#include "host/regress/suite.hpp"

#include "host/core/error.hpp"
#include "host/core/nearest_name.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

namespace stromboli::regress {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> kForAll = {"size",   "samples", "golden_samples", "options",
                                          "limits", "seconds", "megabytes"};
const std::vector<std::string> kOfSuite = {"false_alarms", "picture"};
const std::vector<std::string> kOfPicture = {"name", "scene", "golden"};
constexpr uint32_t kMostSide = 65536, kMostSamples = 1u << 24;

std::vector<std::string> together(std::vector<std::string> a, const std::vector<std::string>& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

/// Reads one file; `where` of messages is a line of it.
class Reader {
  public:
    explicit Reader(const fs::path& file) : file_(file) {}

    [[noreturn]] void fail(const toml::node& at, const std::string& key,
                           const std::string& problem) const {
        throw SceneError(file_.string(), int(at.source().begin.line), key, problem);
    }

    void checkKeys(const toml::table& table, const std::vector<std::string>& known) const {
        for (const auto& [key, value] : table)
            if (const std::string name(key.str()); std::ranges::find(known, name) == known.end())
                fail(value, name, fmt::format("is no key here{}", didYouMean(name, known)));
    }

    double real(const toml::node& node, const char* key, double least, double most) const {
        const std::optional<double> value = node.value<double>();
        if (!value || !(*value >= least && *value <= most))
            fail(node, key, fmt::format("expected a number from {} to {}", least, most));
        return *value;
    }
    uint32_t count(const toml::node& node, const char* key, uint32_t most) const {
        const std::optional<int64_t> value = node.value_exact<int64_t>();
        if (!value || *value < 1 || *value > most)
            fail(node, key, fmt::format("expected a whole number from 1 to {}", most));
        return uint32_t(*value);
    }
    std::string text(const toml::node& node, const char* key) const {
        const std::optional<std::string> value = node.value_exact<std::string>();
        if (!value || value->empty()) fail(node, key, "expected a text in quotes");
        return *value;
    }
    /// A text is cut at white space, a list is taken as it is.
    std::vector<std::string> words(const toml::node& node, const char* key) const {
        std::vector<std::string> found;
        if (const toml::array* list = node.as_array()) {
            for (const toml::node& word : *list)
                found.push_back(text(word, key));
            return found;
        }
        const std::optional<std::string> line = node.value_exact<std::string>();
        if (!line) fail(node, key, "expected options of render, as a text or a list of texts");
        std::istringstream in(*line);
        for (std::string word; in >> word;)
            found.push_back(word);
        return found;
    }

    compare::Thresholds limits(const toml::node& node) const {
        const toml::table* const table = node.as_table();
        if (!table) fail(node, "limits", "expected a table, as {flip = 0.05, bias = 1}");
        compare::Thresholds t;
        checkKeys(*table, {"mse", "relmse", "psnr", "ssim", "flip", "bias"});
        constexpr double kMost = 1e300;
        for (const auto& [key, value] : *table) {
            const std::string name(key.str());
            if (name == "mse") t.mse = real(value, "mse", 0, kMost);
            if (name == "relmse") t.relMse = real(value, "relmse", 0, kMost);
            if (name == "psnr") t.psnr = real(value, "psnr", -1000, 1000);
            if (name == "ssim") t.ssim = real(value, "ssim", -1, 1);
            if (name == "flip") t.flip = real(value, "flip", 0, 1);
            if (name == "bias") t.biasPercent = real(value, "bias", 0, 1e9);
        }
        return t;
    }

    /// What may be said of all pictures, and of each.
    void takeCommon(const toml::table& table, SuitePicture& picture) const {
        if (const toml::node* size = table.get("size")) {
            const toml::array* const both = size->as_array();
            if (!both || both->size() != 2) fail(*size, "size", "expected [width, height]");
            picture.width = count(*both->get(0), "size", kMostSide);
            picture.height = count(*both->get(1), "size", kMostSide);
        }
        if (const toml::node* samples = table.get("samples")) {
            picture.samples = count(*samples, "samples", kMostSamples);
            picture.goldenSamples =
                uint32_t(std::min<uint64_t>(uint64_t(picture.samples) * 4, kMostSamples));
        }
        if (const toml::node* samples = table.get("golden_samples"))
            picture.goldenSamples = count(*samples, "golden_samples", kMostSamples);
        if (const toml::node* line = table.get("options"))
            picture.options = together(picture.options, words(*line, "options"));
        if (const toml::node* node = table.get("limits")) picture.limits = limits(*node);
        if (const toml::node* node = table.get("seconds"))
            picture.seconds = real(*node, "seconds", 0, 1e9);
        if (const toml::node* node = table.get("megabytes"))
            picture.megabytes = real(*node, "megabytes", 0, 1e9);
    }

    SuitePicture picture(const toml::table& table, const SuitePicture& forAll) const {
        checkKeys(table, together(kForAll, kOfPicture));
        SuitePicture p = forAll;
        p.line = int(table.source().begin.line);
        takeCommon(table, p);
        const toml::node* const scene = table.get("scene");
        if (!scene) fail(table, "picture", "has no scene");
        p.scene = text(*scene, "scene");
        p.name = fs::path(p.scene).stem().string();
        if (const toml::node* name = table.get("name")) p.name = text(*name, "name");
        if (p.name.find('/') != std::string::npos || p.name.starts_with('.'))
            fail(table, "name", "is no name of a file: " + p.name);
        const fs::path folder = file_.parent_path();
        if (fs::exists(folder / p.scene)) p.scene = (folder / p.scene).string();
        p.golden = folder / "golden" / (p.name + ".exr");
        if (const toml::node* golden = table.get("golden"))
            p.golden = folder / text(*golden, "golden");
        return p;
    }

  private:
    fs::path file_;
};

toml::table parsed(const fs::path& file) {
    if (!fs::is_regular_file(file))
        throw SceneError(file.string(), 0, "", "is no file: expected a suite of pictures (TOML)");
    try {
        return toml::parse_file(file.string());
    } catch (const toml::parse_error& error) {
        throw SceneError(file.string(), int(error.source().begin.line), "",
                         std::string(error.description()));
    }
}

} // namespace

Suite readSuite(const fs::path& file) {
    const toml::table table = parsed(file);
    const Reader reader(file);
    reader.checkKeys(table, together(kForAll, kOfSuite));
    Suite suite;
    suite.file = file;
    if (const toml::node* node = table.get("false_alarms"))
        suite.falseAlarms = reader.real(*node, "false_alarms", 1e-12, 0.5);
    SuitePicture forAll;
    reader.takeCommon(table, forAll);
    const toml::node* const list = table.get("picture");
    const toml::array* const pictures = list ? list->as_array() : nullptr;
    if (!pictures || pictures->empty())
        throw SceneError(file.string(), 0, "", "has no [[picture]]");
    std::set<std::string> names;
    for (const toml::node& node : *pictures) {
        const toml::table* const one = node.as_table();
        if (!one) reader.fail(node, "picture", "expected a table [[picture]]");
        suite.pictures.push_back(reader.picture(*one, forAll));
        if (!names.insert(suite.pictures.back().name).second)
            reader.fail(node, "name",
                        fmt::format("two pictures have the name '{}'", suite.pictures.back().name));
    }
    return suite;
}

std::vector<SuitePicture> chosen(const Suite& suite, const std::vector<std::string>& names) {
    if (names.empty()) return suite.pictures;
    std::vector<std::string> known;
    for (const SuitePicture& p : suite.pictures)
        known.push_back(p.name);
    for (const std::string& name : names)
        if (std::ranges::find(known, name) == known.end())
            throw UsageError(fmt::format("{} has no picture '{}'{}", suite.file.string(), name,
                                         didYouMean(name, known)));
    std::vector<SuitePicture> pictures;
    for (const SuitePicture& p : suite.pictures)
        if (std::ranges::find(names, p.name) != names.end()) pictures.push_back(p);
    return pictures;
}

} // namespace stromboli::regress
