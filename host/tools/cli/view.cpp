// luciole view: a page in the browser that shows a scene while one turns, lights and edits it.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/spawn.hpp"
#include "luciole/error.hpp"
#include "scene/json/mesh_file.hpp"
#include "scene/models.hpp"
#include "tools/cli/commands.hpp"
#include "tools/cli/event_log.hpp"
#include "tools/cli/open_devices.hpp"
#include "tools/cli/picture_options.hpp"
#include "tools/cli/suggest.hpp"
#include "tools/view/file_view.hpp"
#include "tools/view/scene_view.hpp"
#include "tools/view/server.hpp"
#include "tools/view/view_page.hpp"

namespace luciole {
namespace {

constexpr unsigned kOptionsOfViews =
    kViewOptions | kSampleOption | kModelOptions | kShadeOptions | kCastOption | kDeviceOption;

/// Options that the page may set, by their long names.
const std::set<std::string> kPageOptions{"model",          "shading",
                                         "shadows",        "exposure",
                                         "samples",        "light-error",
                                         "culling",        "confidence",
                                         "seed",           "tile",
                                         "pcf-width",      "soft-samples",
                                         "cast-shadows",   "light-error-relative",
                                         "samples-shading"};

struct ViewCommandOptions : PictureOptions {
  std::string input, other;
  std::string folder = ".";
  std::string watch = "on";
  ServerSettings server;
  bool opens = false;
};

bool isExr(const std::string& path) { return extensionOf(path) == ".exr"; }

/// The page's options as they were typed.
ViewOptions typedOptions(const CLI::App& command) {
  ViewOptions typed;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames())
      if (option->count() > 0 && kPageOptions.contains(name)) typed[name] = option->results().back();
  return typed;
}

/// The command's options with these of the page. Throws InputError for others.
PictureOptions optionsOfPage(const ViewCommandOptions& typed, const ViewOptions& of_page) {
  PictureOptions options;
  for (const char* name : {"size", "shadow_memory", "shadow_size"})
    options.settings[name] = typed.value(name);
  options.camera = typed.camera;
  CLI::App parser;
  addPictureOptions(parser, options, kOptionsOfViews);
  parser.get_option("--output")->required(false);
  std::vector<std::string> words;
  for (const auto& [name, value] : of_page) {
    if (!kPageOptions.contains(name)) throw InputError("options: " + name + ": the page can't set that");
    if (name == "model" && value.ends_with(kShaderExtension))
      throw InputError("options: model: the page names no files");
    words.push_back("--" + name + "=" + value);
  }
  try {
    parser.parse(words);
  } catch (const CLI::ParseError& error) {
    throw InputError(std::string("options: ") + error.what());
  }
  return options;
}

/// The text of the one file that an option names; "" without it.
std::string textOf(const std::vector<std::string>& paths, ShaderKind kind, const char* option) {
  if (paths.size() > 1) throw InputError(fmt::format("{}: view takes one, which its page edits", option));
  return paths.empty() ? "" : readShader(paths[0], kind).text;
}

SceneSource sourceOf(const CLI::App& command, const ViewCommandOptions& typed) {
  SceneSource source{.path = typed.input,
                     .folder = typed.folder,
                     .watches = typed.watch == "on",
                     .options = typedOptions(command)};
  if (typed.model.ends_with(kShaderExtension)) {
    source.shaders.model = readShader(typed.model, ShaderKind::kModel).text;
    source.options.erase("model");
  }
  source.shaders.surface = textOf(typed.surfaces, ShaderKind::kSurface, "--surface");
  source.shaders.screen = textOf(typed.screens, ShaderKind::kScreen, "--screen");
  // As render has it in pictures of integers.
  if (isMeshFile(typed.input)) source.options.try_emplace("exposure", "auto");
  source.load = [path = typed.input, load = typed.load, quiet = typed.quiet]() mutable {
    PictureOptions options;
    options.load = load;
    options.quiet = std::exchange(quiet, true);  // warnings are told once
    return openScene(path, 1, options);
  };
  source.settings = [&typed](const ViewOptions& of_page, Scene& scene) {
    const PictureOptions options = optionsOfPage(typed, of_page);
    takeModel(options, scene);
    const std::size_t warnings = scene.warnings.size();
    castShadows(options, scene);
    scene.warnings.resize(warnings);
    return renderSettings(options, scene);
  };
  return source;
}

/// Shows the address in the user's browser.
void openInBrowser(const std::string& address) {
  const std::string opener = programFile("xdg-open");
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  pid_t child = 0;
  if (opener.empty() || spawnProgram(opener, {"xdg-open", address}, actions, 0, child) != 0)
    reportWarning("--open: there is no xdg-open here; open the address by hand");
  posix_spawn_file_actions_destroy(&actions);
}

/// Serves the page, and says where, until the process ends.
void serve(const ViewCommandOptions& options, Handlers handlers) {
  handlers.get["/"] = viewPage;
  Server server(options.server, std::move(handlers));
  if (options.server.host != "127.0.0.1" && options.server.host != "localhost" && !options.quiet)
    reportWarning(fmt::format(
        "--host {}: who can reach this machine and has the address can use the page, and read along "
        "on the way: it isn't encrypted",
        options.server.host));
  fmt::print("{}\n", server.address());
  std::fflush(stdout);
  if (!options.quiet && !logsEvents())
    fmt::print(stderr, "{} is shown at this address; Ctrl-C ends it\n", options.input);
  if (options.opens) openInBrowser(server.address());
  server.run();
}

void view(const CLI::App& command, CommandContext& context, const ViewCommandOptions& options) {
  std::error_code none;
  if (!std::filesystem::is_directory(options.folder, none))
    throw InputError(
        fmt::format("-o {}: no such folder; expected one where the page may save", options.folder));
  if (isExr(options.input)) {
    std::vector<std::string> paths{options.input};
    if (!options.other.empty()) paths.push_back(options.other);
    FileView files(paths, options.watch == "on");
    return serve(options,
                 {.get = {{"/state", [&] { return files.state(); }}},
                  .post = {{"/picture", [&](const std::string& body) { return files.picture(body); }},
                           {"/pick", [&](const std::string& body) { return files.pick(body); }}}});
  }
  if (!options.other.empty())
    throw InputError(fmt::format("{}: two files are compared where both are .exr", options.other));
  if (options.input == "-") throw InputError("-: the page reads a scene again, expected a file");
  startCheckedDevice(options, context, true);
  SceneView scene(context.device, sourceOf(command, options));
  serve(options, {.get = {{"/state", [&] { return scene.state(); }}},
                  .post = {{"/picture", [&](const std::string& body) { return scene.picture(body); }},
                           {"/pick", [&](const std::string& body) { return scene.pick(body); }},
                           {"/save", [&](const std::string& body) { return scene.save(body); }},
                           {"/check", [&](const std::string& body) { return scene.check(body); }}}});
}

}  // namespace

