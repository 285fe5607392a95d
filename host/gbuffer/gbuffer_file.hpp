#pragma once

#include <string>

#include "gbuffer/gbuffer.hpp"
#include "image/image.hpp"

namespace luciole {

/// Writes a G-buffer as one EXR, all channels 32-bit float, camera in the header (worldToCamera and
/// worldToNDC as OpenEXR defines them, see camera_header.hpp), a crop as data window inside the display
/// window: P.X P.Y P.Z (world, metres), N.X N.Y N.Z (unit, world), diffuse.R/G/B, specular.R/G/B, shininess,
/// ambient.R/G/B, emission.R/G/B, Ng.X Ng.Y Ng.Z (the triangle's own normal, unit, world), lift (metres along
/// N to where shadow tests start, see raster/lift.hpp; groups that the G-buffer has), Z (metres along the
/// view axis, +inf where nothing was hit), and Pcam.X/Y/Z, Ncam.X/Y/Z: position and normal in view space as
/// the kernels had them, so that shading the file equals rendering the scene bit for bit. Where nothing was
/// hit P, N and Ng are 0. Whole file or none. `format` as in WriteOptions. Throws as writeImage does, and
/// InputError for a format other than exr.
void writeGBuffer(const GBuffer& gbuffer, const std::string& path, const Metadata& metadata,
                  const std::string& format = "");

/// Reads a G-buffer written by this program or another with OpenImageIO: the first part of the file, channels
/// in any order, case ignored, half or float; channels it doesn't know are skipped. N is required, and P or
/// (Z and a camera in the header; Z of either sign is the distance along the view axis). Missing: diffuse
/// 0.8, specular 0, shininess 0, ambient = diffuse, emission 0; Ng: no facet, and where it is no direction,
/// N; lift: none, shadow tests start at P; every other group is filled. N is made unit. Coefficients below 0
/// are 0. Pcam and Ncam are taken only with this program's own camera attributes. Without a camera in the
/// header view space is world space moved by nothing (the eye at the origin). A left-handed world gives a
/// camera that mirrors. A pixel is background where Z is not finite, or P is not finite, or N is zero or not
/// finite. Throws InputError naming the file and the channel: one component of three missing, a coefficient
/// of a surface that is not finite, a camera that is no rotation and translation.
GBuffer readGBuffer(const std::string& path);

}  // namespace luciole
