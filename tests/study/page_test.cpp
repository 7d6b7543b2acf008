// The report in a headless browser: what a user would click, press and see.
#include "host/film/image_formats.hpp"
#include "host/study/page.hpp"
#include "host/study/run_study.hpp"
#include "tests/film/temporary_folder.hpp"
#include "tests/study/browser.hpp"
#include "tests/study/synthetic.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <fstream>
#include <iterator>

namespace stromboli::study {
namespace {

/// Fills data-results, or data-error, of the document's element.
constexpr const char* kDriver = R"js(
const seen = {};
const press = key => byId('plot').dispatchEvent(
  new KeyboardEvent('keydown', { key, bubbles: true, cancelable: true }));
const rows = () => [...byId('figures').tBodies[0].rows];
const cells = index => rows().map(r => r.cells[index].firstChild.textContent);
const firstNames = () => rows().map(r => r.cells[0].childNodes[1].textContent);
const button = (parent, text) => [...byId(parent).querySelectorAll('button')].find(b => b.textContent === text);
const heading = text => [...byId('figures').tHead.rows[0].cells].find(c => c.textContent === text);
const plotted = (color, canvas = byId('plot').querySelector('canvas')) => {
  const data = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data;
  const wanted = [1, 3, 5].map(i => parseInt(color.slice(i, i + 2), 16));
  let count = 0;
  for (let i = 0; i < data.length; i += 4)
    if (wanted.every((w, c) => Math.abs(data[i + c] - w) < 3) && data[i + 3] > 250) ++count;
  return count;
};
const contrast = (a, b) => {
  const light = color => color.match(/\d+/g).slice(0, 3).map(v => v / 255)
    .map(v => v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4)
    .reduce((sum, v, i) => sum + v * [0.2126, 0.7152, 0.0722][i], 0);
  const [x, y] = [light(a), light(b)].sort((p, q) => q - p);
  return (x + 0.05) / (y + 0.05);
};

async function drive() {
  seen.state = document.documentElement.dataset.state;
  seen.ground = getComputedStyle(document.body).backgroundColor;
  const style = element => getComputedStyle(element);
  seen.contrasts = [contrast(style(document.body).color, seen.ground),
    contrast(style(document.querySelector('.hint')).color, style(document.querySelector('section')).backgroundColor)];
  seen.names = firstNames();
  seen.speedups = cells(3);
  seen.slopes = cells(1);

  seen.plotted = ['default', 'hemisphere', 'bsdf'].map(n => plotted(colorOf(n)));
  button('series', 'hemisphere').click();
  seen.afterHiding = plotted(colorOf('hemisphere'));
  seen.pressedAfterHiding = button('series', 'hemisphere').ariaPressed;
  button('series', 'hemisphere').click();
  button('axis', 'samples per pixel').click();
  seen.axis = plot.axes[0].label;

  byId('plot').focus();
  seen.focused = document.activeElement === byId('plot');
  press('ArrowRight');
  seen.first = byId('readout').textContent;
  press('ArrowRight'); press('ArrowDown'); press('ArrowDown');
  seen.third = byId('readout').textContent;

  heading('slope').firstChild.click();
  seen.descending = [firstNames(), heading('slope').ariaSort];
  heading('slope').firstChild.click();
  seen.ascending = [firstNames(), heading('slope').ariaSort];
  seen.focusStays = document.activeElement.textContent;
  button('axis', 'wall time').click();
  byId('baseline').value = 'bsdf';
  byId('baseline').dispatchEvent(new Event('change'));
  seen.otherBaseline = [firstNames(), cells(3)];

  byId('left').value = 'default';
  byId('right').value = 'bsdf';
  byId('slider').value = 250;
  byId('slider').dispatchEvent(new Event('input'));
  byId('right').dispatchEvent(new Event('change'));
  await Promise.all([byId('image-left').decode(), byId('image-right').decode()]);
  seen.images = [byId('image-left').naturalWidth, byId('image-right').naturalWidth];
  seen.clip = byId('image-right').style.clipPath;
  seen.captions = byId('caption-right').textContent;
  button('kind', 'sample counts').click();
  seen.missing = byId('caption-right').textContent;

  const nameOf = e => e.tagName === 'BUTTON' ? e.textContent.trim()
    : [...e.labels].flatMap(l => [...l.childNodes]).filter(n => n !== e).map(n => n.textContent).join('').trim();
  seen.nameless = [...document.querySelectorAll('button, select, input')]
    .filter(e => e.tabIndex < 0 || !nameOf(e)).map(e => e.outerHTML);
  button('scenes', 'other <scene>').click();
  seen.otherScene = [firstNames(), byId('target').textContent];

  drawFigure();
  await new Promise(done => setTimeout(done, 50));
  seen.figure = [...document.querySelectorAll('canvas')].map(c => plotted(colorOf('bsdf'), c) > 100);
}
drive().catch(e => { seen.failed = String(e.stack); })
  .finally(() => { document.documentElement.dataset.results = JSON.stringify(seen); });
)js";

Study twoScenes() {
    Study study = powerLawStudy(3, 1e-9);
    study.deviceIsCpu = false;
    study.circumstances = {
        {"device", "a device"}, {"cpu", "a CPU"}, {"command", "stromboli </script>"}};
    study.scenes.push_back(study.scenes[0]);
    study.scenes[1].name = "other <scene>";
    std::erase_if(study.scenes[1].runs, [](const auto& r) { return r.configuration == "bsdf"; });
    return study;
}

void writePictures(const Study& study, const std::filesystem::path& folder) {
    std::filesystem::create_directories(folder / "pictures");
    const ByteImage image(8, 8);
    for (const Configuration& c : study.settings.configurations)
        for (size_t i = 0; i < 4; ++i)
            writePng(folder / (pictureName("s", c.name, i) + ".png"), image, PngColorSpace::Srgb);
}

nlohmann::json seenIn(bool dark) {
    const TemporaryFolder folder;
    const Study study = twoScenes();
    writePictures(study, folder.path());
    const std::string document =
        loadPage(folder.path(), toPage(study, folder.path()), kDriver, dark);
    EXPECT_EQ(attributeOf(document, "data-error"), "");
    return nlohmann::json::parse(attributeOf(document, "data-results"), nullptr, false);
}

TEST(StudyPage, NeedsNothingElse) {
    const TemporaryFolder folder;
    const std::string page = toPage(twoScenes(), folder.path());
    EXPECT_THAT(page, testing::HasSubstr("default-src 'none'")); // what the browser enforces
    for (const char* outside : {"src=\"http", "href=\"http", "@import", "<link", "url(http"})
        EXPECT_THAT(page, testing::Not(testing::HasSubstr(outside)));
    EXPECT_THAT(page, testing::Not(testing::HasSubstr("@@")));
    EXPECT_THAT(page,
                testing::HasSubstr("stromboli \\u003c/script>")); // the data cannot end itself
}

void expectFiguresAndPlots(const nlohmann::json& seen) {
    // The laws of powerLawStudy(): a quarter and four times the speed of the baseline.
    EXPECT_EQ(seen["names"], (std::vector{"default", "hemisphere", "bsdf"}));
    EXPECT_EQ(seen["speedups"], (std::vector{"1 ×", "0.25 ×", "4 ×"}));
    EXPECT_EQ(seen["slopes"], (std::vector{"-1", "-1", "-1.5"}));
    for (const int pixels : seen["plotted"])
        EXPECT_GT(pixels, 300);
    EXPECT_EQ(seen["afterHiding"], 0);
    EXPECT_EQ(seen["pressedAfterHiding"], "false");
    EXPECT_EQ(seen["axis"], "samples per pixel");
    EXPECT_EQ(seen["otherScene"][0].size(), 2u);
    EXPECT_EQ(seen["figure"], (std::vector{true, false})); // the second scene has no "bsdf"
}

void expectKeyboard(const nlohmann::json& seen) {
    EXPECT_EQ(seen["focused"], true);
    EXPECT_THAT(seen["first"].get<std::string>(), testing::StartsWith("default: relMSE 0.25"));
    EXPECT_THAT(seen["third"].get<std::string>(), testing::StartsWith("bsdf: relMSE 0.0156"));
    EXPECT_EQ(seen["descending"][0].back(), "bsdf");
    EXPECT_EQ(seen["descending"][1], "descending");
    EXPECT_EQ(seen["ascending"][0].front(), "bsdf");
    EXPECT_EQ(seen["ascending"][1], "ascending");
    EXPECT_EQ(seen["focusStays"], "slope");
    EXPECT_EQ(seen["nameless"], nlohmann::json::array()); // all have a name and can be reached
}

void expectOtherBaselineAndPictures(const nlohmann::json& seen) {
    EXPECT_EQ(seen["otherBaseline"][0].front(), "bsdf");
    EXPECT_EQ(seen["otherBaseline"][1].front(), "1 ×");
    EXPECT_THAT(seen["otherBaseline"][1], testing::Contains("0.25 ×")); // default against bsdf
    EXPECT_EQ(seen["images"], (std::vector{8, 8}));
    EXPECT_EQ(seen["clip"], "inset(0px 0px 0px 25%)");
    EXPECT_THAT(seen["captions"].get<std::string>(), testing::StartsWith("bsdf: 64 samples"));
    EXPECT_THAT(seen["missing"].get<std::string>(), testing::HasSubstr("no sample counts"));
}

void expectReadable(const nlohmann::json& seen, const char* ground) {
    EXPECT_EQ(seen["ground"], ground);
    for (const double contrast : seen["contrasts"])
        EXPECT_GT(contrast, 4.5); // WCAG 2.1, success criterion 1.4.3
}

TEST(StudyPageInBrowser, DoesWhatItsControlsSayByMouseAndByKeyboard) {
    if (!hasBrowser()) GTEST_SKIP() << "needs the package chromium";
    const nlohmann::json seen = seenIn(false);
    ASSERT_TRUE(seen.is_object());
    EXPECT_EQ(seen.value("failed", ""), "");
    EXPECT_EQ(seen["state"], "ready");
    expectFiguresAndPlots(seen);
    expectKeyboard(seen);
    expectOtherBaselineAndPictures(seen);
    expectReadable(seen, "rgb(253, 253, 252)");
}

TEST(StudyPageInBrowser, ReadsInDark) {
    if (!hasBrowser()) GTEST_SKIP() << "needs the package chromium";
    const nlohmann::json seen = seenIn(true);
    ASSERT_TRUE(seen.is_object());
    expectReadable(seen, "rgb(22, 24, 28)");
}

} // namespace
} // namespace stromboli::study
