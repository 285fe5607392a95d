#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cl/device.hpp"
#include "luciole/image.hpp"
#include "luciole/load_scene.hpp"
#include "render/render.hpp"

namespace luciole {

/// The options that the picture commands share, as typed.
struct PictureOptions {
  /// Those that have a NamedSetting and none of the members below.
  SettingValues settings = initialSettings();
  std::string output;
  std::string camera;
  LoadSettings load;
  bool hash = false;
  int camera_index = -1;  ///< replaces `camera`, see optionsOfCameras(); -1: doesn't
  std::string model = "phong";
  std::vector<std::string> surfaces;  ///< files
  std::string typed_shadows;          ///< what --shadows says; empty: it wasn't typed
  std::vector<std::string> screens;   ///< files
  std::string exposure;               ///< stops or "auto"; empty: see measuresExposure()
  bool require_exact = false;
  bool chooses_lights = false;  ///< the command takes --light-count auto
  std::string device;
  std::string stats;
  std::string trace;
  std::string frames;
  bool quiet = false;

  /// Of `settings`.
  const std::string& value(std::string_view name) const;
  bool isOn(std::string_view name) const;
};

/// Groups of options that a command takes, in addition to -o, --format, --compression, --stats, --trace and
/// --quiet.
enum OptionGroup : unsigned {
  kViewOptions = 1,   ///< --size, --camera, --crop, --shading
  kSampleOption = 2,  ///< --samples
  kModelOptions = 4,  ///< --model, --surface, --exposure, --dither, --tone, --bits, --half, --alpha
  kShadeOptions =
      8,  ///< --culling, --tile, --shadows, --soft-samples, --pcf-width, --shadow-memory, --shadow-size,
          ///< --light-error, --light-error-relative, --confidence, --seed, --light-groups, --aov;
          ///< with kSampleOption also --samples-shading
  kDeviceOption = 16,  ///< --device
  kFrameOption = 32,   ///< --frames
  kCastOption = 128,   ///< --cast-shadows, --light-count
  kExactOption = 512,  ///< --require-exact
  kColorOptions =
      256,  ///< instead of all others, for pictures that aren't of a scene: what a file holds of
            ///< colours (--exposure in stops, --dither, --tone, --bits, --half), without --stats and --trace
  kManyPictures = 64,  ///< for many files, so without options about one: -o, --format, --dither, --crop ...,
                       ///< and with stops alone for --exposure
};
/// Adds the options of these groups (OptionGroup, or'ed) to a command. `options` must outlive it.
void addPictureOptions(CLI::App& command, PictureOptions& options, unsigned groups);

/// Adds the option --model.
CLI::Option* addModelOption(CLI::App& command, PictureOptions& options);
/// Adds the option --surface.
void addSurfaceOption(CLI::App& command, PictureOptions& options);
/// Adds the option of a NamedSetting: --light-error for light_error.
CLI::Option* addSetting(CLI::App& command, PictureOptions& options, const char* name);
/// Adds the option --screen.
void addScreenOption(CLI::App& command, PictureOptions& options);
/// Adds the options of how a scene's files are read: --missing-textures, --strict, --search, --set.
void addLoadOptions(CLI::App& command, LoadSettings& settings);
/// These options as they would be typed.
std::vector<std::string> typedLoadOptions(const LoadSettings& settings);
/// Adds the option --threads, which limits the process's threads before the command runs.
void addThreadsOption(CLI::App& command);

/// Decides which lights cast shadows: those that --cast-shadows says; without it those that the scene marks,
/// or if it marks none, all if --shadows asks for shadows. Warns in Scene::warnings where none is left.
void castShadows(const PictureOptions& options, Scene& scene);

/// Loads the scene at a frame (see loadScene) and calls castShadows(). Writes the scene's warnings to
/// standard error unless --quiet. Throws InputError.
Scene openScene(const std::string& path, double frame, const PictureOptions& options);

/// The same for a command that lights the scene by its own lights. Also warns of Gouraud shading on triangles
/// that are too large for it (coarseTriangleWidth).
Scene openLitScene(const std::string& path, double frame, const PictureOptions& options);

/// Warns of blended materials (luciole/scene.hpp) that one sample a pixel shows as grain.
void warnOfDither(Scene& scene, const PictureOptions& options);

/// The layers that --aov names, each once. Throws InputError.
std::vector<Aov> aovsOf(const PictureOptions& options);

/// The stops that --exposure names; 0 for auto and without it.
float exposureOf(const PictureOptions& options);

/// The functions in the files that --surface names. Throws as readShader().
std::vector<Shader> surfacesOf(const PictureOptions& options);

/// Makes a scene ready for the model that --model names: adds it if it is in a file. Throws as
/// addUserModel().
void takeModel(const PictureOptions& options, Scene& scene);
/// The model that --model names, in a scene that takeModel() made ready.
Model modelOf(const PictureOptions& options, const Scene& scene);

/// The settings that the options mean for this scene. The picture's size comes from --size, else from the
/// scene, else it is 1280x720; the camera is found by name or index. Throws InputError that names the option.
RenderSettings renderSettings(const PictureOptions& options, const Scene& scene);

/// The frame that --frames names for a command that makes one picture; 1 without it. Puts its number into the
/// file names in `options`. Throws InputError.
int useFrame(PictureOptions& options, const std::string& command);

/// The options of each picture that --camera asks for: one, or for "all" one of each camera. Puts the
/// camera's name into the file names. Throws InputError, see cameraFiles().
std::vector<PictureOptions> optionsOfCameras(const PictureOptions& options, const Scene& scene);

/// Parses "a<separator>b…" into exactly `count` whole numbers. Throws InputError naming `option`.
std::vector<int> parseInts(const std::string& text, char separator, std::size_t count,
                           const std::string& option, const std::string& expected);

}  // namespace luciole