void addViewCommand(CLI::App& app, CommandContext& context) {
  CLI::App* command = app.add_subcommand(
      "view", "a page in the browser: turn and light a scene, edit its shaders; or the layers of an EXR");
  auto options = std::make_shared<ViewCommandOptions>();
  command->add_option("SCENE", options->input, "a .json, .obj, .gltf or .glb file, or an .exr")->required();
  command->add_option("OTHER", options->other, "another .exr, to compare with");
  command->add_option("-o,--output", options->folder, "the folder where the page may save")
      ->capture_default_str()
      ->type_name("FOLDER");
  command->add_option("--port", options->server.port, "of the address (default: one that is free)")
      ->check(CLI::Range(0, 65535));
  command
      ->add_option("--host", options->server.host,
                   "the address of this machine that others reach; without it, only this machine itself does")
      ->capture_default_str()
      ->type_name("ADDRESS");
  command->add_flag("--open", options->opens, "show the page in the browser at once");
  command->add_option("--watch", options->watch, "reads the scene's files again when they change")
      ->check(oneOf({"on", "off"}))
      ->capture_default_str();
  addPictureOptions(*command, *options, kOptionsOfViews | kManyPictures);
  addScreenOption(*command, *options);
  command->callback([command, &context, options] { view(*command, context, *options); });
}

}  // namespace luciole
