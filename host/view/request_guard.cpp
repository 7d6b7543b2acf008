#include "host/view/request_guard.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <random>

namespace stromboli::view {
namespace {

constexpr size_t kLongestTarget = 2048, kMostHeaders = 64;

/// In a time that does not depend on where they differ.
bool sameSecret(const std::string& a, const std::string& b) {
    unsigned different = a.size() == b.size() ? 0 : 1;
    for (size_t i = 0; i < a.size() && i < b.size(); ++i)
        different |= unsigned(static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]));
    return different == 0;
}

} // namespace

std::optional<Refusal> refusalOf(const RequestFacts& r, const GuardRules& rules) {
    if (r.method != "GET" && r.method != "POST") return Refusal{405, "only GET and POST"};
    if (r.hasBody) return Refusal{413, "requests have no body here"};
    if (r.targetLength > kLongestTarget) return Refusal{414, "the address is too long"};
    if (r.headerCount > kMostHeaders) return Refusal{431, "too many headers"};
    if (r.host.empty() || (!rules.hosts.empty() && !std::ranges::count(rules.hosts, r.host)))
        return Refusal{403, "this is not the name of this server"};
    if (!r.origin.empty() && r.origin != "http://" + r.host)
        return Refusal{403, "pages of other sites may not ask"};
    if (!r.site.empty() && r.site != "same-origin" && r.site != "none")
        return Refusal{403, "pages of other sites may not ask"};
    const bool isPage = r.method == "GET" && r.path == "/";
    if ((!isPage || rules.wantsTokenForPage) && !sameSecret(r.token, rules.token))
        return Refusal{403, "the token is missing or wrong: open the address that was printed"};
    return std::nullopt;
}

std::string randomToken() {
    std::random_device random; // of the system (getrandom)
    std::string token;
    for (int i = 0; i < 4; ++i)
        token += fmt::format("{:08x}", uint32_t(random()));
    return token;
}

} // namespace stromboli::view
