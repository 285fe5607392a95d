#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "luciole/image.hpp"

namespace luciole {

/// What the header of a part of a picture file says. Most files are of one part.
struct PicturePart {
  std::string name;  ///< of a part of an EXR; may be empty
  glm::ivec2 size{0};
  glm::ivec2 picture_size{0};  ///< of the whole picture, of which this may be a crop
  glm::ivec2 crop_origin{0};   ///< where in the whole picture pixel (0,0) lies
  Display display{};
  std::vector<std::string> channels{};
  std::vector<std::string> types{};  ///< of each channel: "half", "float", "uint8" …
  std::string compression{};         ///< by its name in OpenImageIO; empty where the format knows none
  ExrAttributes attributes{};        ///< texts and 4 × 4 float matrices; upper and lower case of names vary
  bool is_deep = false;              ///< several samples a pixel, which nothing here reads
};

/// Reads the headers of a picture file, of any format that OpenImageIO reads. Of an EXR whose pixels lie in
/// rows it reads the first and the last row too, so that one that ends early is told. Throws InputError.
std::vector<PicturePart> readParts(const std::string& path);

}  // namespace luciole
