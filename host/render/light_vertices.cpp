#include <algorithm>

#include "lighting/count_picture.hpp"
#include "raster/rasterize.hpp"
#include "render/change_surfaces.hpp"
#include "render/light_points.hpp"

namespace luciole {
namespace {

/// Lists the vertices of the objects to draw.
struct VertexLister final : PointLister {
  ReadyPicture& picture;
  GBuffer vertices;

  explicit VertexLister(ReadyPicture& ready) : picture(ready) {}

  bool next() override {
    if (gbuffer) return false;
    vertices = timed(picture.stats, Stage::kGatherVertices, [&] {
      PlaneSet planes = neededPlanes(picture.plan.vertices);
      addGroups(picture.plan.surface, planes);
      return gatherVertices(picture.scene, picture.objects, picture.plan.view, planes);
    });
    vertices.camera = picture.settings.camera;
    changeSurfaces(picture, vertices);
    gbuffer = &vertices;
    return true;
  }

  void take(LitPlanes lit) override {
    const std::size_t n = vertices.pixels();
    if (!lit.light_error.empty()) {
      countStandIns(lit, picture.stats);
      const auto largest = [&](const Plane& plane) {
        glm::vec3 most(0.0f);
        for (std::size_t i = 0; i < plane.size(); ++i)
          most[int(i / n)] = std::max(most[int(i / n)], plane[i]);
        return most;
      };
      picture.lighting.vertex_error = {largest(lit.light_error), largest(lit.half_width)};
    }
    picture.vertex_colors.resize(n);
    for (std::size_t i = 0; i < n; ++i)
      picture.vertex_colors[i] = {lit.color[i], lit.color[i + n], lit.color[i + 2 * n]};
  }

  void takeLayer(std::size_t, LitPlanes) override {}  // Gouraud shading has no layers
};

}  // namespace

void lightVertices(ReadyPicture& picture) {
  VertexLister lister(picture);
  lightPoints(picture, picture.plan.vertices, lister);
}

}  // namespace luciole
