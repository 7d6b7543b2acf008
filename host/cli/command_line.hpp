#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace stromboli {

// --- The program in words ------------------------------------------------------------------------

// What help and the manual page both say of the program as a whole.

inline constexpr const char* kInOneLine = "a path tracer in Vulkan compute shaders";
inline constexpr const char* kWhatItDoes =
    "glTF, COLLADA, Mitsuba, pbrt, OBJ and PLY in; PNG, JPEG, WebP or EXR out; on any Vulkan 1.1 "
    "device, GPU or not.";
inline constexpr const char* kHowNumbersAreWritten =
    "Numbers may have an exponent, k or M (2.5k, 1e6), and most their unit (10s, 2m, 2%, 5mm, "
    "30deg).";

/// A word of an interface and what it means.
struct Explained {
    const char* word;
    const char* meaning;
};

/// The program's own; the script `stromboli` has 5 besides (host/cli/commands.hpp).
inline constexpr std::array kExitCodes = {
    Explained{"0", "done"},
    Explained{"1", "usage"},
    Explained{"2", "scene"},
    Explained{"3", "device (or a difference found)"},
    Explained{"4", "output"},
    Explained{"6", "too few samples for check to tell (or films left out of merge)"},
    Explained{"7", "nothing left to plan"},
};

/// Commands to begin with, without the program's name.
inline constexpr std::array kFirstCommands = {
    Explained{"render SCENE -o out.png", "a picture"},
    Explained{"render SCENE -o out.png --time 60", "the best one of a minute"},
    Explained{"render SCENE -o out.png --noise 0.02", "until its noise is 2 %"},
    Explained{"info SCENE", "what the scene holds"},
    Explained{"check SCENE", "does this device render it right?"},
};

/// "0 done, 1 usage".
std::string exitCodesInOneLine();

/// What the program says when it is called without arguments: enough to make a picture.
std::string shortHelp();

// --- Words of command lines ----------------------------------------------------------------------

/// A word as a shell would read it again.
std::string shellQuoted(const std::string& word);

/// This process's command line, quoted so that a shell would read it again.
std::string commandLine();

} // namespace stromboli
