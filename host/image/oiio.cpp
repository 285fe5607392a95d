#include "image/oiio.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "error.hpp"
#include "image/exr_header.hpp"
#include "image/image.hpp"
#include "image/write_file.hpp"

namespace luciole {
namespace {

constexpr int kMaxSide = 65536;
constexpr std::uint64_t kMaxValues = std::uint64_t(1) << 31;
// Deflate, the best compressor of these formats on a constant picture, reaches 1 : 1032; JPEG's progressive
// mode can do better on empty pictures. A header that promises more than this has been made up.
constexpr std::uint64_t kMaxCompression = 65536;

constexpr int kAnyChannels = 1024;
const FileFormat kFormats[] = {
    {"png", false, 4},
    {"tga", false, 4},
    {"jpg", false, 3},
    {"jpeg", false, 3},
    {"bmp", false, 3},
    {"ppm", false, 3},
    {"hdr", true, 3},
    {"exr", true, kAnyChannels},
    {"tif", true, kAnyChannels},
    {"tiff", true, kAnyChannels},
};

std::string lowerCase(std::string text) {
  for (char& c : text) c = char(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

/// The reason of the last system call to fail.
std::string systemReason() { return std::generic_category().message(errno); }

void writeAll(int descriptor, const std::byte* bytes, std::size_t count, const std::string& name) {
  while (count > 0) {
    const ssize_t written = write(descriptor, bytes, count);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) throw MachineError(fmt::format("{}: can't write: {}", name, systemReason()));
    bytes += written;
    count -= std::size_t(written);
  }
}

/// Copies the file in memory to a descriptor.
void copyTo(int descriptor, const MemoryFile& file, const std::string& name) {
  struct stat status {};
  if (fstat(file.descriptor(), &status) != 0) throw MachineError(fmt::format("{}: {}", name, systemReason()));
  const std::size_t size = std::size_t(status.st_size);
  if (size == 0) return;
  void* map = mmap(nullptr, size, PROT_READ, MAP_SHARED, file.descriptor(), 0);
  if (map == MAP_FAILED) throw MachineError(fmt::format("{}: {}", name, systemReason()));
  try {
    writeAll(descriptor, static_cast<const std::byte*>(map), size, name);
  } catch (...) {
    munmap(map, size);
    throw;
  }
  munmap(map, size);
}

/// The limit of file sizes is the one thing that makes a write to memory fail, and some encoders then lose
/// pixels without a word or end the program. No encoder needs twice the bytes of the pixels.
void checkSizeLimit(const OIIO::ImageSpec& spec, const std::string& name) {
  constexpr std::uint64_t kHeader = 65536;
  rlimit limit{};
  if (getrlimit(RLIMIT_FSIZE, &limit) != 0) throw MachineError(fmt::format("{}: {}", name, systemReason()));
  if (limit.rlim_cur != RLIM_INFINITY && 2 * std::uint64_t(spec.image_bytes()) + kHeader > limit.rlim_cur) {
    throw MachineError(fmt::format("{}: may be larger than the {} bytes this process may write to a file",
                                   name, std::uint64_t(limit.rlim_cur)));
  }
}

std::string folderOf(const std::string& path) {
  const std::string folder = std::filesystem::path(path).parent_path().string();
  return folder.empty() ? "." : folder;
}

/// Writes beside the target, then renames: readers see the old file or the new one, never a part.
void putInPlace(const MemoryFile& file, const std::string& path) {
  static std::atomic<unsigned> serial{0};
  const std::string beside = fmt::format("{}/.luciole-{}-{}.tmp", folderOf(path), getpid(), serial++);
  const int descriptor = open(beside.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_NOFOLLOW | O_CLOEXEC, 0666);
  if (descriptor < 0) {
    const int code = errno;
    const std::string message =
        fmt::format("{}: can't create a file in its folder: {}", path, systemReason());
    if (code == EACCES || code == EROFS || code == ENOENT || code == ENOTDIR || code == EPERM) {
      throw InputError(message);
    }
    throw MachineError(message);
  }
  try {
    bool open_still = true;
    try {
      copyTo(descriptor, file, path);
      // Pipes and some file systems can't sync; what they hold is as safe as it gets.
      if (fsync(descriptor) != 0 && errno != EINVAL && errno != ENOTSUP) {
        throw MachineError(fmt::format("{}: can't write: {}", path, systemReason()));
      }
      open_still = false;
      if (close(descriptor) != 0)
        throw MachineError(fmt::format("{}: can't write: {}", path, systemReason()));
    } catch (...) {
      if (open_still) close(descriptor);
      throw;
    }
    if (std::rename(beside.c_str(), path.c_str()) != 0) {
      throw InputError(fmt::format("{}: can't put the file in place: {}", path, systemReason()));
    }
  } catch (...) {
    unlink(beside.c_str());
    throw;
  }
}

}  // namespace

MemoryFile::MemoryFile() : descriptor_(memfd_create("luciole", MFD_CLOEXEC)) {
  if (descriptor_ < 0) throw MachineError(fmt::format("can't make a file in memory: {}", systemReason()));
}

MemoryFile::MemoryFile(std::span<const std::byte> content) : MemoryFile() {
  writeAll(descriptor_, content.data(), content.size(), "file in memory");
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

std::unique_ptr<OIIO::ImageInput> openPicture(const std::string& path, const std::string& name) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) throw InputError(name + ": no such file");
  if (!std::filesystem::is_regular_file(status)) throw InputError(name + ": not a file, expected a picture");
  if (access(path.c_str(), R_OK) != 0)
    throw InputError(fmt::format("{}: can't read: {}", name, systemReason()));
  const std::uint64_t file_size = std::filesystem::file_size(path, error);
  checkExrHeader(path, name, kMaxSide);

