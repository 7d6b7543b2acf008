#include "host/regress/reports.hpp"

#include "embedded/regress_page.h"
#include "host/core/page_text.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <tinyxml2.h>

#include <algorithm>
#include <fstream>
#include <iterator>

namespace stromboli::regress {
namespace {

/// Mean, FLIP and whether the z-tests hold, in a few words.
std::string figuresOf(const Outcome& o) {
    if (!o.comparison) return "";
    const compare::Comparison& c = *o.comparison;
    std::string text = fmt::format("FLIP {:.4f}, relMSE {:.3g}", c.flip, c.errors.relMse);
    if (c.zTest)
        text += fmt::format(", largest z {:.1f} of {:.1f}", std::abs(c.zTest->worstBlock.z),
                            c.zTest->blockLimit);
    return text;
}

size_t countOf(const Results& r, Verdict verdict) {
    return size_t(std::ranges::count(r.outcomes, verdict, &Outcome::verdict));
}

} // namespace

std::string toText(const Results& r) {
    std::string text;
    size_t width = 0;
    for (const Outcome& o : r.outcomes)
        width = std::max(width, o.which.name.size());
    for (const Outcome& o : r.outcomes) {
        text += fmt::format("{:<9}  {:<{}}  {:6.2f} s  {}\n", nameOf(o.verdict), o.which.name,
                            width, o.seconds, figuresOf(o));
        for (const std::string& reason : o.reasons)
            text += fmt::format("             {}\n", reason);
        for (const std::string& remark : o.remarks)
            text += fmt::format("             note: {}\n", remark);
    }
    const size_t agree = countOf(r, Verdict::Agrees), updated = countOf(r, Verdict::Updated);
    if (updated > 0)
        text += fmt::format("{} golden pictures made anew\n", updated);
    else
        text += fmt::format("{}: {} of {} pictures agree (false alarms: {:g} % of suites)\n",
                            r.passed() ? "PASS" : "FAIL", agree, r.outcomes.size(),
                            100 * r.suite.falseAlarms);
    return text;
}

Json toJson(const Results& r) {
    Json json;
    json["suite"] = r.suite.file.string();
    json["date"] = r.date;
    json["version"] = r.version;
    json["device"] = r.device;
    json["falseAlarms"] = r.suite.falseAlarms;
    json["falseAlarmsOfEach"] = r.pictureFalseAlarms;
    json["passed"] = r.passed();
    json["pictures"] = Json::array();
    for (const Outcome& o : r.outcomes) {
        Json one;
        one["name"] = o.which.name;
        one["scene"] = o.which.scene;
        one["golden"] = o.which.golden.string();
        one["verdict"] = nameOf(o.verdict);
        one["reasons"] = o.reasons;
        one["remarks"] = o.remarks;
        one["seconds"] = o.seconds;
        one["megabytes"] = o.megabytes;
        if (o.comparison) one["comparison"] = compare::toJson(*o.comparison);
        json["pictures"].push_back(std::move(one));
    }
    return json;
}

std::string toJunit(const Results& r) {
    tinyxml2::XMLPrinter out;
    out.PushHeader(false, true);
    out.OpenElement("testsuite");
    out.PushAttribute("name", r.suite.file.stem().string().c_str());
    out.PushAttribute("tests", int(r.outcomes.size()));
    out.PushAttribute("failures",
                      int(countOf(r, Verdict::Differs) + countOf(r, Verdict::NoGolden)));
    out.PushAttribute("errors", int(countOf(r, Verdict::Failed)));
    out.PushAttribute("skipped", int(countOf(r, Verdict::Undecided) + countOf(r, Verdict::NotRun)));
    out.PushAttribute("timestamp", r.date.c_str());
    for (const Outcome& o : r.outcomes) {
        out.OpenElement("testcase");
        out.PushAttribute("classname", r.suite.file.stem().string().c_str());
        out.PushAttribute("name", o.which.name.c_str());
        out.PushAttribute("time", fmt::format("{:.3f}", o.seconds).c_str());
        const char* element = nullptr;
        if (o.verdict == Verdict::Differs || o.verdict == Verdict::NoGolden) element = "failure";
        if (o.verdict == Verdict::Failed) element = "error";
        if (o.verdict == Verdict::Undecided || o.verdict == Verdict::NotRun) element = "skipped";
        if (element) {
            out.OpenElement(element);
            out.PushAttribute("message",
                              o.reasons.empty() ? nameOf(o.verdict) : o.reasons.front().c_str());
            std::string all;
            for (const std::string& reason : o.reasons)
                all += reason + "\n";
            out.PushText(all.c_str());
            out.CloseElement();
        }
        if (o.comparison || !o.remarks.empty()) {
            std::string said = figuresOf(o) + "\n";
            for (const std::string& remark : o.remarks)
                said += remark + "\n";
            out.OpenElement("system-out");
            out.PushText(said.c_str());
            out.CloseElement();
        }
        out.CloseElement();
    }
    out.CloseElement();
    return out.CStr();
}

namespace {

/// A picture of the folder as it may stand in a page; null where there is none.
Json pictureIn(const std::filesystem::path& folder, const std::string& name) {
    std::ifstream in(folder / name, std::ios::binary);
    if (name.empty() || !in) return nullptr;
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    return "data:image/png;base64," + toBase64(bytes);
}

} // namespace

std::string toPage(const Results& r, const std::filesystem::path& folder) {
    Json json = toJson(r);
    for (size_t i = 0; i < r.outcomes.size(); ++i) {
        const Outcome& o = r.outcomes[i];
        Json& one = json["pictures"][i];
        one.erase("comparison");
        one["figures"] = figuresOf(o);
        one["goldenPicture"] = pictureIn(folder, o.goldenPicture);
        one["newPicture"] = pictureIn(folder, o.newPicture);
        one["flipPicture"] = pictureIn(folder, o.flipPicture);
        one["differencePicture"] = pictureIn(folder, o.differencePicture);
    }
    const std::string data = forScript(json.dump());
    const std::pair<std::string_view, std::string_view> marks[] = {{"@@DATA@@", data}};
    return filledIn({reinterpret_cast<const char*>(regress_page), sizeof regress_page}, marks);
}

} // namespace stromboli::regress
