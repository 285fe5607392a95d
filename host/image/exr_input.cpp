#include "image/exr_input.hpp"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfMatrixAttribute.h>
#include <ImfMultiPartInputFile.h>
#include <ImfPartType.h>
#include <ImfStringAttribute.h>
#include <ImfTestFile.h>
#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <glm/gtc/type_ptr.hpp>
#include <new>

#include "base/machine_memory.hpp"
#include "base/picture_size.hpp"
#include "base/text_file.hpp"
#include "base/utf8.hpp"
#include "image/exr_header.hpp"
#include "image/exr_threads.hpp"
#include "image/exr_zip.hpp"
#include "image/picture_claims.hpp"
#include "luciole/error.hpp"

namespace luciole {
namespace {

/// Runs `use`, which calls the library, and tells its error as the file's.
template <class Use>
auto decoded(const std::string& path, const char* what, const Use& use) {
  try {
    return use();
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& error) {
    throw InputError(fmt::format("{}: {}: {}", path, what, forMessage(error.what())));
  }
}

glm::ivec2 sizeOf(const Imath::Box2i& box) { return {box.max.x - box.min.x + 1, box.max.y - box.min.y + 1}; }

/// Bytes of one value.
std::uint64_t lengthOf(Imf::PixelType type) { return type == Imf::HALF ? 2 : 4; }

bool isDeep(const Imf::Header& header) { return header.hasType() && Imf::isDeepData(header.type()); }

template <class Matrix>
glm::mat4 matrixOf(const Matrix& matrix) {
  glm::mat4 read;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) read[row][column] = float(matrix[row][column]);
  return read;
}

PicturePart partOf(const Imf::Header& header) {
  const Imath::Box2i& data = header.dataWindow();
  const Imath::Box2i& display = header.displayWindow();
  PicturePart part{.name = header.hasName() ? header.name() : "",
                   .size = sizeOf(data),
                   .picture_size = sizeOf(display),
                   .crop_origin = {data.min.x - display.min.x, data.min.y - display.min.y},
                   .display = {{display.min.x, display.min.y}, header.pixelAspectRatio()},
                   .is_deep = isDeep(header)};
  for (auto i = header.begin(); i != header.end(); ++i) {
    if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&i.attribute()))
      part.attributes.texts.emplace_back(i.name(), utf8Of(text->value()));
    else if (const auto* matrix = dynamic_cast<const Imf::M44fAttribute*>(&i.attribute()))
      part.attributes.matrices.emplace_back(i.name(), matrixOf(matrix->value()));
    else if (const auto* wide = dynamic_cast<const Imf::M44dAttribute*>(&i.attribute()))
      part.attributes.matrices.emplace_back(i.name(), matrixOf(wide->value()));
  }
  if (part.is_deep) return part;
  for (auto i = header.channels().begin(); i != header.channels().end(); ++i) {
    if (i.channel().xSampling != 1 || i.channel().ySampling != 1) continue;
    const Imf::PixelType type = i.channel().type;
    part.channels.emplace_back(i.name());
    part.types.emplace_back(type == Imf::HALF ? "half" : type == Imf::FLOAT ? "float" : "uint");
  }
  return part;
}

}  // namespace

struct ExrInput::File {
  explicit File(const std::string& path) : parts(path.c_str()) {}
  Imf::MultiPartInputFile parts;
};

ExrInput::ExrInput(const std::string& path) : path_(path), length_(checkPictureFile(path, path)) {
  if (!Imf::isOpenExrFile(path.c_str())) throw InputError(path + ": not an EXR file");
  checkExrHeader(path, path, kLargestSide);
  decoded(path, "can't read as a picture", [&] {
    useExrThreads();
    file_ = std::make_unique<File>(path);
    for (int i = 0; i < file_->parts.parts(); ++i) parts_.push_back(partOf(file_->parts.header(i)));
  });
}

ExrInput::~ExrInput() = default;

ChannelPlanes ExrInput::read(int part, const std::vector<int>& channels) {
  const PicturePart& header = parts_[std::size_t(part)];
  const Imf::ChannelList& all = file_->parts.header(part).channels();
  const std::uint64_t pixels = std::uint64_t(std::max(header.size.x, 0)) * std::max(header.size.y, 0);
  std::uint64_t bytes = 0;
  for (auto i = all.begin(); i != all.end(); ++i) bytes += lengthOf(i.channel().type) * pixels;
  checkClaims({.size = header.size,
               .whole = header.picture_size,
               .channels = channels.size(),
               .bytes = bytes,
               .file_length = length_},
              path_);
  const std::size_t plane = std::size_t(pixels);
  requireMemory(double(plane) * double(channels.size()) * sizeof(float), path_);
  ChannelPlanes values(plane * channels.size());
  const Imf::Header& file_header = file_->parts.header(part);
  const Imath::Box2i& window = file_header.dataWindow();
  std::vector<WantedChannel> wanted;
  Imf::FrameBuffer buffer;
  for (std::size_t c = 0; c < channels.size(); ++c) {
    const std::string& name = header.channels[std::size_t(channels[c])];
    wanted.push_back({name, values.data() + c * plane});
    buffer.insert(
        name, Imf::Slice::Make(Imf::FLOAT, wanted.back().plane, window.min, header.size.x, header.size.y));
  }
  decoded(path_, "damaged", [&] {
    Imf::InputPart input(file_->parts, part);
    if (isZip(file_header)) return readZip(input, wanted);
    input.setFrameBuffer(buffer);
    input.readPixels(window.min.y, window.max.y);
  });
  return values;
}

}  // namespace luciole
