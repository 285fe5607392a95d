// clang-format off
#include <cstdio>  // jpeglib.h needs its FILE
#include <jpeglib.h>
// clang-format on

#include <csetjmp>
#include <cstdint>
#include <cstdlib>

#include "image/row_file.hpp"
#include "luciole/error.hpp"

namespace luciole {
namespace {

class JpegInMemory : public RowFile {
 public:
  JpegInMemory(int width, int height, std::string& memory)
      : memory_(memory), row_bytes_(3 * std::size_t(width)) {
    jpeg_.err = jpeg_std_error(&errors_);
    errors_.error_exit = onError;
    jpeg_.client_data = this;
    jpeg_create_compress(&jpeg_);
    jpeg_.image_width = JDIMENSION(width);
    jpeg_.image_height = JDIMENSION(height);
    jpeg_.input_components = 3;
    jpeg_.in_color_space = JCS_RGB;
  }
  ~JpegInMemory() override {
    jpeg_destroy_compress(&jpeg_);
    std::free(bytes_);
  }
  JpegInMemory(const JpegInMemory&) = delete;
  JpegInMemory& operator=(const JpegInMemory&) = delete;

  void write(const void* values, int rows) override {
    // Some versions of libjpeg take no pointer to const; none writes there.
    auto* row = const_cast<std::uint8_t*>(static_cast<const std::uint8_t*>(values));
    call([&] {
      if (!bytes_) begin();
      for (int y = 0; y < rows; ++y, row += row_bytes_) jpeg_write_scanlines(&jpeg_, &row, 1);
    });
  }

  void close() override {
    call([&] { jpeg_finish_compress(&jpeg_); });
    memory_.append(reinterpret_cast<const char*>(bytes_), size_);
  }

 private:
  void begin() {
    constexpr int kQuality = 85;
    jpeg_mem_dest(&jpeg_, &bytes_, &size_);
    jpeg_set_defaults(&jpeg_);
    jpeg_set_quality(&jpeg_, kQuality, TRUE);
    jpeg_start_compress(&jpeg_, TRUE);
  }

  /// An error of the library jumps back into here, over no object that has a destructor.
  template <class Use>
  void call(const Use& use) {
    if (setjmp(on_error_) != 0) throw MachineError("a JPEG in memory: can't encode");
    use();
  }

  [[noreturn]] static void onError(j_common_ptr jpeg) {
    std::longjmp(static_cast<JpegInMemory*>(jpeg->client_data)->on_error_, 1);
  }

  std::jmp_buf on_error_{};
  std::string& memory_;
  std::size_t row_bytes_;
  jpeg_error_mgr errors_{};
  jpeg_compress_struct jpeg_{};
  unsigned char* bytes_ = nullptr;
  unsigned long size_ = 0;
};

}  // namespace

std::unique_ptr<RowFile> openJpegInMemory(int width, int height, std::string& memory) {
  constexpr int kMost = 65500;  // libjpeg's
  if (width < 1 || height < 1 || width > kMost || height > kMost)
    throw MachineError("a JPEG in memory: has 1 to 65500 pixels a side");
  return std::make_unique<JpegInMemory>(width, height, memory);
}

}  // namespace luciole
