#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <optional>
#include <random>

#include "base/machine_memory.hpp"
#include "image/file_format.hpp"
#include "luciole/error.hpp"
#include "luciole/gbuffer_file.hpp"
#include "reference/gbuffer_check.hpp"
#include "reference/reference_picture.hpp"
#include "render/change_surfaces.hpp"
#include "render/memory.hpp"
#include "scene/scene_digest.hpp"
#include "tools/cli/commands.hpp"
#include "tools/cli/event_log.hpp"
#include "tools/cli/picture_options.hpp"
#include "tools/cli/picture_output.hpp"
#include "tools/cli/progress.hpp"
#include "tools/cli/suggest.hpp"

namespace luciole {
namespace {

struct ReferenceOptions : PictureOptions {
  std::string scene;             ///< what is shown
  std::string gbuffer;           ///< or a file of surfaces, and
  std::string lights;            ///< the scene that lights them
  std::string shadows = "rays";  ///< or "off"
  int shadow_samples = 64;
  int frame = 1;
  std::size_t pixels = 0;  ///< 0: all
  std::uint64_t seed = 0;
};

/// Attributes of the picture's file that tell a later run what it holds.
constexpr const char* kRequest = "luciole:reference";
constexpr const char* kWindow = "luciole:window";

/// Bytes of memory for a pixel: in the G-buffer, its place, a colour and the sum of colours, in the picture;
/// and under --alpha two coverages and the picture's.
constexpr double kBytesPerPixel =
    kGBufferBytesPerPixel + sizeof(glm::ivec2) + 2 * sizeof(glm::dvec3) + 3 * sizeof(float);
constexpr double kAlphaBytesPerPixel = 2 * sizeof(double) + sizeof(float);

/// A part of a larger picture, and where in that it lies.
struct Piece {
  Image image;
  Crop window;
};

/// The functions of --surface, which run on a device. What they change is lit in double.
struct SurfaceChange {
  OpenedDevice& device;
  Stats& stats;
  SurfaceProgram program;

