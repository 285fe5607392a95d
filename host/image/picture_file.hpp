#pragma once

#include <OpenImageIO/imageio.h>

#include <memory>
#include <string>

#include "image/row_file.hpp"

namespace luciole {

/// A file that OpenImageIO writes. Where it can write a format through a stream of ours, rows go to the disk
/// as they come. Other formats are encoded in memory first. So is what goes to a FIFO, a device or standard
/// output, where no encoder can go back to what it wrote. Formats that take tiles only keep all rows in
/// memory until close().
class PictureFile : public RowFile {
 public:
  /// `extension`: the format's. Throws as writeImage does.
  PictureFile(const std::string& path, const std::string& extension, const OIIO::ImageSpec& spec);
  ~PictureFile() override;
  PictureFile(PictureFile&&) noexcept;

  /// The next `rows` rows, values of the spec's format. Throws MachineError.
  void write(const void* values, int rows) override;

  /// After the last row: puts the file in place. Throws as writeImage does.
  void close() override;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace luciole
