#pragma once

#include <OpenImageIO/imageio.h>

#include <cstddef>
#include <memory>
#include <span>
#include <string>

#include "image/file_format.hpp"

// OpenImageIO helpers that the sources of this folder share. Nothing outside the folder includes this.
namespace luciole {

/// A nameless file in memory that any library can open by its path, as long as this object lives. For formats
/// that OpenImageIO can't read from memory or write to it.
class MemoryFile {
 public:
  MemoryFile();  ///< throws MachineError
  /// Holds a copy of `content`. Throws MachineError.
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

/// Opens the first picture of a file, with colours that are not multiplied by alpha. Before anything is
/// allocated it checks the size: kLargestSide for the pixels and for the whole picture that they are part of,
/// at most 2³¹ values, and no more than a file of this length can hold. `name` is for messages. Throws
/// InputError.
std::unique_ptr<OIIO::ImageInput> openPicture(const std::string& path, const std::string& name);

/// Reads the open picture as `type` into `values`, width × height × channels of them. Throws InputError.
void readValues(OIIO::ImageInput& input, const std::string& name, OIIO::TypeDesc type, void* values);

/// Reads a row of the open picture, counted as its data window does, to see whether it is there. Throws
/// InputError.
void checkRow(OIIO::ImageInput& input, const std::string& name, int y);

/// Whether colours are stored as linear light: float formats, and integer ones that say so.
bool isLinear(const OIIO::ImageSpec& spec);

}  // namespace luciole
