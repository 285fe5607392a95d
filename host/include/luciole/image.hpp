#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace luciole {

/// The display window of an EXR, but for its size.
struct Display {
  glm::ivec2 origin{0};    ///< where the display window begins; places in the whole picture count from there
  float pixel_aspect = 1;  ///< the width of a pixel by its height, > 0
  bool operator==(const Display&) const = default;
};

/// A picture in memory: linear float, row-major, channels interleaved, pixel (0,0) top left.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::string> channels = {};  ///< names as EXR has them: "R", "G", "B", "normal.X" …
  std::vector<float> pixels = {};          ///< width × height × channels.size()
  glm::ivec2 picture_size{0};  ///< of the whole picture, of which the file says that this is a part
  glm::ivec2 crop_origin{0};   ///< where in the whole picture pixel (0,0) lies
  Display display{};
};

/// Text attributes to store with a picture, by the names OpenImageIO gives them ("Software",
/// "ImageDescription" …).
using Metadata = std::vector<std::pair<std::string, std::string>>;

/// Attributes of an EXR's header that other formats can't store.
struct ExrAttributes {
  Metadata texts = {};
  std::vector<std::pair<std::string, glm::mat4>> matrices = {};
};

/// How linear light, after exposure, is brought into [0,1], the range of files of integers.
enum class ToneCurve : std::uint8_t {
  kClip,    ///< as it is; above 1 it is 1
  kFilmic,  ///< K. Narkowicz's fit of the ACES curve, 2016: with a toe and a shoulder
};

class Film;

/// How a picture is written.
struct WriteOptions {
  std::string format = {};            ///< an extension that overrides the path's own; empty: doesn't
  bool dither = false;                ///< 8-bit codes are dithered by a fixed pattern, not rounded
  ToneCurve tone = ToneCurve::kClip;  ///< integer formats
  int bits = 0;       ///< of sRGB codes: 8, or in png and tif 16; 0: what the format usually holds
  bool half = false;  ///< exr: R, G, B, A and Y, also of layers, as 16-bit floats; all else stays 32-bit
  /// exr: none, rle, zips, zip, piz, pxr24, b44, b44a, dwaa or dwab; empty: zip. png: fast or small; empty:
  /// fast.
  std::string compression = {};
  bool alpha = false;          ///< colours are multiplied by A; integer formats then get them divided by A
  glm::ivec2 picture_size{0};  ///< of the whole picture where this is a crop; 0: this is the whole
  glm::ivec2 crop_origin{0};   ///< where in the whole picture pixel (0,0) lies
  Display display = {};        ///< exr
  ExrAttributes exr = {};
  std::string* memory = nullptr;  ///< png and jpg: where the file's bytes go; the path only says the format
  Film* film = nullptr;  ///< the picture is the next frame of this film instead of a file: 8-bit R, G, B
};

/// Reads any picture that OpenImageIO reads, and NumPy's .npy: arrays (height, width) or (height, width, 1, 3
/// or 4) of floats. 8- and 16-bit integer files are taken as sRGB and linearized (alpha apart), unless the
/// file says that it is linear. Colours are as the file has them: never multiplied or divided by alpha. Sizes
/// are checked before anything is allocated. Throws InputError, or MachineError where the picture doesn't fit
/// into memory.
Image readImage(const std::string& path);

/// A text attribute stored with a picture; empty where it has none of that name. Throws as readImage does.
std::string readAttribute(const std::string& path, const std::string& name);

/// Writes by the extension. Integer formats (png, tga, jpg, bmp, ppm) take the R, G, B channels (and A: png,
/// tga) as sRGB, rounded to nearest or dithered, NaN as 0; exr and tif every channel as it is, 32-bit float;
/// hdr and pfm R, G, B; npy these, and A. Others that OpenImageIO writes (webp, gif, sgi ...) as 8-bit R, G,
/// B. An EXR of a crop has it as data window inside the display window. Colours of an EXR that 16-bit floats
/// can't hold become the largest that they can, with `half` and for dwaa and dwab. Returns the number of
/// pixels with such a colour. The file appears whole or not at all. "-" writes a PNG to standard output.
/// Throws InputError (unknown extension, options that the format has no place for, no such folder, read-only
/// folder) or MachineError (disk full).
std::uint64_t writeImage(const Image& image, const std::string& path, const Metadata& metadata,
                         const WriteOptions& options = {});

/// Writes like writeImage a picture that comes in pieces: whole rows, from the top down. Most formats need no
/// memory for rows that were written. Without close() no file appears.
class ImageWriter {
 public:
  /// Throws as writeImage does.
  ImageWriter(const std::string& path, int width, int height, const std::vector<std::string>& channels,
              const Metadata& metadata, const WriteOptions& options = {});
  ~ImageWriter();

  /// The next rows; `rows` has the picture's width and channels. Throws MachineError.
  void write(const Image& rows);

  /// After the last row: puts the file in place. Returns and throws as writeImage does.
  std::uint64_t close();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Throws the InputError that writing to `path` would meet, before any work is done: an unknown extension, a
/// folder that isn't there or can't be written to, a folder in the file's place, an option that the format
/// has no place for.
void checkWritable(const std::string& path, const WriteOptions& options = {});

}  // namespace luciole
