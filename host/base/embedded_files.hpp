#pragma once

#include <string_view>
#include <vector>

namespace luciole {

/// A file compiled into the program. Its views are of static memory.
struct EmbeddedFile {
  std::string_view name;
  std::string_view text;
};

/// The files of the folder kernels/.
const std::vector<EmbeddedFile>& embeddedKernels();

/// The kernels of tests/kernels that `luciole bench` compares ours with.
const std::vector<EmbeddedFile>& yardstickKernels();

/// The files of host/tools/scale/page/, of which experimentPage makes its page.
const std::vector<EmbeddedFile>& pageFiles();

/// The files of host/tools/cli/mix_page/, of which mixPage makes its page.
const std::vector<EmbeddedFile>& mixPageFiles();

/// The files of host/tools/view/page/, of which `luciole view` makes its page, and mixPage a part of its own.
const std::vector<EmbeddedFile>& viewPageFiles();

/// The files of kernels/examples/.
const std::vector<EmbeddedFile>& exampleShaderFiles();

/// The text of the file of that name. Throws std::logic_error if there is none.
std::string_view embeddedText(const std::vector<EmbeddedFile>& files, std::string_view name);

}  // namespace luciole
