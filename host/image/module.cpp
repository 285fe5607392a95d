#include "image/module.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <utility>

#include "base/machine_memory.hpp"
#include "base/threads.hpp"
#include "base/trace.hpp"
#include "image/file_format.hpp"
#include "image/float_file.hpp"
#include "image/quick_texture.hpp"
#include "luciole/error.hpp"

namespace luciole {
namespace {

/// The module lies in a folder beside the library, which links to it don't change. The path is absolute,
/// because the loader loses its search path under the address sanitizer.
std::string modulePath() {
  Dl_info library;
  dladdr(reinterpret_cast<const void*>(&modulePath), &library);
  return std::filesystem::canonical(library.dli_fname).replace_filename(LUCIOLE_IMAGE_MODULE);
}

/// The least that OpenImageIO and its libraries need. Measured by `ulimit -v`: with 440 MiB loading hung,
/// with 480 to 540 MiB it failed, with 580 MiB it worked; 80 MiB of each were this program's own.
constexpr double kModuleBytes = 32 << 20, kModuleAddresses = 500 << 20, kModuleData = 64 << 20;

/// dlopen(). An exception of what starts in these libraries would leave the loader's lock taken, for which
/// the next call of the loader waits for ever: it ends the program.
void* openModule(const char* path) noexcept { return dlopen(path, RTLD_NOW | RTLD_LOCAL); }

const ImageFunctions& load() {
  const TraceSpan span("load OpenImageIO");
  constexpr const char* kWhat = "reading and writing pictures";
  requireMemory(kModuleBytes, kWhat);
  requireMappings(kModuleAddresses, kModuleData, threadCount(), kWhat);
  void* module = openModule(modulePath().c_str());
  void* functions = module ? dlsym(module, "luciole_image_functions") : nullptr;
  if (!functions)
    throw MachineError(fmt::format("can't load the part that reads and writes pictures: {}", dlerror()));
  const ImageFunctions& all = *static_cast<const ImageFunctions*>(functions);
  all.use_cleanups(cleanups());
  return all;
}

const ImageFunctions& functions() {
  static const ImageFunctions& loaded = load();
  return loaded;
}

}  // namespace

Image readImage(const std::string& path) {
  std::optional<Image> array = readNpy(path);
  return array ? std::move(*array) : functions().read_image(path);
}

std::string readAttribute(const std::string& path, const std::string& name) {
  return formatName(path) == "npy" ? "" : functions().read_attribute(path, name);
}

std::unique_ptr<RowFile> openPictureFile(const std::string& path, int width, int height,
                                         const std::vector<std::string>& channels, const FileFormat& format,
                                         const Metadata& metadata, const WriteOptions& options) {
  return functions().open_picture_file(path, width, height, channels, format, metadata, options);
}

std::vector<PicturePart> readParts(const std::string& path) {
  const std::optional<Image> array = readNpy(path);
  if (!array) return functions().read_parts(path);
  const glm::ivec2 size(array->width, array->height);
  return {{.name = "",
           .size = size,
           .picture_size = size,
           .channels = array->channels,
           .types = std::vector<std::string>(array->channels.size(), "float")}};
}

Texture readTexture(const std::string& path) {
  const TraceSpan span("read texture", {{"file", path}});
  std::optional<Texture> texture = readQuickly(path);
  return texture ? std::move(*texture) : functions().read_texture(path);
}

Texture readTexture(std::span<const std::byte> file, const std::string& name) {
  const TraceSpan span("read texture", {{"file", name}, {"bytes", std::int64_t(file.size())}});
  std::optional<Texture> texture = readQuickly(file, name, false);
  return texture ? std::move(*texture) : functions().read_texture_in_memory(file, name);
}

Image errorMap(const ImageDifference& difference) { return functions().error_map(difference); }

Image listMap(int width, int height, const std::vector<float>& list_lengths) {
  return functions().list_map(width, height, list_lengths);
}

Image boundMap(int width, int height, const std::vector<float>& bounds) {
  return functions().bound_map(width, height, bounds);
}

Image valueSheet(int width, int height, const std::vector<ValuePanel>& panels, int columns,
                 const std::string& title) {
  return functions().value_sheet(width, height, panels, columns, title);
}

Image labelledSheet(const std::vector<Image>& pictures, const std::vector<std::string>& labels,
                    const std::vector<std::string>& brief, int columns) {
  return functions().labelled_sheet(pictures, labels, brief, columns);
}

Image sideBySide(const Image& a, const Image& b, const ImageDifference& difference, const std::string& name_a,
                 const std::string& name_b) {
  return functions().side_by_side(a, b, difference, name_a, name_b);
}

bool openImageIOWrites(const std::string& extension) { return functions().open_image_io_writes(extension); }

}  // namespace luciole