  OIIO::ImageSpec config;
  config.attribute("oiio:UnassociatedAlpha", 1);
  std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(path, &config);
  if (!input)
    throw InputError(fmt::format("{}: can't read as a picture: {}", name, oneLine(OIIO::geterror())));

  const OIIO::ImageSpec& spec = input->spec();
  const auto side_ok = [](int side) { return side >= 1 && side <= kMaxSide; };
  if (!side_ok(spec.width) || !side_ok(spec.height)) {
    throw InputError(
        fmt::format("{}: {} x {} pixels, expected 1 to {} a side", name, spec.width, spec.height, kMaxSide));
  }
  if (spec.deep || spec.depth > 1) throw InputError(name + ": a deep or volume picture, expected a flat one");
  if (spec.nchannels < 1 || spec.image_pixels() * std::uint64_t(spec.nchannels) > kMaxValues) {
    throw InputError(fmt::format("{}: {} x {} pixels of {} channels, expected at most {} values", name,
                                 spec.width, spec.height, spec.nchannels, kMaxValues));
  }
  if (spec.image_bytes(true) / kMaxCompression > file_size) {
    throw InputError(fmt::format("{}: claims {} x {} pixels in {} bytes, the header is damaged", name,
                                 spec.width, spec.height, file_size));
  }
  return input;
}

void readValues(OIIO::ImageInput& input, const std::string& name, OIIO::TypeDesc type, void* values) {
  // Some decoders report a truncated file, fill the rest with grey and call it a success.
  const bool read = input.read_image(0, 0, 0, input.spec().nchannels, type, values);
  const std::string message = input.geterror();
  if (!read || !message.empty()) throw InputError(fmt::format("{}: damaged: {}", name, oneLine(message)));
}

bool isLinear(const OIIO::ImageSpec& spec) {
  const std::string space = OIIO::Strutil::lower(spec.get_string_attribute("oiio:ColorSpace"));
  return spec.format.is_floating_point() || OIIO::Strutil::starts_with(space, "lin") ||
         space == "scene_linear";
}

FileFormat outputFormat(const std::string& path) {
  if (path == "-") return kFormats[0];
  std::string extension = lowerCase(std::filesystem::path(path).extension().string());
  if (!extension.empty()) extension.erase(0, 1);
  for (const FileFormat& format : kFormats) {
    if (extension == format.extension) return format;
  }
  // Its outputs "term" and "null" make no file.
  if (!extension.empty() && extension != "term" && extension != "null" && OIIO::ImageOutput::create(extension))
    return {extension, false, 3};
  OIIO::geterror();  // what it says of an unknown extension is about plugins
  std::string known;
  for (const FileFormat& format : kFormats) known += fmt::format(" .{}", format.extension);
  throw InputError(fmt::format("{}: unknown extension '{}', expected one of{} or another that OpenImageIO writes",
                               path, extension, known));
}

void checkWritable(const std::string& path) {
  outputFormat(path);
  checkPlace(path);
}

void checkPlace(const std::string& path) {
  if (path == "-") return;
  const std::string folder = folderOf(path);
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) throw InputError(path + ": is a folder, expected a file");
  if (!std::filesystem::is_directory(folder, error)) throw InputError(path + ": no such folder");
  if (access(folder.c_str(), W_OK | X_OK) != 0) {
    throw InputError(fmt::format("{}: can't write to its folder: {}", path, systemReason()));
  }
}

void deliver(const MemoryFile& file, const std::string& path) {
  if (path == "-") {
    std::fflush(stdout);
    copyTo(STDOUT_FILENO, file, "standard output");
  } else {
    putInPlace(file, path);
  }
}

void writePicture(const std::string& path, const OIIO::ImageSpec& spec, const void* values) {
  checkWritable(path);
  checkSizeLimit(spec, path);
  const MemoryFile encoded;
  const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(outputFormat(path).extension);
  if (!output->open(encoded.path(), spec) || !output->write_image(spec.format, values) || !output->close()) {
    throw MachineError(fmt::format("{}: can't encode: {}", path, oneLine(output->geterror())));
  }
  struct stat status {};
  if (fstat(encoded.descriptor(), &status) != 0 || status.st_size == 0) {
    throw MachineError(path + ": OpenImageIO wrote nothing for this extension");
  }
  deliver(encoded, path);
}

}  // namespace luciole
