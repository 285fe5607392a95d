// How well Phong's model, with the coefficients that a glTF material becomes, stands for the facets that it
// says: by the integral over all directions of the light and the eye, in double precision.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "kernels/random_scene.hpp"
#include "reference/models.hpp"
#include "scene/gltf/gltf_file.hpp"

namespace luciole::test {
namespace {

struct Fit {
  double rms = 0;   ///< of the difference, of that of the facets' light
  double bias = 0;  ///< the light that is too much, of all
};

/// A direction over the surface; all solid angles are equally likely.
glm::dvec3 above(Random& random) {
  const double z = random.between(1e-3, 1), angle = random.between(0, 2 * glm::pi<double>());
  return {std::sqrt(1 - z * z) * std::cos(angle), std::sqrt(1 - z * z) * std::sin(angle), z};
}

/// Half of the pairs are any, half lie by GGX's facets, weighed by how likely they are. Light towards the eye
/// counts by the eye's cosine.
Fit judge(const Material& material) {
  Random random(7);
  const Facets& facets = *material.facets;
  const double alpha2 = double(facets.alpha) * facets.alpha;
  double square = 0, truth2 = 0, more = 0, sum = 0;
  for (int i = 0; i < 200000; ++i) {
    Directions at{};
    at.normal = {0, 0, 1};
    at.to_eye = above(random);
    at.to_light = above(random);
    if (i % 2 == 0) {
      const double u = random.between(0, 1), z = std::sqrt((1 - u) / (1 + (alpha2 - 1) * u)),
                   angle = random.between(0, 2 * glm::pi<double>());
      const glm::dvec3 facet(std::sqrt(1 - z * z) * std::cos(angle), std::sqrt(1 - z * z) * std::sin(angle),
                             z);
      at.to_light = 2 * glm::dot(at.to_eye, facet) * facet - at.to_eye;
      if (at.to_light.z <= 1e-3) continue;
    }
    const glm::dvec3 facet = glm::normalize(at.to_eye + at.to_light);
    const double spread = (alpha2 - 1) * facet.z * facet.z + 1,
                 density = alpha2 / (glm::pi<double>() * spread * spread) * facet.z /
                           (4 * std::max(glm::dot(facet, at.to_eye), 1e-6));
    const double weight = at.to_eye.z / (0.5 / (2 * glm::pi<double>()) + 0.5 * density);
    const double truth =
        reflectedLight(Model::kCookTorrance, at, glm::dvec3(facets.f0), 2 / alpha2 - 2).specular.x;
    const double fit =
        reflectedLight(Model::kPhong, at, glm::dvec3(material.specular), material.shininess).specular.x;
    square += weight * (fit - truth) * (fit - truth);
    truth2 += weight * truth * truth;
    more += weight * (fit - truth);
    sum += weight * truth;
  }
  return {std::sqrt(square / truth2), more / sum};
}

class GltfFit : public GltfTest {
 protected:
  Material materialOf(double metallic, double roughness) {
    GltfFile file = triangleFile();
    file.primitive()["material"] = 0;
    file.root["materials"] = {{{"pbrMetallicRoughness",
                                {{"baseColorFactor", {0.8, 0.8, 0.8, 1}},
                                 {"metallicFactor", metallic},
                                 {"roughnessFactor", roughness}}}}};
    return load(file).materials.at(0);
  }
};

// The table of scenes/FORMATS.md, to two digits. A hundred thousand pairs tell a share to 0.01 or so.
TEST_F(GltfFit, IsAsTheDocumentSays) {
  const struct {
    double roughness, metal_rms, metal_bias, plastic_rms, plastic_bias;
  } kTable[] = {{0.2, 0.56, -0.01, 0.97, -0.51}, {0.3, 0.52, 0.00, 0.95, -0.46},
                {0.4, 0.48, 0.01, 0.91, -0.39},  {0.5, 0.45, 0.01, 0.86, -0.32},
                {0.6, 0.42, 0.00, 0.79, -0.26},  {0.8, 0.46, -0.02, 0.63, -0.18},
                {1.0, 0.53, 0.32, 0.54, 0.18}};
  for (const auto& row : kTable) {
    const Fit metal = judge(materialOf(1, row.roughness)), plastic = judge(materialOf(0, row.roughness));
    EXPECT_NEAR(metal.rms, row.metal_rms, 0.03) << row.roughness;
    EXPECT_NEAR(metal.bias, row.metal_bias, 0.03) << row.roughness;
    EXPECT_NEAR(plastic.rms, row.plastic_rms, 0.03) << row.roughness;
    EXPECT_NEAR(plastic.bias, row.plastic_bias, 0.03) << row.roughness;
  }
}

TEST_F(GltfFit, CookTorranceTakesTheFacetsThemselves) {
  Scene scene;
  scene.materials = {materialOf(1, 0.5), materialOf(1, 0.5), {}};
  scene.materials[1].model = Model::kPhong;
  const Material chosen = scene.materials[1], plain = scene.materials[2];
  takeFacets(scene);
  EXPECT_NEAR(scene.materials[0].specular.x, 0.8, 1e-6);
  EXPECT_EQ(scene.materials[0].shininess, 30.0f) << "2 x 16 - 2";
  EXPECT_EQ(scene.materials[1].specular, chosen.specular);
  EXPECT_EQ(scene.materials[2].specular, plain.specular);
}

}  // namespace
}  // namespace luciole::test
