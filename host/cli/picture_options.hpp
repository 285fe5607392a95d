#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "cl/device.hpp"
#include "image/image.hpp"
#include "load/load_scene.hpp"
#include "render/render.hpp"

namespace luciole {

/// The options that the picture commands share, as typed.
struct PictureOptions {
  std::string output;
  std::string format;
  std::string size;
  std::string camera;
  int samples = 1;
  std::string crop;
  std::string shading = "phong";
  std::string model = "phong";
  std::string culling = "auto";
  int tile = ShadeSettings{}.tile_size;
  std::string shadows = "hard";
  bool shadows_given = false;  ///< --shadows was typed
  std::string apply_shadows;   ///< empty: see openScene()
  int pcf_width = ShadeSettings{}.pcf_width;
  int shadow_memory = int(ShadowLimits{}.bytes >> 20);  ///< MiB
  int shadow_size = ShadowLimits{}.size;
  std::string aovs;
  double exposure = 0;
  std::string dither = "on";
  std::string device;
  std::string missing_textures = "error";
  std::string stats;
  std::string frames;
  bool quiet = false;
};

/// Which of them a command takes, beside the output, --format, --stats and --quiet.
enum OptionGroup : unsigned {
  kViewOptions = 1,    ///< --size, --camera, --crop, --shading
  kSampleOption = 2,   ///< --samples
  kModelOptions = 4,   ///< --model, --exposure, --dither
  kShadeOptions = 8,   ///< --culling, --tile, --shadows, --pcf-width, --shadow-memory, --shadow-size, --aov
  kDeviceOption = 16,  ///< --device
  kFrameOption = 32,   ///< --frames
  kCastOption = 128,   ///< --cast-shadows
  kManyPictures = 64,  ///< without what is about one file: -o, --format, --dither, --stats, --crop, --aov
};
void addPictureOptions(CLI::App& command, PictureOptions& options, unsigned groups);

/// The option --shadows of a command, which has values of its own.
CLI::Option* addShadowsOption(CLI::App& command, PictureOptions& options, const std::string& help,
                              const std::vector<std::string>& values);
/// --cast-shadows, and --missing-textures.
void addCastShadowsOption(CLI::App& command, PictureOptions& options);
void addMissingTexturesOption(CLI::App& command, std::string& value);
MissingTextures missingTexturesOf(const std::string& value);

/// Loads the scene at a frame (see loadScene), lets its lights cast shadows as --cast-shadows says, or else
/// those that it marks, or else all where --shadows asks for shadows, and tells its warnings, unless --quiet.
Scene openScene(const std::string& path, double frame, const PictureOptions& options);

/// The same for a command that shows the scene by its own lights: tells as well where --shading doesn't suit
/// it.
Scene openLitScene(const std::string& path, double frame, const PictureOptions& options);

/// What --model says.
Model modelOf(const PictureOptions& options);

/// Turns them into settings for this scene: the picture's size from --size, the scene or 1280x720; the camera
/// by name or index. Throws InputError naming the option.
RenderSettings renderSettings(const PictureOptions& options, const Scene& scene);

/// Checks what can be checked of the output before any work is done: extension, folder, layers. Throws
/// InputError.
void checkOutput(const PictureOptions& options);

/// The frame that --frames names for a command that makes one picture (1 without), whose number goes into the
/// names of its files. Throws InputError.
int useFrame(PictureOptions& options, const std::string& command);

/// How to write a picture, or part of one, that this camera sees.
WriteOptions writeOptions(const PictureOptions& options, const std::optional<Camera>& camera,
                          glm::ivec2 picture_size, glm::ivec2 crop_origin);
/// The same of all the pixels of a G-buffer.
WriteOptions writeOptions(const PictureOptions& options, const GBuffer& gbuffer);

/// Text attributes for the picture: software, command and device.
Metadata pictureMetadata(const std::string& command_line, const Device* device);

/// Writes --stats, if asked for, and unless --quiet one line on standard error that says what was made and
/// what it cost.
void reportStats(const PictureOptions& options, const Stats& stats);

/// The parts between separators, of which there may be none.
std::vector<std::string> split(const std::string& text, char separator);

/// Parses "a<separator>b…" into exactly `count` whole numbers. Throws InputError naming `option`.
std::vector<int> parseInts(const std::string& text, char separator, std::size_t count,
                           const std::string& option, const std::string& expected);

}  // namespace luciole
