#pragma once

#include <ImfHeader.h>
#include <ImfInputPart.h>

#include <string>
#include <vector>

// Only exr_input.cpp includes this.
namespace luciole {

/// A channel that is wanted: its name, and where its plane begins.
struct WantedChannel {
  std::string name;
  float* plane;  ///< the data window's pixels, row by row
};

/// Whether readZip() can read a part: its pixels lie in rows that are compressed by zip, every channel at
/// full resolution.
bool isZip(const Imf::Header& header);

/// Reads channels of such a part. The OpenEXR library finds the blocks of rows, and ISA-L decompresses them,
/// twice as fast as the library's zlib. Throws what the library does, and std::runtime_error where a block is
/// damaged.
void readZip(Imf::InputPart& part, const std::vector<WantedChannel>& wanted);

}  // namespace luciole
