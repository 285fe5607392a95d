#include "image/oiio.hpp"

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdint>
#include <exception>
#include <new>
#include <utility>
#include <vector>

#include "base/machine_memory.hpp"
#include "base/output_file.hpp"
#include "base/picture_size.hpp"
#include "image/exr_header.hpp"
#include "image/picture_claims.hpp"
#include "image/png_input.hpp"
#include "luciole/error.hpp"

namespace luciole {
MemoryFile::MemoryFile() : descriptor_(memfd_create("luciole", MFD_CLOEXEC)) {
  if (descriptor_ < 0) throw MachineError(fmt::format("can't make a file in memory: {}", systemReason()));
}

MemoryFile::MemoryFile(std::span<const std::byte> content) : MemoryFile() {
  while (!content.empty()) {
    const ssize_t written = write(descriptor_, content.data(), content.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) throw MachineError(fmt::format("can't fill a file in memory: {}", systemReason()));
    content = content.subspan(std::size_t(written));
  }
}

MemoryFile::~MemoryFile() { close(descriptor_); }

std::string MemoryFile::path() const { return fmt::format("/proc/self/fd/{}", descriptor_); }

std::string oneLine(std::string message) {
  while (!message.empty() && std::isspace(static_cast<unsigned char>(message.back()))) message.pop_back();
  std::string line;
  for (const char c : message) {
    if (c == '\n') {
      line += "; ";
    } else if (c != '\r') {
      line += c;
    }
  }
  return line.empty() ? "unknown error" : line;
}

namespace {

/// A library's message as one line, in which a file in memory has no path.
std::string messageAbout(std::string message, const std::string& path, const std::string& name) {
  if (path == name) return oneLine(std::move(message));
  for (const std::string& called : {'"' + path + '"', path})
    for (std::size_t at; (at = message.find(called)) != std::string::npos;)
      message.replace(at, called.size(), "it");
  return oneLine(std::move(message));
}

/// Some decoders let exceptions of the standard library escape, whose messages don't help a user.
template <class Function>
auto decoded(const std::string& name, Function&& function) {
  try {
    return function();
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception&) {
    throw InputError(name + ": can't read as a picture: its decoder gave up");
  }
}

}  // namespace

std::unique_ptr<OIIO::ImageInput> openPicture(const std::string& path, const std::string& name) {
  const std::uint64_t file_length = checkPictureFile(path, name);
  checkExrHeader(path, name, kLargestSide);

  OIIO::ImageSpec config;
  config.attribute("oiio:UnassociatedAlpha", 1);
  std::unique_ptr<OIIO::ImageInput> input = openPng(path, name);
  if (!input) input = decoded(name, [&] { return OIIO::ImageInput::open(path, &config); });
  if (!input)
    throw InputError(
        fmt::format("{}: can't read as a picture: {}", name, messageAbout(OIIO::geterror(), path, name)));

  const OIIO::ImageSpec& spec = input->spec();
  checkClaims({.size = {spec.width, spec.height},
               .whole = {spec.full_width, spec.full_height},
               .channels = std::uint64_t(std::max(spec.nchannels, 0)),
               .bytes = spec.image_bytes(true),
               .file_length = file_length},
              name);
  if (spec.deep || spec.depth > 1) throw InputError(name + ": a deep or volume picture, expected a flat one");
  return input;
}

void readValues(OIIO::ImageInput& input, const std::string& name, OIIO::TypeDesc type, void* values) {
  // Of a truncated file some decoders fill the rest with grey and return success, with an error message.
  const bool read =
      decoded(name, [&] { return input.read_image(0, 0, 0, input.spec().nchannels, type, values); });
  const std::string message = input.geterror();
  if (!read || !message.empty()) throw InputError(fmt::format("{}: damaged: {}", name, oneLine(message)));
}

void checkRow(OIIO::ImageInput& input, const std::string& name, int y) {
  const OIIO::ImageSpec& spec = input.spec();
  const std::size_t values = std::size_t(spec.width) * spec.nchannels;
  requireMemory(double(values) * sizeof(float), name);
  std::vector<float> row(values);
  const bool read = decoded(name, [&] {
    return input.read_scanlines(input.current_subimage(), 0, y, y + 1, 0, 0, spec.nchannels,
                                OIIO::TypeDesc::FLOAT, row.data());
  });
  const std::string message = input.geterror();
  if (!read || !message.empty()) throw InputError(fmt::format("{}: damaged: {}", name, oneLine(message)));
}

bool isLinear(const OIIO::ImageSpec& spec) {
  const std::string space = OIIO::Strutil::lower(spec.get_string_attribute("oiio:ColorSpace"));
  return spec.format.is_floating_point() || OIIO::Strutil::starts_with(space, "lin") ||
         space == "scene_linear";
}

bool openImageIOWrites(const std::string& extension) {
  // Its outputs "term" and "null" make no file.
  if (extension.empty() || extension == "term" || extension == "null") return false;
  if (OIIO::ImageOutput::create(extension)) return true;
  OIIO::geterror();  // what it says is about plugins
  return false;
}

}  // namespace luciole