  /// Opens the device if there are functions.
  SurfaceChange(const ReferenceOptions& options, OpenedDevice& on, Stats& of_picture)
      : device(on), stats(of_picture), program(surfaceProgram(surfacesOf(options))) {
    if (!program.user_text.empty() && !device.context()) openDevice("", device);
  }
};

/// rays: of the scene; empty without shadows. The settings refer to all arguments, which must outlive them.
ReferenceSettings referenceSettings(const ReferenceOptions& options, const Scene& scene,
                                    const std::optional<RayScene>& rays, SurfaceChange& change,
                                    ProgressLine& progress) {
  ReferenceSettings settings;
  if (!change.program.user_text.empty()) {
    addGroups(change.program, settings.surface_planes);
    settings.surface_planes.unbent_normal = change.program.changes(kNormalGroup);
    settings.change_surfaces = [&](GBuffer& gbuffer) {
      changeSurfaces(change.device, change.program, gbuffer, change.stats);
    };
  }
  settings.model = modelOf(options, scene);
  settings.shadow_rays = rays ? &*rays : nullptr;
  settings.shadow_samples = options.shadow_samples;
  settings.on_progress = [&](std::size_t done, std::size_t pixels) {
    progress.show(std::filesystem::path(options.output).filename(), done, pixels);
  };
  return settings;
}

std::optional<RayScene> shadowRays(const ReferenceOptions& options, const Scene& scene,
                                   const Camera& camera) {
  if (options.shadows != "rays") return std::nullopt;
  return buildShadowRays(scene, glm::dvec3(camera.camera_to_world[3]));
}

/// All pixels of a picture row by row if `count` is 0, otherwise `count` different ones in the same order.
std::vector<glm::ivec2> choosePixels(const glm::ivec2& size, std::size_t count, std::uint64_t seed) {
  const std::vector<glm::ivec2> all = allPixels(size);
  if (count == 0) return all;
  std::vector<glm::ivec2> chosen;
  std::sample(all.begin(), all.end(), std::back_inserter(chosen), count, std::mt19937_64(seed));
  return chosen;
}

/// A picture with channels R G B, A unless `coverage` is empty, and `sampled` unless it has all pixels.
/// colors and coverage: one for each of `pixels`; exposure: stops.
Image makePicture(const glm::ivec2& size, const std::vector<glm::ivec2>& pixels,
                  const std::vector<glm::dvec3>& colors, const std::vector<double>& coverage,
                  double exposure) {
  const bool sparse = pixels.size() < std::size_t(size.x) * size.y;
  Image image{size.x, size.y, {"R", "G", "B"}, {}};
  if (!coverage.empty()) image.channels.push_back("A");
  if (sparse) image.channels.push_back("sampled");
  const std::size_t channels = image.channels.size();
  image.pixels.resize(std::size_t(size.x) * size.y * channels);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    float* pixel = image.pixels.data() + (std::size_t(pixels[i].y) * size.x + pixels[i].x) * channels;
    for (int c = 0; c < 3; ++c) pixel[c] = pictureValue(colors[i][c] * std::exp2(exposure));
    if (!coverage.empty()) pixel[3] = float(coverage[i]);
    if (sparse) pixel[channels - 1] = 1;
  }
  return image;
}

/// A text that is equal for two crops if they are parts of the same picture.
std::string requestText(const ReferenceOptions& options, const Scene& scene, const RenderSettings& settings) {
  return fmt::format(
             "{} {:016x} frame {} {}x{} camera '{}' samples {} shading {} model {} shadows {} {} exposure "
             "{}{}{}",
             options.scene, sceneDigest(scene), options.frame, settings.size.x, settings.size.y,
             settings.camera.name, settings.samples, options.value("shading"), options.model, options.shadows,
             options.shadow_samples, settings.exposure, options.isOn("alpha") ? " alpha" : "",
             options.isOn("half") ? " half" : "") +
         surfaceProgram(settings.surfaces).user_text;
}

/// The union of two rectangles if it is a rectangle.
std::optional<Crop> unite(const Crop& a, const Crop& b) {
  const int left = std::min(a.x, b.x), top = std::min(a.y, b.y);
  const int right = std::max(a.x + a.width, b.x + b.width), bottom = std::max(a.y + a.height, b.y + b.height);
  const Crop box{left, top, right - left, bottom - top};
  const std::int64_t common_width = std::max(0, std::min(a.x + a.width, b.x + b.width) - std::max(a.x, b.x));
  const std::int64_t common_height =
      std::max(0, std::min(a.y + a.height, b.y + b.height) - std::max(a.y, b.y));
  const auto area = [](const Crop& crop) { return std::int64_t(crop.width) * crop.height; };
  if (area(a) + area(b) - common_width * common_height != area(box)) return std::nullopt;
  return box;
}

void paste(const Piece& from, Piece& to) {
  const std::size_t channels = to.image.channels.size();
  for (int y = 0; y < from.window.height; ++y) {
    const float* row = from.image.pixels.data() + std::size_t(y) * from.window.width * channels;
    const std::size_t place =
        std::size_t(from.window.y + y - to.window.y) * to.window.width + (from.window.x - to.window.x);
    std::copy_n(row, from.window.width * channels, to.image.pixels.begin() + place * channels);
  }
}

/// The part of the same picture, of a scene that hasn't changed, that the output file already holds: so a
/// long reference can be made crop by crop. Throws InputError if it and `crop` don't make a rectangle
/// together.
std::optional<Piece> findEarlierPiece(const ReferenceOptions& options, const std::string& request,
                                      const Crop& crop) {
  namespace fs = std::filesystem;
  std::error_code none;
  if (options.pixels > 0 || !fs::is_regular_file(options.output, none)) return std::nullopt;
  // Colours that were divided by A and rounded don't come back.
  if (options.isOn("alpha") && !pictureFormat(options.output, fileOptions(options)).is_float)
    return std::nullopt;
  if (readAttribute(options.output, kRequest) != request) return std::nullopt;
  const std::vector<int> window =
      parseInts(readAttribute(options.output, kWindow), ',', 4, options.output, "a window X,Y,W,H");
  Piece piece{readImage(options.output), {window[0], window[1], window[2], window[3]}};
  if (piece.image.channels.size() != (options.isOn("alpha") ? 4 : 3)) return std::nullopt;
  if (!unite(piece.window, crop))
    throw InputError(fmt::format(
        "--crop {},{},{},{}: makes no rectangle with the part {},{},{},{} that {} holds "
        "of this picture",
        crop.x, crop.y, crop.width, crop.height, window[0], window[1], window[2], window[3], options.output));
  return piece;
}

Piece joinPieces(const Piece& earlier, const Piece& later) {
  const Crop window = *unite(earlier.window, later.window);
  Piece joined{{window.width, window.height, later.image.channels, {}}, window};
  joined.image.pixels.resize(std::size_t(window.width) * window.height * later.image.channels.size());
  paste(earlier, joined);
  paste(later, joined);
  return joined;
}

/// What shows no surface is black under --alpha: A tells it apart.
void removeBackground(const ReferenceOptions& options, Scene& scene) {
  if (options.isOn("alpha")) scene.background = glm::vec3(0.0f);
}

void reportCheck(const ReferenceOptions& options, const GBufferCheck& check, Stats& stats) {
  stats.counts.emplace_back("gbuffer_pixels_checked", check.pixels);
  stats.counts.emplace_back("gbuffer_pixels_beside_edges", check.beside_edges);
  stats.counts.emplace_back("gbuffer_pixels_at_ties", check.at_ties);
  stats.counts.emplace_back("gbuffer_pixels_unexplained", check.unexplained);
  stats.errors.emplace_back("gbuffer_position", check.position_error);
  stats.errors.emplace_back("gbuffer_normal", check.normal_error);
  if (check.bent_normal_error > 0) stats.errors.emplace_back("gbuffer_bent_normal", check.bent_normal_error);
  stats.errors.emplace_back("gbuffer_lift", check.lift_error);
  if (logsEvents()) {
    logEvent("gbuffer_checked", {{"pixels", check.pixels},
                                 {"beside_edges", check.beside_edges},
                                 {"at_ties", check.at_ties},
                                 {"unexplained", check.unexplained},
                                 {"position_error", check.position_error},
                                 {"normal_error", check.normal_error},
                                 {"bent_normal_error", check.bent_normal_error}});
    return;
  }
  if (options.quiet) return;
  writeError(fmt::format(
      "G-buffer against rays: position within {:.1e}, normal within {:.1e} rad; of {} pixels {} show "
      "another surface within 1/256 pixel of an edge, {} one at the same depth, {} any other\n",
      check.position_error, check.normal_error, check.pixels, check.beside_edges, check.at_ties,
      check.unexplained));
}

/// Makes the reference picture of a scene, and compares the rasterizer's G-buffer with rays.
void referenceOfScene(const ReferenceOptions& options, const Scene& scene, OpenedDevice& device,
                      Stats& stats) {
  SurfaceChange change(options, device, stats);
  RenderSettings settings = renderSettings(options, scene);
  if (measuresExposure(options, options.scene)) {
    stats.measured_exposure = timed(stats, Stage::kMeasureExposure, [&] {
      const auto rays = shadowRays(options, scene, settings.camera);
      ProgressLine progress(options.quiet);
      const double stops = referenceExposure(scene, settings.camera, settings.size, settings.shading,
                                             referenceSettings(options, scene, rays, change, progress));
      progress.clear();
      return stops;
    });
    settings.exposure = float(*stats.measured_exposure);
  }
  const View view = cameraView(settings.camera, settings.size, settings.crop);
  const Crop window{view.crop_origin.x, view.crop_origin.y, view.crop_size.x, view.crop_size.y};
  const std::string request = requestText(options, scene, settings);
  std::optional<Piece> earlier;
  if (settings.crop) earlier = findEarlierPiece(options, request, window);

  const double pixel_bytes = kBytesPerPixel + (options.isOn("alpha") ? kAlphaBytesPerPixel : 0);
  requireMemory(pixel_bytes * view.crop_size.x * view.crop_size.y,
                fmt::format("a reference of {}x{} pixels", view.crop_size.x, view.crop_size.y));
  const std::vector<glm::ivec2> pixels = choosePixels(view.crop_size, options.pixels, options.seed);
  const GBufferCheck check = timed(stats, Stage::kCheckGBuffer, [&] {
    const GBuffer gbuffer = rasterize(scene, allObjects(scene), view, Shading::kPhong, {.lift = true});
    return checkGBuffer(scene, view, gbuffer, pixels);
  });
  const std::vector<glm::dvec3> colors = timed(stats, Stage::kShade, [&] {
    const auto rays = shadowRays(options, scene, settings.camera);
    ProgressLine progress(options.quiet);
    auto shaded = referencePicture(scene, view, settings.shading, settings.samples, pixels,
                                   referenceSettings(options, scene, rays, change, progress));
    progress.clear();
    return shaded;
  });
  const std::vector<double> coverage = options.isOn("alpha")
                                           ? referenceCoverage(scene, view, settings.samples, pixels)
                                           : std::vector<double>{};
  Piece piece{makePicture(view.crop_size, pixels, colors, coverage, settings.exposure), window};
  if (earlier) piece = joinPieces(*earlier, piece);

  Metadata metadata = pictureMetadata(stats, nullptr);
  metadata.emplace_back(kRequest, request);
  metadata.emplace_back(kWindow, fmt::format("{},{},{},{}", piece.window.x, piece.window.y,
                                             piece.window.width, piece.window.height));
  const std::uint64_t limited = timed(stats, Stage::kWrite, [&] {
    return writeImage(
        piece.image, options.output, metadata,
        writeOptions(options, settings.camera, settings.size, {piece.window.x, piece.window.y}));
  });
  describeScene(scene, {}, stats);
  reportHalves(options, limited, stats);
  reportFaults(options, stats);
  stats.width = view.crop_size.x;
  stats.height = view.crop_size.y;
  stats.samples = settings.samples;
  stats.counts.emplace_back("pixels_shaded", pixels.size() * settings.samples);
  reportCheck(options, check, stats);
}

/// Makes the reference picture of a G-buffer file.
void referenceOfGBuffer(const ReferenceOptions& options, OpenedDevice& device, Stats& stats) {
  SurfaceChange change(options, device, stats);
  Scene scene =
      timed(stats, Stage::kLoadScene, [&] { return openScene(options.lights, options.frame, options); });
  removeBackground(options, scene);
  GBuffer gbuffer = timed(stats, Stage::kReadGBuffer, [&] { return readGBuffer(options.gbuffer); });
  prepareForSurfaces(change.program, gbuffer);
  changeSurfaces(device, change.program, gbuffer, stats);
  const glm::ivec2 size(gbuffer.width, gbuffer.height);
  const std::vector<glm::ivec2> pixels = choosePixels(size, options.pixels, options.seed);
  const std::vector<glm::dvec3> colors = timed(stats, Stage::kShade, [&] {
    const auto rays = shadowRays(options, scene, gbuffer.camera);
    ProgressLine progress(options.quiet);
    auto shaded =
        referencePixels(scene, gbuffer, pixels, referenceSettings(options, scene, rays, change, progress));
    progress.clear();
    return shaded;
  });
  float exposure = renderSettings(options, scene).exposure;
  if (measuresExposure(options, options.lights)) {
    stats.measured_exposure = referenceExposure(gbuffer, pixels, colors);
    exposure = float(*stats.measured_exposure);
  }
  const std::vector<double> coverage =
      options.isOn("alpha") ? referenceCoverage(gbuffer, pixels) : std::vector<double>{};
  const std::uint64_t limited = timed(stats, Stage::kWrite, [&] {
    return writeImage(makePicture(size, pixels, colors, coverage, exposure), options.output,
                      pictureMetadata(stats, nullptr), writeOptions(options, gbuffer));
  });
  describeScene(scene, {}, stats);
  reportHalves(options, limited, stats);
  reportFaults(options, stats);
  stats.width = gbuffer.width;
  stats.height = gbuffer.height;
  stats.counts.emplace_back("pixels_shaded", pixels.size());
}

void checkOptions(const ReferenceOptions& options) {
  checkDataOutput(options, "a reference");
  if (options.scene.empty() == options.gbuffer.empty())
    throw InputError("reference: expected a scene, or --gbuffer with --scene");
  if (options.gbuffer.empty() != options.lights.empty())
    throw InputError("reference: --gbuffer and --scene go together");
  const bool of_view = !options.value("size").empty() || !options.camera.empty() ||
                       !options.value("crop").empty() || options.value("samples") != "1" ||
                       options.value("shading") != "phong";
  if (!options.gbuffer.empty() && of_view)
    throw InputError("reference: a G-buffer has its size, camera, crop, shading and samples already");
  if (options.pixels > 0 && outputFormat(options.output, options.value("format")).extension != "exr")
    throw InputError(
        fmt::format("--pixels: {} cannot say which pixels it holds, an .exr can", options.output));
}

}  // namespace

