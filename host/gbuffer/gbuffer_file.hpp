#pragma once

#include <string>

#include "gbuffer/gbuffer.hpp"
#include "image/image.hpp"

namespace luciole {

/// Writes a G-buffer as one EXR file, whole or not at all. All channels are 32-bit float; groups that the
/// G-buffer doesn't have are left out.
///
///     P.X/Y/Z, N.X/Y/Z           position (metres) and normal (unit), world space; 0 where nothing was hit
///     Z                          metres along the view axis; +inf where nothing was hit
///     Pcam.X/Y/Z, Ncam.X/Y/Z     position and normal in view space as the kernels had them, so that shading
///                                the file equals rendering the scene bit for bit
///     diffuse.R/G/B              and specular, ambient, emission alike; linear
///     shininess                  exponent
///     Ng.X/Y/Z                   the triangle's own normal, unit, world space; 0 where nothing was hit
///     lift                       metres along N to where shadow tests start (see raster/lift.hpp)
///
/// The camera is in the header, as OpenEXR's worldToCamera and worldToNDC and as our own attributes (see
/// camera_header.hpp). A crop becomes the data window inside the display window. `format` and `compression`
/// as in WriteOptions. Throws as writeImage does, and InputError for a format other than exr.
void writeGBuffer(const GBuffer& gbuffer, const std::string& path, const Metadata& metadata,
                  const std::string& format = "", const std::string& compression = "");

/// Reads a G-buffer from the first part of a file that this program or another wrote, in any format that
/// OpenImageIO reads. Channels may be in any order and case; unknown ones are skipped.
///
/// N is required, and P, or else Z and a camera of a centred projection in the header (Z of either sign: the
/// distance along the view axis). Pcam and Ncam are used only with this program's own camera attributes. N is
/// normalized. A pixel is background where Z is not finite, or P is not finite, or N is zero or not finite.
/// Coefficients below 0 become 0. Missing channels read as: diffuse 0.8, specular 0, shininess 0, ambient =
/// diffuse. Without emission, Ng or lift these groups stay empty; without lift shadow tests start at P.
/// Where Ng is zero or not finite, N takes its place.
///
/// Without a camera in the header view space is world space: the eye is at the origin. A left-handed world
/// gives a camera that mirrors.
///
/// Throws InputError naming the file and the channel where some of three components are missing, or a
/// coefficient of a surface isn't finite, or the camera is no rotation and translation; MachineError where
/// the picture doesn't fit into memory.
GBuffer readGBuffer(const std::string& path);

}  // namespace luciole
