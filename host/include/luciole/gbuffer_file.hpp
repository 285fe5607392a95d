#pragma once

#include <functional>
#include <string>

#include "luciole/gbuffer.hpp"
#include "luciole/image.hpp"

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
///     Nunbent.X/Y/Z              instead, where there are normal maps: N before a map bent it
///     lift                       metres along N to where shadow tests start (see GBuffer::lift)
///     model                      modelNumber() of a surface's own model, if any surface has one: 0 none, 1
///     phong,
///                                2 blinn-phong, 3 toon, 4 cook-torrance, 5 oren-nayar, 6 ward
///
/// The camera is in the header, as OpenEXR's worldToCamera and worldToNDC, and with all digits in attributes
/// luciole:cameraToWorld, luciole:projection, luciole:lens and luciole:cameraName. A crop becomes the data
/// window inside the display window. `format` and `compression` as in WriteOptions. Throws as writeImage
/// does, and InputError for a format other than exr.
void writeGBuffer(const GBuffer& gbuffer, const std::string& path, const Metadata& metadata,
                  const std::string& format = "", const std::string& compression = "");

/// Calls take(rows) for all pixels, some rows at a time, with the channels that writeGBuffer() writes.
void passRows(const GBuffer& gbuffer, const std::function<void(const Image& rows)>& take);

/// Reads a G-buffer from an EXR that writeGBuffer() or another program wrote. Layers are recognized by the
/// names that Blender, Mitsuba, pbrt, RenderMan, Arnold and 3Delight give them. Missing ones read as: normals
/// rebuilt from positions, positions from the depth, diffuse 0.8, specular 0, ambient = diffuse. Throws
/// InputError, which names the file and the channel, and MachineError where it doesn't fit into memory.
GBuffer readGBuffer(const std::string& path);

}  // namespace luciole
