#pragma once

#include <OpenImageIO/imageio.h>

#include <memory>
#include <string>

namespace luciole {

/// Opens a PNG file, which is recognized by its signature; null for any other file. It calls libpng itself,
/// because under OpenImageIO's reader libpng prints its errors. Pixels, channels, colour space and texts are
/// those of OpenImageIO's reader where colours are not multiplied by alpha. Throws InputError, whose message
/// begins with `name`.
std::unique_ptr<OIIO::ImageInput> openPng(const std::string& path, const std::string& name);

}  // namespace luciole
