#pragma once

#include <OpenImageIO/imageio.h>

#include <cstddef>
#include <memory>
#include <span>
#include <string>

#include "image/file_format.hpp"

// What the sources of this folder share of OpenImageIO. Nothing outside the folder includes this.
namespace luciole {

/// A nameless file in memory that any library can open by its path. Formats OpenImageIO can't read from or
/// write to memory work through it.
class MemoryFile {
 public:
  MemoryFile();  ///< throws MachineError
  explicit MemoryFile(std::span<const std::byte> content);
  ~MemoryFile();
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  std::string path() const;
  int descriptor() const { return descriptor_; }

 private:
  int descriptor_;
};

/// An OpenImageIO message as one line.
std::string oneLine(std::string message);

/// Opens the first picture of a file whose colours are not to be multiplied by its alpha, and checks its size
/// (kLargestSide of the pixels and of the whole picture that they are part of, 2³¹ values, no more than a
/// file of its length can hold) before anything is allocated. `name` is for messages. Throws InputError.
std::unique_ptr<OIIO::ImageInput> openPicture(const std::string& path, const std::string& name);

/// Reads the open picture as `type` into `values`, width × height × channels of them. Throws InputError.
void readValues(OIIO::ImageInput& input, const std::string& name, OIIO::TypeDesc type, void* values);

/// Whether colours are stored as linear light: float formats, and integer ones that say so.
bool isLinear(const OIIO::ImageSpec& spec);

}  // namespace luciole
