// `view`: a scene in a browser, to look at and to move about in.
#include "host/cli/commands.hpp"
#include "host/cli/declared_command.hpp"
#include "host/cli/log.hpp"
#include "host/cli/progress.hpp"
#include "host/cli/render_outputs.hpp"
#include "host/cli/signals.hpp"
#include "host/core/error.hpp"
#include "host/engine/render_session.hpp"
#include "host/view/live_view.hpp"
#include "host/view/picture_source.hpp"
#include "host/view/server.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <mutex>
#include <set>
#include <spawn.h>
#include <string>

extern char** environ;

namespace stromboli {
namespace {

constexpr Range<uint32_t> kPorts{0, 65535};

// --- The command that makes the picture ----------------------------------------------------------

/// Options that say what the page has a word in.
const Words& ofThePage() {
    static const Words kNames = {"-r",          "--crop",    "--view",       "--exposure",
                                 "--denoise",   "--host",    "--port",       "--open",
                                 "--camera",    "--fov",     "--aperture",   "--focus",
                                 "--look-from", "--look-at", "--env-rotate", "--sun",
                                 "--variant",   "--at",      "--guiding"};
    return kNames;
}
const Words& ofTheCamera() {
    static const Words kNames = {"--camera", "--fov",       "--aperture",
                                 "--focus",  "--look-from", "--look-at"};
    return kNames;
}

bool isOneOf(const std::string& part, const Words& names) {
    return std::ranges::count(names, part.substr(0, part.find(' '))) > 0;
}

std::string inWords(const glm::dvec3& point) {
    return fmt::format("{} {} {}", point.x, point.y, point.z); // as many digits as it takes
}

std::string poseInWords(const view::Pose& pose) {
    std::string text = fmt::format("--look-from {} --look-at {} --fov {}", inWords(pose.from),
                                   inWords(pose.at), pose.fieldOfView);
    if (pose.aperture > 0)
        text += fmt::format(" --aperture {} --focus {}", pose.aperture, pose.focus);
    return text;
}

/// What the page can change of the scene and its light.
void addScene(Words& parts, const SceneRequest& scene) {
    const EnvironmentRequest& around = scene.environment;
    if (const auto& sun = around.sun)
        parts.push_back(
            fmt::format("--sun {},{},{}", sun->azimuth, sun->elevation, sun->turbidity));
    else if (around.rotationDegrees != 0)
        parts.push_back(fmt::format("--env-rotate {}", around.rotationDegrees));
    const FileSelection& selection = scene.reading.selection;
    if (!selection.variant.empty()) parts.push_back("--variant " + shellQuoted(selection.variant));
    if (selection.seconds) parts.push_back(fmt::format("--at {}", *selection.seconds));
}

/// What is viewed, as a picture in a file that has the name of the scene.
std::string commandOf(const ViewOptions& o, const view::Viewed& viewed) {
    const PictureArea& area = viewed.picture.settings.area;
    const view::ToneWords& tone = viewed.tone;
    Words parts = o.command;
    addScene(parts, viewed.scene);
    if (viewed.pose)
        parts.push_back(poseInWords(*viewed.pose));
    else if (viewed.fileCamera)
        parts.push_back(fmt::format("--camera {}", *viewed.fileCamera + 1));
    else
        parts.insert(parts.end(), o.cameraWords.begin(), o.cameraWords.end());
    parts.push_back(fmt::format("-r {} {}", area.width, area.height));
    const Crop& crop = area.crop;
    if (crop.width > 0)
        parts.push_back(fmt::format("--crop {} {} {} {}", crop.x, crop.y, crop.width, crop.height));
    if (tone.view != "standard") parts.push_back("--view " + tone.view);
    if (tone.exposure != "0") parts.push_back("--exposure " + tone.exposure);
    if (viewed.denoised) parts.emplace_back("--denoise on");
    if (o.picture.guiding != Guiding::Automatic)
        parts.push_back(fmt::format("--guiding {}", nameOf(o.picture.guiding)));
    std::string stem = std::filesystem::path(o.scene.source).stem().string();
    if (stem.empty() || o.scene.source.find(':') != std::string::npos) stem = "view";
    parts.push_back("-o " + shellQuoted(stem + ".png"));
    return fmt::format("{}", fmt::join(parts, " "));
}

// --- Running -------------------------------------------------------------------------------------

/// What an engine says again at each move is said once.
Listener sayingOnce(Listener listener) {
    struct Said {
        std::mutex mutex;
        std::set<std::string> lines;
    };
    const auto said = std::make_shared<Said>();
    listener.message = [say = listener.message, said](Severity severity, const std::string& text) {
        {
            const std::lock_guard lock(said->mutex);
            if (!said->lines.insert(text).second) return;
        }
        if (say) say(severity, text);
    };
    return listener;
}

/// Asks the desktop to show an address; whoever has none opens it by hand.
void openInBrowser(const std::string& address) {
    std::string program = "xdg-open", word = address;
    char* const arguments[] = {program.data(), word.data(), nullptr};
    pid_t child = 0;
    if (::posix_spawnp(&child, program.c_str(), nullptr, nullptr, arguments, environ) != 0)
        logging::warn("--open: there is no xdg-open here (Debian: xdg-utils); open the address by "
                      "hand");
}

view::LiveRequest liveRequest(const ViewOptions& o, LoadedScene scene) {
    view::LiveRequest request;
    request.name = o.scene.source;
    request.picture = o.picture;
    if (!o.reference.empty()) {
        request.reference = view::readReference(o.reference);
        const compare::Picture& reference = request.reference->picture;
        if (!o.picture.size && o.picture.crop.width == 0)
            request.picture.size = PictureSize{reference.width, reference.height};
    }
    request.source = o.scene;
    Listener listener = sayingOnce(toTerminal());
    listener.activity = nullptr; // on another thread than what renders
    request.load = [listener](const SceneRequest& other) { return loadScene(other, listener); };
    request.command = [o](const view::Viewed& viewed) { return commandOf(o, viewed); };
    request.notes = [source = o.scene.source, seed = o.picture.estimator.seed](
                        const RenderResult& result, const std::string& command) {
        const std::string samples =
            fmt::format("{} paths in all{}", result.samplesTaken,
                        result.cancelled ? ", of a picture that was not finished" : "");
        return pictureNotes({source, seed, samples, result.backend, {command}, ""});
    };
    request.scene = std::move(scene);
    return request;
}

} // namespace

void declareView(DeclaredCommand& c) {
    const auto o = std::make_shared<ViewOptions>();
    const auto asked = std::make_shared<Asked>();
    asked->makes = Makes::Pictures;
    asked->maySpread = asked->branchesPay = true;
    o->picture.guiding = Guiding::Off; // learning takes longer than a move of the camera may
    OptionList& list = c.list;
    declareScene(list, o->scene);
    list.group("Page");
    list.number("--port", "P", "the port to listen at; 0: any that is free", o->port, kPorts)
        .besidePicture();
    list.text("--host", "ADDRESS",
              "the address to listen at; at others than this machine's own the page is for those "
              "who have the token in the address that is printed",
              o->host)
        .besidePicture();
    list.flag("--open", "open the page in the desktop's browser", o->open).besidePicture();
    list.choice("--view", "HOW", "how radiance becomes the light of a screen, to begin with",
                o->viewTransform);
    list.text("--exposure", "EV", "radiance times 2^EV, to begin with; auto: metered", o->exposure);
    list.onOff("--denoise", "on: the page begins with the denoised picture", o->denoised);
    list.text("--reference", "FILE",
              "a picture (.exr, .hdr, .pfm, ...) that the page lays beside its own, with what "
              "`compare` says of them; -r is its size",
              o->reference)
        .proposes(Proposed::Files)
        .besidePicture();
    declarePicture(list, o->picture, *asked);
    declareEstimator(list, *o, *asked);
    declareSamples(list, o->picture, *asked,
                   "samples per pixel, on the mean over the picture, after which it is finished");
    declareClamp(list, o->picture);
    declareBranches(list, o->picture, "4 where bounces make most of the noise, else 1");
    list.group("Sampling");
    list.flag("--even", "the same number of samples for every pixel", asked->even);
    declareFilmMemory(list, o->device);
    declareDevice(list, o->device.device);
    declareHost(c);
    c.finish = [&c, o, asked] {
        finishPicture(c, o->picture, *asked);
        finishEstimator(c, *o, *asked);
        finishBudget(o->picture, *asked);
        if (o->tone.curve.kind != ToneCurve::Kind::Srgb)
            throw UsageError(fmt::format("{} has a tone curve of its own, which the page does not "
                                         "know: render has it",
                                         o->scene.reading.option));
        static_cast<void>(view::toneOf({nameOf(o->viewTransform), o->exposure})); // throws
        o->device.threads = c.host.threads;
        o->command = {"stromboli render"};
        for (const std::string& part : c.pictureCommand)
            if (isOneOf(part, ofTheCamera()))
                o->cameraWords.push_back(part);
            else if (part != "stromboli view" && !isOneOf(part, ofThePage()))
                o->command.push_back(part);
        return *o;
    };
}

int viewCommand(const ViewOptions& o) {
    view::Exchange exchange;
    view::ServerOptions serving;
    serving.host = o.host;
    serving.port = uint16_t(o.port);
    serving.tone = {nameOf(o.viewTransform), o.exposure};
    serving.denoised = o.denoised;
    RenderSession session(o.device, sayingOnce(toTerminal())); // opens devices meanwhile
    LoadedScene scene = loadScene(o.scene, toTerminal());
    warnOfBlackPicture(*scene.scene, o.scene.source, o.picture, toTerminal());
    view::LiveRequest request = liveRequest(o, std::move(scene));
    if (request.reference) serving.reference = request.reference->frame;
    view::LiveView live(session, exchange, std::move(request));
    const view::Server server(serving, exchange);
    fmt::print("{}\n", server.address());
    std::fflush(stdout);
    logging::info("open this address in a browser; Ctrl-C ends");
    if (o.open) openInBrowser(server.address());
    onSignal(OnSignal::Ask);
    live.run([] { return interrupted(); });
    return interruptedExitCode();
}

} // namespace stromboli
