#include "image/module.hpp"

namespace luciole {

const ImageFunctions luciole_image_functions{
    .read_image = readImage,
    .read_attribute = readAttribute,
    .open_picture_file = openPictureFile,
    .read_parts = readParts,
    .read_texture = readTexture,
    .read_texture_in_memory = readTexture,
    .error_map = errorMap,
    .list_map = listMap,
    .bound_map = boundMap,
    .value_sheet = valueSheet,
    .side_by_side = sideBySide,
    .labelled_sheet = labelledSheet,
    .open_image_io_writes = openImageIOWrites,
    .use_cleanups = shareCleanups,
};

}  // namespace luciole
