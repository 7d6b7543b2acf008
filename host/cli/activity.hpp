#pragma once

#include "host/engine/load_scene.hpp"

#include <string>

namespace stromboli {

/// Who draws the status line.
enum class StatusLine {
    OfActivity, ///< what is being done, and for how many seconds
    OfOthers    ///< somebody who knows more
};

/// What the program is busy with, for the status line and for the message of a signal that ends it:
/// "loading cornell.dae". Replaces what was said before.
void nowDoing(const std::string& what, StatusLine line = StatusLine::OfActivity);

/// What nowDoing() said last; empty if a thread is just about to change it.
std::string whatIsBeingDone();

/// Draws the status line anew if something has been done for a while. Called a few times a second
/// by the thread that watches for signals, because those who work do not know how long it takes.
void redrawActivity();

/// What an engine says becomes messages, and what it does the activity.
Listener toTerminal();

} // namespace stromboli
