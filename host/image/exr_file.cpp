#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfMatrixAttribute.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <fmt/format.h>
#include <half.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <ctime>
#include <exception>
#include <glm/gtc/type_ptr.hpp>
#include <optional>
#include <span>

#include "base/output_file.hpp"
#include "base/utf8.hpp"
#include "image/exr_threads.hpp"
#include "image/file_format.hpp"
#include "image/row_file.hpp"
#include "luciole/error.hpp"

namespace luciole {
namespace {

/// Writes the library's output to a file at once. To a stream, which can't seek back to the table of rows, it
/// is written at the end. Write errors aren't passed to the library, whose destructors lose them;
/// throwError() throws the first.
class ExrStream : public Imf::OStream {
 public:
  ExrStream(OutputFile& file, const std::string& path) : OStream(path.c_str()), file_(file) {}

  void write(const char bytes[], int count) override {
    const auto data = std::as_bytes(std::span(bytes, std::size_t(count)));
    const std::uint64_t offset = at_;
    at_ += data.size();
    if (error_) return;
    try {
      if (file_.isStream()) {
        waiting_.resize(std::max<std::size_t>(waiting_.size(), at_));
        std::copy(data.begin(), data.end(), waiting_.begin() + std::ptrdiff_t(offset));
      } else {
        file_.writeAt(offset, data);
      }
    } catch (...) {
      error_ = std::current_exception();
    }
  }
  std::uint64_t tellp() override { return at_; }
  void seekp(std::uint64_t to) override { at_ = to; }

  void throwError() const {
    if (error_) std::rethrow_exception(error_);
  }
  void finish() {
    throwError();
    if (file_.isStream()) file_.writeAt(0, waiting_);
  }

 private:
  OutputFile& file_;
  std::uint64_t at_ = 0;
  std::vector<std::byte> waiting_;  ///< all that was written, for a stream
  std::exception_ptr error_;
};

/// The library's names for those that OpenImageIO gives.
std::string attributeName(const std::string& name) { return name == "ImageDescription" ? "comments" : name; }

/// The time of day, as EXR has it.
std::string timeOfDay() {
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  localtime_r(&now, &local);
  char text[32];
  return {text, std::strftime(text, sizeof text, "%Y:%m:%d %H:%M:%S", &local)};
}

/// The library numbers its compressions as kExrCompressions has them.
static_assert(Imf::NO_COMPRESSION == 0 && Imf::DWAB_COMPRESSION == kExrCompressions.size() - 1);
Imf::Compression compressionOf(const std::string& name) {
  const auto found = std::find_if(kExrCompressions.begin(), kExrCompressions.end(),
                                  [&](const ExrCompression& one) { return one.name == name; });
  return Imf::Compression(found - kExrCompressions.begin());
}

Imf::Header makeHeader(int width, int height, const std::vector<std::string>& channels,
                       const Metadata& metadata, const WriteOptions& options) {
  const glm::ivec2 whole = options.picture_size.x > 0 ? options.picture_size : glm::ivec2(width, height);
  const glm::ivec2 origin = options.display.origin, first = origin + options.crop_origin,
                   last = first + glm::ivec2(width - 1, height - 1);
  const auto box = [](glm::ivec2 from, glm::ivec2 to) {
    return Imath::Box2i(Imath::V2i(from.x, from.y), Imath::V2i(to.x, to.y));
  };
  Imf::Header header(box(origin, origin + whole - 1), box(first, last), options.display.pixel_aspect,
                     Imath::V2f(0, 0), 1, Imf::INCREASING_Y,
                     compressionOf(options.compression.empty() ? kExrCompression : options.compression));
  for (const std::string& name : channels)
    header.channels().insert(name,
                             Imf::Channel(options.half && isColorChannel(name) ? Imf::HALF : Imf::FLOAT));
  const auto addTexts = [&](const Metadata& texts) {
    for (const auto& [name, text] : texts)
      header.insert(attributeName(name), Imf::StringAttribute(utf8Of(text)));
  };
  addTexts(metadata);
  addTexts({{"capDate", timeOfDay()}});
  addTexts(options.exr.texts);
  for (const auto& [name, matrix] : options.exr.matrices) {
    float values[4][4];
    std::memcpy(values, glm::value_ptr(matrix), sizeof values);
    header.insert(name, Imf::M44fAttribute(Imath::M44f(values)));
  }
  return header;
}

class ExrFile : public RowFile {
 public:
  ExrFile(const std::string& path, int width, int height, const std::vector<std::string>& channels,
          const Metadata& metadata, const WriteOptions& options)
      : path_(path), width_(width), channels_(channels), file_(path), stream_(file_, path) {
    for (const std::string& name : channels)
      halves_.push_back(options.half && isColorChannel(name) ? half_channels_++ : kNoHalf);
    const glm::ivec2 first = options.display.origin + options.crop_origin;
    at_ = {first.x, first.y};
    encode([&] {
      useExrThreads();
      output_.emplace(stream_, makeHeader(width, height, channels, metadata, options));
    });
  }

