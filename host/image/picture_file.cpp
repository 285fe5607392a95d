#include "image/picture_file.hpp"

#include <OpenImageIO/filesystem.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>

#include <algorithm>
#include <exception>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "base/output_file.hpp"
#include "image/oiio.hpp"
#include "luciole/error.hpp"
#include "luciole/image.hpp"

namespace luciole {
namespace {

std::size_t sizeOf(const MemoryFile& file, const std::string& name) {
  struct stat status {};
  if (fstat(file.descriptor(), &status) != 0) throw MachineError(fmt::format("{}: {}", name, systemReason()));
  return std::size_t(status.st_size);
}

void copy(const MemoryFile& from, OutputFile& to, const std::string& name) {
  const std::size_t size = sizeOf(from, name);
  void* map = mmap(nullptr, size, PROT_READ, MAP_SHARED, from.descriptor(), 0);
  if (map == MAP_FAILED) throw MachineError(fmt::format("{}: {}", name, systemReason()));
  const std::unique_ptr<void, std::function<void(void*)>> mapped(map, [&](void* p) { munmap(p, size); });
  to.writeAt(0, {static_cast<const std::byte*>(map), size});
}

}  // namespace

struct PictureFile::State {
  /// Writes an encoder's output to a file at once. Write errors are hidden from the encoder, since some
  /// encoders lose them and others end the program; throwError() throws the first.
  class Stream : public OIIO::Filesystem::IOProxy {
   public:
    explicit Stream(OutputFile& file) : IOProxy("", Write), file_(file) {}
    const char* proxytype() const override { return "luciole"; }
    std::size_t write(const void* bytes, std::size_t count) override {
      pwrite(bytes, count, m_pos);
      m_pos += std::int64_t(count);
      return count;
    }
    std::size_t pwrite(const void* bytes, std::size_t count, std::int64_t offset) override {
      size_ = std::max(size_, std::size_t(offset) + count);
      if (error_) return count;
      try {
        file_.writeAt(std::uint64_t(offset), {static_cast<const std::byte*>(bytes), count});
      } catch (...) {
        error_ = std::current_exception();
      }
      return count;
    }
    std::size_t size() const override { return size_; }
    void throwError() const {
      if (error_) std::rethrow_exception(error_);
    }

   private:
    OutputFile& file_;
    std::size_t size_ = 0;
    std::exception_ptr error_;
  };

  State(const std::string& of_path, const std::string& extension, const OIIO::ImageSpec& of_spec)
      : path(of_path),
        spec(of_spec),
        file(of_path),
        output(OIIO::ImageOutput::create(extension)),
        next_row(of_spec.y) {}

  std::string path;
  OIIO::ImageSpec spec;
  OutputFile file;
  Stream stream{file};
  std::optional<MemoryFile> memory;           ///< where the format can't be streamed
  std::unique_ptr<OIIO::ImageOutput> output;  ///< destroyed before `stream`: may write its last bytes then
  int next_row;
  std::vector<std::byte> waiting;  ///< all rows, for a format that takes tiles only

  bool isTiled() const { return output->spec().tile_width > 0; }

  void check(bool succeeded) {
    stream.throwError();
    if (!succeeded)
      throw MachineError(fmt::format("{}: can't encode: {}", path, oneLine(output->geterror())));
  }
};

PictureFile::PictureFile(const std::string& path, const std::string& extension, const OIIO::ImageSpec& spec) {
  checkWritable(path, {.format = extension});
  checkSizeLimit(spec.image_bytes(), path);
  state_ = std::make_unique<State>(path, extension, spec);
  std::string name = path;
  if (state_->file.isStream() || !state_->output->supports("ioproxy") ||
      !state_->output->set_ioproxy(&state_->stream))
    name = state_->memory.emplace().path();
  state_->check(state_->output->open(name, state_->spec));
}

PictureFile::~PictureFile() = default;
PictureFile::PictureFile(PictureFile&&) noexcept = default;

void PictureFile::write(const void* values, int rows) {
  if (state_->isTiled()) {
    const std::byte* bytes = static_cast<const std::byte*>(values);
    state_->waiting.insert(state_->waiting.end(), bytes, bytes + rows * state_->spec.scanline_bytes());
    return;
  }
  const int first = state_->next_row;
  state_->next_row += rows;
  state_->check(state_->output->write_scanlines(first, state_->next_row, 0, state_->spec.format, values));
}

void PictureFile::close() {
  if (state_->isTiled())
    state_->check(state_->output->write_image(state_->spec.format, state_->waiting.data()));
  state_->check(state_->output->close());
  if ((state_->memory ? sizeOf(*state_->memory, state_->path) : state_->stream.size()) == 0)
    throw MachineError(state_->path + ": OpenImageIO wrote nothing for this extension");
  if (state_->memory) copy(*state_->memory, state_->file, state_->path);
  state_->file.putInPlace();
}

}  // namespace luciole
