// `check`: the device against the reference.
#include "host/check/cross_check.hpp"
#include "host/cli/activity.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/declared_command.hpp"
#include "host/cli/exit_code.hpp"
#include "host/cli/progress.hpp"
#include "host/core/error.hpp"
#include "host/engine/render_session.hpp"

#include <fmt/format.h>

#include <memory>

namespace stromboli {
namespace {

constexpr Range<double> kErrorRates{1e-12, 0.5};

/// The samples of a picture; its progress is shown.
Film renderWatched(RenderSession& session, const SceneAndPicture& work, const LoadedScene& scene) {
    ProgressBar bar;
    SessionEvents events;
    events.progress = [&bar](const RenderProgress& progress) {
        bar.show(progress);
        return Next::GoOn;
    };
    session.begin(scene.scene, work.picture);
    if (session.run(events).bands > 1)
        throw UsageError("the films of the picture do not fit the memory: give another -r");
    return session.film();
}

} // namespace

void declareCheck(DeclaredCommand& c) {
    const auto o = std::make_shared<CheckOptions>();
    const auto asked = std::make_shared<Asked>();
    o->picture.size = {160, 120}; // quick
    asked->usualPaths = 256;
    declareScene(c.list, o->scene);
    declarePicture(c.list, o->picture, *asked);
    declareEstimator(c.list, *o, *asked);
    declareSamples(c.list, o->picture, *asked, "samples per pixel");
    declareBranches(c.list, o->picture, "1");
    c.list.group("Sampling");
    c.list.real("--alpha", "P", "probability of a false alarm", o->familyWiseError, kErrorRates);
    declareDevice(c.list, o->device.device);
    declareHost(c);
    c.finish = [&c, o, asked] {
        finishPicture(c, o->picture, *asked);
        finishEstimator(c, *o, *asked);
        finishBudget(o->picture, *asked);
        o->picture.budget.adaptive.enabled = false; // a z-test needs fixed sample counts
        o->device.threads = c.host.threads;
        o->device.maybeSeveral = false;
        return *o;
    };
}

int checkCommand(const CheckOptions& options) {
    RenderSession onDevice(options.device, toTerminal()); // is opened while the scene is read
    DeviceRequest host = options.device;
    host.backend = BackendChoice::Reference;
    RenderSession onHost(host); // says nothing that the other has not said
    const LoadedScene scene = loadScene(options.scene, toTerminal());
    warnOfBlackPicture(*scene.scene, options.scene.source, options.picture, toTerminal());
    const Film device = renderWatched(onDevice, options, scene);
    nowDoing("taking samples with the reference", StatusLine::OfOthers);
    const Film reference = renderWatched(onHost, options, scene);

    CheckSettings settings;
    settings.familyError = options.familyWiseError;
    const CheckResult result = crossCheck(device, reference, settings);
    fmt::print("A: {}\nB: {}\n{}", onDevice.result().backend, onHost.result().backend,
               formatCheck(result));
    switch (result.verdict()) {
    case Verdict::Different:
        return int(ExitCode::Device);
    case Verdict::Undecided:
        return int(ExitCode::Undecided);
    case Verdict::Agree:
        break;
    }
    return int(ExitCode::Success);
}

} // namespace stromboli
