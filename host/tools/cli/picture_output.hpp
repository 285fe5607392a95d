#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "cl/device.hpp"
#include "lighting/stats.hpp"
#include "luciole/gbuffer.hpp"
#include "luciole/image.hpp"
#include "luciole/scene.hpp"
#include "tools/cli/picture_options.hpp"
#include "tools/viewing/shown_layer.hpp"

namespace luciole {

/// Whether the picture's exposure is to be measured: with --exposure auto, and without --exposure for a mesh
/// file (.obj, .gltf, .glb), whose lights may be of any strength, in a picture of integers.
bool measuresExposure(const PictureOptions& options, const std::string& scene_path);

/// The options of the picture's file, without camera, size and crop.
WriteOptions fileOptions(const PictureOptions& options);

/// Throws InputError where the trace or the hash would be written into another file of the picture's.
void checkOtherOutputs(const PictureOptions& options);

/// Checks the output's options before any work: extension, folder, layers, tone, and others that the format
/// doesn't support. Throws InputError.
void checkOutput(const PictureOptions& options);

/// The same for `what`, a file of data ("a G-buffer"), which no compression may change.
void checkDataOutput(const PictureOptions& options, const std::string& what);

/// How to write a picture that this camera sees, or the part of it that starts at crop_origin.
WriteOptions writeOptions(const PictureOptions& options, const std::optional<Camera>& camera,
                          glm::ivec2 picture_size, glm::ivec2 crop_origin);
/// How to write the picture of all pixels of a G-buffer.
WriteOptions writeOptions(const PictureOptions& options, const GBuffer& gbuffer);

/// Adds to the statistics how far 16-bit floats round colours, and warns of pixels that were too bright for
/// the file. limited: as writeImage returns.
void reportHalves(const PictureOptions& options, std::uint64_t limited, Stats& stats);

/// Tells of what shaders gave that is no light, no surface or no colour, with the counts, on standard error
/// unless --quiet and in the statistics.
void reportFaults(const PictureOptions& options, Stats& stats);

/// Warns if bounds of --light-error are larger than allowed, because rounding of floats exceeds it.
void reportLightError(const PictureOptions& options, Stats& stats);

/// Whether the file's format has no layers, so that it shows the one that --aov names.
bool showsAov(const PictureOptions& options);

/// Writes a layer as a picture to look at (see layerPicture), light with the exposure of the options. layer:
/// its channels alone. Tells what its colours mean where it doesn't itself, unless --quiet. device: as below.
void writeLayerPicture(const PictureOptions& options, const ShownLayer& shown, Image layer,
                       const Stats& stats, const OpenedDevice* device);

/// The same of the layer that --aov names, of a picture that was made with it.
void writeAov(const PictureOptions& options, const Image& picture, const Stats& stats,
              const OpenedDevice* device);

/// Text attributes for the picture's file: software, command, the exposure if it was measured, and device.
/// device: null if none was used.
Metadata pictureMetadata(const Stats& stats, const OpenedDevice* device);

/// The initial statistics of a picture that begins now, after others.
Stats laterStats(const std::string& command);

/// Writes the statistics to the file that --stats names, if any. Unless --quiet, writes a line to standard
/// error that says what was made and what it cost. In an event log that is an event for each stage of the
/// frame, and one for the frame.
void reportStats(const PictureOptions& options, const Stats& stats, int frame);

}  // namespace luciole
