#pragma once

#include <OpenImageIO/imageio.h>

#include <memory>
#include <string>

namespace luciole {

/// Opens a PNG file, by what is in it; empty where it is none. libpng reads it, told to keep its errors:
/// under OpenImageIO's own reader it prints them. Pixels, channels, colour space and texts are what that
/// reader gives of colours that are not multiplied by alpha. Throws InputError that begins with `name`.
std::unique_ptr<OIIO::ImageInput> openPng(const std::string& path, const std::string& name);

}  // namespace luciole
