#pragma once

#include <string_view>
#include <vector>

namespace luciole {

/// A file that travels inside the program, as it was when the program was built.
struct EmbeddedFile {
  std::string_view name;
  std::string_view text;
};

/// The files of the folder kernels/.
const std::vector<EmbeddedFile>& embeddedKernels();

/// The kernels of tests/kernels that `luciole bench` holds ours against.
const std::vector<EmbeddedFile>& yardstickKernels();

/// What experimentPage makes its page of: host/scale/page/.
const std::vector<EmbeddedFile>& pageFiles();

/// The text of one of them. Throws std::logic_error for a name that isn't there.
std::string_view embeddedText(const std::vector<EmbeddedFile>& files, std::string_view name);

}  // namespace luciole
