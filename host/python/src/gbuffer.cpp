// G-buffers as arrays.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

#include <cmath>
#include <limits>
#include <luciole/error.hpp>
#include <luciole/gbuffer_file.hpp>
#include <luciole/planes.hpp>
#include <optional>
#include <string>

#include "arrays.hpp"
#include "bindings.hpp"
#include "picture_handle.hpp"

namespace luciole::python {
namespace {

/// Pixels of vectors, (H, W, 3).
using Vectors = In<float, nb::shape<-1, -1, 3>>;

/// Copies colours into a group. Pixels that show nothing keep their zeros.
void storeColors(const std::optional<Vectors>& colors, const GBuffer& gbuffer, Plane& group) {
  if (!colors) return;
  const float* from = colors->data();
  for (int y = 0; y < gbuffer.height; ++y)
    for (int x = 0; x < gbuffer.width; ++x, from += 3) {
      const std::size_t place = gbuffer.index(x, y);
      if (std::isfinite(gbuffer.position[2 * gbuffer.pixels() + place]))
        storePixel({from[0], from[1], from[2]}, place, gbuffer.pixels(), group);
    }
}

/// A G-buffer of arrays in world space, all of one height and width, as Python has checked. Pixels whose
/// position isn't finite show nothing.
std::unique_ptr<GBuffer> gbufferOf(
    const Camera& camera, const nb::ndarray<const double, nb::shape<-1, -1, 3>, nb::c_contig>& position,
    const Vectors& normal, const std::optional<Vectors>& diffuse, const std::optional<Vectors>& specular,
    const std::optional<In<float, nb::ndim<2>>>& shininess, const std::optional<Vectors>& ambient,
    const std::optional<Vectors>& emission) {
  const nb::gil_scoped_release unlocked;
  auto made = std::make_unique<GBuffer>();
  GBuffer& gbuffer = *made;
  gbuffer.height = int(position.shape(0));
  gbuffer.width = int(position.shape(1));
  gbuffer.tiles_x = (gbuffer.width + GBuffer::kTileSide - 1) / GBuffer::kTileSide;
  gbuffer.tiles_y = (gbuffer.height + GBuffer::kTileSide - 1) / GBuffer::kTileSide;
  gbuffer.picture_size = {gbuffer.width, gbuffer.height};
  gbuffer.camera = camera;
  allocatePlanes(
      {.specular = specular || shininess, .ambient = ambient.has_value(), .emission = emission.has_value()},
      gbuffer);
  const glm::dmat4 to_view = glm::inverse(camera.camera_to_world);
  const std::size_t stride = gbuffer.pixels();
  std::size_t i = 0;
  for (int y = 0; y < gbuffer.height; ++y)
    for (int x = 0; x < gbuffer.width; ++x, ++i) {
      const double* p = position.data() + 3 * i;
      const float* n = normal.data() + 3 * i;
      if (!std::isfinite(p[0]) || !std::isfinite(p[1]) || !std::isfinite(p[2])) continue;
      const std::size_t place = gbuffer.index(x, y);
      const glm::dvec3 at(to_view * glm::dvec4(p[0], p[1], p[2], 1));
      const glm::dvec3 facing(glm::dmat3(to_view) * glm::dvec3(n[0], n[1], n[2]));
      storePixel(glm::vec3(at), place, stride, gbuffer.position);
      storePixel(glm::vec3(glm::normalize(facing)), place, stride, gbuffer.normal);
      if (!diffuse) storePixel(glm::vec3(Material{}.diffuse), place, stride, gbuffer.diffuse);
      if (shininess) gbuffer.specular[3 * stride + place] = shininess->data()[i];
    }
  storeColors(diffuse, gbuffer, gbuffer.diffuse);
  storeColors(specular, gbuffer, gbuffer.specular);
  storeColors(ambient, gbuffer, gbuffer.ambient);
  storeColors(emission, gbuffer, gbuffer.emission);
  return made;
}

}  // namespace

void bindGBuffers(nb::module_& module) {
  nb::class_<GBuffer>(module, "GBuffer")
      .def_ro("width", &GBuffer::width)
      .def_ro("height", &GBuffer::height)
      .def_ro("knows_camera", &GBuffer::knows_camera)
      .def_prop_ro("camera", [](const GBuffer& gbuffer) { return gbuffer.camera; })
      .def("rows",
           [](const GBuffer& gbuffer) {
             const nb::gil_scoped_release unlocked;
             auto all = std::make_unique<PictureHandle>();
             passRows(gbuffer, [&](const Image& rows) { all->append(rows, gbuffer.height); });
             return all;
           })
      .def("write", [](const GBuffer& gbuffer, const std::string& path) {
        const nb::gil_scoped_release unlocked;
        writeGBuffer(gbuffer, path, {});
      });
  module.def("gbuffer", gbufferOf, nb::arg("camera"), nb::arg("position"), nb::arg("normal"),
             nb::arg("diffuse").none(), nb::arg("specular").none(), nb::arg("shininess").none(),
             nb::arg("ambient").none(), nb::arg("emission").none());
  module.def("read_gbuffer", [](const std::string& path) {
    const nb::gil_scoped_release unlocked;
    return std::make_unique<GBuffer>(readGBuffer(path));
  });
}

}  // namespace luciole::python
