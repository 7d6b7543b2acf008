#include "scene/mitsuba/context.hpp"

#include <fmt/format.h>

namespace stromboli::mitsuba {

void ignoreUnread(const Context& context, const Plugin& plugin) {
    for (const std::string& name : plugin.unread())
        context.report().ignore(fmt::format("'{}' of {} '{}'", name, plugin.tag, plugin.type),
                                "it has no counterpart here");
}

} // namespace stromboli::mitsuba
