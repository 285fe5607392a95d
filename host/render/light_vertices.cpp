#include <algorithm>

#include "lighting/count_picture.hpp"
#include "raster/rasterize.hpp"
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
      return gatherVertices(picture.scene, picture.objects, picture.plan.view,
                            neededPlanes(picture.plan.vertices));
    });
    gbuffer = &vertices;
    return true;
  }

  void take(LitPlanes lit) override {
    const std::size_t n = vertices.pixels();
    if (!lit.light_error.empty()) {
      countStandIns(lit, picture.stats);
      glm::vec3 largest(0.0f);
      for (std::size_t i = 0; i < lit.light_error.size(); ++i)
        largest[int(i / n)] = std::max(largest[int(i / n)], lit.light_error[i]);
      picture.lighting.vertex_error = largest;
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
