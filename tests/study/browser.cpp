#include "tests/study/browser.hpp"

#include <cstdlib>
#include <fstream>
#include <iterator>

namespace stromboli::study {

namespace fs = std::filesystem;

bool hasBrowser() {
    return std::system("command -v chromium >/dev/null 2>&1") == 0;
}

std::string loadPage(const fs::path& folder, const std::string& page, const std::string& script,
                     bool dark) {
    const std::string end = "</body>";
    std::string text = page;
    text.insert(text.rfind(end), "<script>" + script + "</script>\n");
    std::ofstream(folder / "page.html") << text;
    // No sandbox, because tests may run as root; the page is our own. The virtual time budget is
    // how long timers may run on, in milliseconds of the page's clock, before it is written out.
    const std::string command =
        "timeout 240 chromium --headless --no-sandbox --disable-gpu --window-size=1200,2000 "
        "--host-resolver-rules='MAP * ~NOTFOUND' --user-data-dir='" +
        (folder / "profile").string() +
        "' --blink-settings=preferredColorScheme=" + (dark ? "0" : "1") +
        " --virtual-time-budget=3000 --dump-dom 'file://" + (folder / "page.html").string() +
        "' >'" + (folder / "dom").string() + "' 2>/dev/null";
    if (std::system(command.c_str()) != 0) return {};
    std::ifstream dom(folder / "dom");
    return {std::istreambuf_iterator<char>(dom), {}};
}

std::string attributeOf(const std::string& document, const std::string& name) {
    const size_t tag = document.find("<html"), end = document.find('>', tag);
    const size_t at = document.find(name + "=\"", tag);
    if (tag == std::string::npos || at == std::string::npos || at > end) return {};
    const size_t first = at + name.size() + 2, last = document.find('"', first);
    std::string value = document.substr(first, last - first);
    for (const auto& [entity, character] :
         {std::pair{"&quot;", "\""}, {"&lt;", "<"}, {"&gt;", ">"}, {"&amp;", "&"}})
        for (size_t i = value.find(entity); i != std::string::npos; i = value.find(entity, i + 1))
            value.replace(i, std::string(entity).size(), character);
    return value;
}

} // namespace stromboli::study