  void write(const void* values, int rows) override {
    const float* pixels = static_cast<const float*>(values);
    const std::size_t count = channels_.size();
    std::vector<half> halves(half_channels_ * std::size_t(width_) * rows);
    if (half_channels_ > 0)
      tbb::parallel_for(0, rows, [&](int y) {
        const float* in = pixels + std::size_t(y) * width_ * count;
        half* out = halves.data() + std::size_t(y) * width_ * half_channels_;
        for (int x = 0; x < width_; ++x, in += count)
          for (std::size_t c = 0; c < count; ++c)
            if (halves_[c] != kNoHalf) *out++ = half(in[c]);
      });
    Imf::FrameBuffer buffer;
    for (std::size_t c = 0; c < count; ++c) {
      const bool is_half = halves_[c] != kNoHalf;
      const std::size_t value = is_half ? sizeof(half) : sizeof(float);
      const std::size_t pixel = value * (is_half ? half_channels_ : count);
      const void* first = is_half ? static_cast<const void*>(halves.data() + halves_[c]) : pixels + c;
      buffer.insert(channels_[c], Imf::Slice::Make(is_half ? Imf::HALF : Imf::FLOAT, first, at_, width_, rows,
                                                   pixel, pixel * std::size_t(width_)));
    }
    encode([&] {
      output_->setFrameBuffer(buffer);
      output_->writePixels(rows);
    });
    at_.y += rows;
  }

  void close() override {
    encode([&] { output_.reset(); });  // writes the table of rows
    stream_.finish();
    file_.putInPlace();
  }

 private:
  static constexpr std::size_t kNoHalf = std::size_t(-1);

  /// Runs `use`, which calls the library, and throws the error that it met.
  template <class Use>
  void encode(const Use& use) {
    try {
      use();
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const std::exception& error) {
      throw MachineError(fmt::format("{}: can't encode: {}", path_, error.what()));
    }
    stream_.throwError();
  }

  std::string path_;
  int width_;
  std::vector<std::string> channels_;
  std::vector<std::size_t> halves_;  ///< which of the halves a channel is, or kNoHalf
  std::size_t half_channels_ = 0;
  Imath::V2i at_;  ///< the next row's first pixel, in the whole picture
  OutputFile file_;
  ExrStream stream_;
  std::optional<Imf::OutputFile> output_;  ///< destroyed before `stream_`: writes its last bytes then
};

}  // namespace

std::unique_ptr<RowFile> openExrFile(const std::string& path, int width, int height,
                                     const std::vector<std::string>& channels, const Metadata& metadata,
                                     const WriteOptions& options) {
  checkWritable(path, {.format = "exr"});
  checkSizeLimit(std::uint64_t(width) * height * channels.size() * sizeof(float), path);
  return std::make_unique<ExrFile>(path, width, height, channels, metadata, options);
}

}  // namespace luciole