void addReferenceCommand(CLI::App& app, CommandContext& context) {
  CLI::App* command = app.add_subcommand(
      "reference", "the same picture in double precision: every light on every pixel, shadows by ray");
  auto options = std::make_shared<ReferenceOptions>();
  command->add_option("SCENE", options->scene,
                      "a .json, .obj, .gltf or .glb file (- : JSON on standard input)");
  command->add_option("--gbuffer", options->gbuffer, "an EXR whose surfaces to light instead");
  command->add_option("--scene", options->lights, "with --gbuffer: the scene that lights it");
  addPictureOptions(*command, *options,
                    kViewOptions | kSampleOption | kModelOptions | kCastOption | kFrameOption);
  command->add_option("--shadows", options->shadows, "by a ray to each light, or none")
      ->check(oneOf({"off", "rays"}))
      ->each([options](const std::string& method) { options->typed_shadows = method; })
      ->capture_default_str();
  command
      ->add_option("--shadow-samples", options->shadow_samples,
                   "rays from a pixel to a light that has a size (others need one)")
      ->check(CLI::Range(1, 1 << 20))
      ->capture_default_str();
  command->add_option("--pixels", options->pixels,
                      "only so many pixels, chosen at random; compare looks at those only");
  command->add_option("--seed", options->seed, "which ones")->capture_default_str();
  command->callback([&context, options] {
    options->frame = useFrame(*options, "reference");
    checkOptions(*options);
    Stats stats;
    stats.command = context.command_line;
    logEvent("frame_begun", {{"frame", options->frame}});
    if (!options->gbuffer.empty()) {
      referenceOfGBuffer(*options, context.device, stats);
      reportStats(*options, stats, options->frame);
      return;
    }
    Scene scene = timed(stats, Stage::kLoadScene,
                        [&] { return openLitScene(options->scene, options->frame, *options); });
    warnOfDither(scene, *options);
    removeBackground(*options, scene);
    for (const PictureOptions& picture : optionsOfCameras(*options, scene)) {
      checkOutput(picture);
      static_cast<PictureOptions&>(*options) = picture;
      referenceOfScene(*options, scene, context.device, stats);
      reportStats(picture, stats, options->frame);
      stats = laterStats(context.command_line);
    }
  });
}

}  // namespace luciole
