// glTF files of public bug reports of other programs (shared/scenes/reports), each drawn as its note says is
// right.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "luciole/image.hpp"
#include "shared_files.hpp"
#include "tools/cli/program_test.hpp"

namespace luciole::test {
namespace {

using testing::HasSubstr;

class GltfReports : public ProgramTest {
 protected:
  static std::string path(const std::string& name) { return (sharedScenes() / "reports" / name).string(); }
  /// Draws a report's scene, and returns what was told.
  std::string draw(const std::string& name, const std::string& size = "16x16") {
    const std::string err =
        told("luciole render '" + path(name) + "' --exposure 0 --size " + size + " --alpha -o x.exr");
    image = readImage(folder / "x.exr");
    return err;
  }
  glm::vec4 at(int x, int y) const {
    const float* pixel =
        &image.pixels[(std::size_t(y) * std::size_t(image.width) + std::size_t(x)) * image.channels.size()];
    return {pixel[0], pixel[1], pixel[2], pixel[3]};
  }
  /// Half floats of an EXR, and a product or two.
  static bool isNear(const glm::vec4& got, const glm::vec3& color) {
    return glm::distance(glm::vec3(got), color) <= 2e-3f * std::max(1.0f, glm::length(color));
  }
  Image image;
};

TEST_F(GltfReports, AreDrawnAsTheirNotesSayIsRight) {
  LUCIOLE_NEEDS_SHARED();
  const glm::vec3 orange(1, 0.5f, 0.25f), red(1, 0, 0), grey(0.2158f);
  const struct {
    const char* file;
    glm::vec3 color;
    const char* warning;
  } kReports[] = {
      {"09_gltf_bin_longer/q.gltf", orange, ""},
      {"10_gltf_data_uri/png.gltf", red, ""},
      {"10_gltf_data_uri/png_charset.gltf", red, ""},
      {"10_gltf_data_uri/png_octet.gltf", red, ""},
      {"10_gltf_data_uri/webp.gltf", red, ""},
      {"11_glb_empty_bin/empty.glb", orange, ""},
      {"11_glb_empty_bin/extra_chunk.glb", orange, ""},
      {"11_glb_empty_bin/one_byte_more.glb", orange, "its header: length is"},
      {"12_gltf_no_zfar/near_1mm.gltf", {0, 1, 0}, ""},
      {"12_gltf_no_zfar/near_1cm.gltf", {0, 1, 0}, ""},
      {"14_gltf_png_gama/none.gltf", grey, ""},
      {"14_gltf_png_gama/g1.gltf", grey, ""},
      {"14_gltf_png_gama/g22.gltf", grey, ""},
      {"14_gltf_png_gama/g18.gltf", grey, ""},
      {"15_gltf_backslash/q.gltf", red, ""},
      {"16_gltf_no_source/q.gltf", {0, 0, 1}, "textures[0]: has only a MSFT_texture_dds picture"},
      {"17_gltf_factor_above_1/base.gltf", orange, "materials[0]: baseColorFactor is 1.0"},
      {"18_gltf_flat_scale/flat.gltf", {1, 1, 0}, ""},
      {"20_gltf_matrix_animated/weights.gltf", {0, 1, 1}, ""},
      {"20_gltf_matrix_animated/translation.gltf", {0, 1, 1}, "nodes[0]: has a matrix and is animated"},
      {"35_gltf_spec_gloss/q.gltf", {0, 0.5f, 0}, ""},
      {"36_siblings/matrix_row.gltf", {0, 1, 0}, "nodes[0]: matrix has 0 0 0 1.0000001 as last row"},
      {"36_siblings/negative_light.gltf", {0, 1, 0}, "lights[1]: intensity is -1"},
      {"36_siblings/no_normals_weights_empty.gltf",
       {0, 1, 0},
       "meshes[0]: has 1 weights for 0 morph targets"},
      {"36_siblings/times_negative.gltf", {0, 1, 0}, "animations[0].samplers[0]: time -"},
  };
  for (const auto& report : kReports) {
    const std::string err = draw(report.file);
    for (const int place : {3, 8, 12})
      EXPECT_TRUE(isNear(at(place, 7), report.color)) << report.file << " " << place << ": " << at(place, 7).x
                                                      << " " << at(place, 7).y << " " << at(place, 7).z;
    if (*report.warning)
      EXPECT_THAT(err, HasSubstr(report.warning)) << report.file;
    else
      EXPECT_EQ(err.find("warning"), std::string::npos) << report.file << ": " << err;
  }
}

TEST_F(GltfReports, StrictRefusesThoseThatWereMended) {
  LUCIOLE_NEEDS_SHARED();
  for (const char* file :
       {"11_glb_empty_bin/one_byte_more.glb", "17_gltf_factor_above_1/base.gltf",
        "17_gltf_factor_above_1/emissive.gltf", "20_gltf_matrix_animated/translation.gltf",
        "36_siblings/matrix_row.gltf", "36_siblings/negative_light.gltf", "36_siblings/outer_above_90.gltf",
        "36_siblings/no_normals_weights_empty.gltf", "36_siblings/times_negative.gltf"})
    refuse("luciole render '" + path(file) + "' --strict --size 16x16 -o x.exr", 2, file);
}

TEST_F(GltfReports, NearestTexelsAreFlatSquares) {
  LUCIOLE_NEEDS_SHARED();
  draw("13_gltf_nearest/nearest.gltf", "64x64");
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) {
      ASSERT_EQ(at(x, y), at(x / 32 * 32 + 16, y / 32 * 32 + 16)) << x << " " << y;
      for (int c = 0; c < 3; ++c) ASSERT_TRUE(at(x, y)[c] == 0 || at(x, y)[c] == 1) << x << " " << y;
    }
  draw("13_gltf_nearest/linear.gltf", "64x64");
  EXPECT_NE(at(31, 31), at(16, 16));
}

TEST_F(GltfReports, ALampBelowAScaleOfZeroIsLeftOut) {
  LUCIOLE_NEEDS_SHARED();
  EXPECT_THAT(draw("19_gltf_hidden_lamp/spot.gltf"), HasSubstr("nodes[3]: its scale is 0; left out"));
  EXPECT_TRUE(isNear(at(8, 8), glm::vec3(1)));
}

TEST_F(GltfReports, ATargetWithoutABufferViewIsZerosWithItsSparsePart) {
  LUCIOLE_NEEDS_SHARED();
  EXPECT_EQ(draw("32_gltf_morph_zero_accessor/q.gltf", "128x128").find("warning"), std::string::npos);
  double sum = 0;
  for (int y = 0; y < 128; ++y)
    for (int x = 0; x < 128; ++x) sum += at(x, y).a;
  EXPECT_NEAR(sum / (128 * 128), 0.75, 1.0 / 128);  // a pixel's column at most
}

TEST_F(GltfReports, InfoTellsNearAndFar) {
  LUCIOLE_NEEDS_SHARED();
  const std::string file = "'" + path("12_gltf_no_zfar/near_1mm.gltf") + "'";
  EXPECT_THAT(succeed("luciole info " + file), HasSubstr("sees from 0.001 m on"));
  EXPECT_THAT(succeed("luciole info " + file + " --json -"), HasSubstr("\"far\": null"));
  const std::string limited = "'" + path("35_gltf_spec_gloss/q.gltf") + "'";
  EXPECT_THAT(succeed("luciole info " + limited), HasSubstr("sees from 0.1 to 100 m"));
}

TEST_F(GltfReports, PointsAloneShowNothing) {
  LUCIOLE_NEEDS_SHARED();
  const Outcome outcome =
      runLine(folder, "luciole render '" + path("36_siblings/points_only.gltf") + "' --size 16x16 -o x.exr");
  EXPECT_THAT(outcome.err, HasSubstr("meshes[0].primitives[0]: mode 0 is of points"));
}

}  // namespace
}  // namespace luciole::test
