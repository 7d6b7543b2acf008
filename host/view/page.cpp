#include "host/view/page.hpp"

#include "embedded/view_html.h"
#include "embedded/view_poses.h"
#include "embedded/view_reference.h"
#include "embedded/view_script.h"
#include "embedded/view_style.h"
#include "embedded/view_transforms.h"
#include "host/core/json.hpp"
#include "host/core/page_text.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <span>
#include <string_view>
#include <utility>

namespace stromboli::view {
namespace {

std::string_view textOf(std::span<const unsigned char> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

} // namespace

std::string pageText(const PageFacts& facts) {
    const Json settings = {{"token", facts.token},       {"readOnly", facts.readOnly},
                           {"view", facts.view},         {"exposure", facts.exposure},
                           {"denoised", facts.denoised}, {"reference", facts.hasReference}};
    const std::string data = forScript(settings.dump());
    const std::pair<std::string_view, std::string_view> parts[] = {
        {"@@NONCE@@", facts.nonce},
        {"@@STYLE@@", textOf(view_style)},
        {"@@NONCE@@", facts.nonce},
        {"@@DATA@@", data},
        {"@@NONCE@@", facts.nonce},
        {"@@TRANSFORMS@@", textOf(view_transforms)},
        {"@@POSES@@", textOf(view_poses)},
        {"@@SCRIPT@@", textOf(view_script)},
        {"@@REFERENCE@@", textOf(view_reference)},
    };
    return filledIn(textOf(view_html), parts);
}

std::string contentPolicy(const std::string& nonce) {
    return fmt::format("default-src 'none'; script-src 'nonce-{0}'; style-src 'nonce-{0}'; "
                       "connect-src 'self'; img-src 'self' data: blob:; base-uri 'none'; "
                       "form-action 'none'; frame-ancestors 'none'",
                       nonce);
}

} // namespace stromboli::view
