#pragma once

namespace stromboli {

/// What Ctrl-C (SIGINT), SIGTERM and SIGHUP do: a thread of their own waits for them, so that it
/// does not matter what the others are busy with. Signals that were ignored when the program was
/// started (nohup) stay ignored, and so is SIGPIPE: a write to a closed pipe fails as one to a full
/// disk does.
///
/// A second signal always ends the program at once: temporary files are removed, a line says what
/// was being done, and the exit code is 128 + the signal's number.
enum class OnSignal {
    End,      ///< so does the first: there is nothing to keep
    Ask,      ///< interrupted() becomes true; who does not notice within kPatienceSeconds is ended
    AskToKeep ///< the same, but there are samples to be kept: they are waited for
};
/// How long Ask waits: with it the program ends within half a second of a signal.
inline constexpr double kPatienceSeconds = 0.4;

/// To be called before there are other threads: all of them inherit that signals are not for them.
void watchSignals();

/// What the next signal does; End at the start.
void onSignal(OnSignal what);

/// Whether a signal has asked to stop. Who calls this is expected to.
bool interrupted();

/// 128 + the number of the signal that came, as a shell reports it.
int interruptedExitCode();

} // namespace stromboli
