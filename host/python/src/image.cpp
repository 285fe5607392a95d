// Pictures as arrays, and their files; how two differ.
#include <nanobind/stl/map.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

#include <luciole/compare.hpp>
#include <luciole/error.hpp>
#include <luciole/image.hpp>
#include <luciole/settings.hpp>
#include <map>
#include <string>

#include "arrays.hpp"
#include "bindings.hpp"
#include "picture_handle.hpp"

namespace luciole::python {
namespace {

using Pixels = In<float, nb::ndim<3>>;

/// An image of an array's pixels, which are copied.
Image imageOf(const Pixels& pixels, const std::vector<std::string>& channels) {
  if (pixels.shape(2) != channels.size()) throw nb::value_error("_luciole: an array of another shape");
  Image image{int(pixels.shape(1)), int(pixels.shape(0)), channels};
  image.pixels.assign(pixels.data(), pixels.data() + pixels.size());
  return image;
}

WriteOptions optionsOf(const std::map<std::string, std::string>& values, bool alpha) {
  WriteOptions options{.alpha = alpha};
  applySettings(SettingValues(values.begin(), values.end()), options);
  return options;
}

/// How B differs from A, by the names of the field (see ImageDifference).
nb::dict differenceOf(const Pixels& a, const std::vector<std::string>& channels_a, const Pixels& b,
                      const std::vector<std::string>& channels_b) {
  ImageDifference difference;
  {
    const nb::gil_scoped_release unlocked;
    difference = compareImages(imageOf(a, channels_a), imageOf(b, channels_b));
  }
  nb::dict d;
  for (const auto& [name, figure] : kImageMetrics) d[name] = difference.*figure;
  d["pixels"] = difference.pixels;
  d["nonfinite"] = difference.nonfinite;
  d["worst_pixel"] = nb::make_tuple(difference.worst_pixel[0], difference.worst_pixel[1]);
  return d;
}

}  // namespace

void bindImages(nb::module_& module) {
  nb::class_<PictureHandle>(module, "Picture")
      .def_ro("channels", &PictureHandle::channels)
      .def_prop_ro("pixels",
                   [](nb::handle_t<PictureHandle> self) {
                     auto& picture = nb::cast<PictureHandle&>(self);
                     return nb::ndarray<nb::numpy, float>(
                         picture.pixels.data(),
                         {std::size_t(picture.height), std::size_t(picture.width), picture.channels.size()},
                         self);
                   })
      .def_prop_ro("stats",
                   [](const PictureHandle& picture) { return statsJson(picture.stats, picture.ended); });
  module.def("write_image",
             [](const Pixels& pixels, const std::vector<std::string>& channels, const std::string& path,
                const std::vector<std::pair<std::string, std::string>>& metadata,
                const std::map<std::string, std::string>& values, bool alpha) {
               const nb::gil_scoped_release unlocked;
               return writeImage(imageOf(pixels, channels), path, metadata, optionsOf(values, alpha));
             });
  module.def("png_bytes", [](const Pixels& pixels, const std::vector<std::string>& channels,
                             const std::map<std::string, std::string>& values, bool alpha) {
    std::string bytes;
    {
      const nb::gil_scoped_release unlocked;
      WriteOptions options = optionsOf(values, alpha);
      options.memory = &bytes;
      writeImage(imageOf(pixels, channels), "memory.png", {}, options);
    }
    return nb::bytes(bytes.data(), bytes.size());
  });
  module.def("picture_of", [](const Pixels& pixels, const std::vector<std::string>& channels) {
    return std::make_unique<PictureHandle>(imageOf(pixels, channels));
  });
  module.def("read_image", [](const std::string& path) {
    const nb::gil_scoped_release unlocked;
    return std::make_unique<PictureHandle>(readImage(path));
  });
  module.def("difference", differenceOf);
}

}  // namespace luciole::python
