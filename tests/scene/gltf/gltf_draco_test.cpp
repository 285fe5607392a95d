#include "scene/gltf/gltf_draco.hpp"

#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "scene/gltf/gltf_file.hpp"

namespace luciole::test {
namespace {

using testing::HasSubstr;

constexpr int kSide = 12;  ///< squares of a waved sheet along x and y

using Corner = std::array<float, 3>;

Corner placeAt(int column, int row) {
  return {float(column) / kSide, float(row) / kSide, 0.1f * std::sin(float(column)) * std::cos(float(row))};
}

/// How a sheet is compressed.
struct Coding {
  int method = draco::MESH_EDGEBREAKER_ENCODING;
  int bits = 0;  ///< of a quantized position; 0: exact
};

class GltfDraco : public GltfTest {
 protected:
  /// The sheet with positions, colours in bytes and coordinates, as a file whose accessors have no data.
  GltfFile compressed(const Coding& coding) {
    draco::TriangleSoupMeshBuilder builder;
    builder.Start(2 * kSide * kSide);
    const int position = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
    const int color = builder.AddAttribute(draco::GeometryAttribute::COLOR, 4, draco::DT_UINT8);
    int face = 0;
    soup.clear();
    const auto add = [&](std::array<std::array<int, 2>, 3> corners) {
      std::array<Corner, 3> p;
      std::array<std::array<std::uint8_t, 4>, 3> c;
      for (std::size_t i = 0; i < 3; ++i) {
        p[i] = placeAt(corners[i][0], corners[i][1]);
        c[i] = {std::uint8_t(20 * corners[i][0]), std::uint8_t(20 * corners[i][1]), 7, 255};
      }
      soup.push_back(p);
      builder.SetAttributeValuesForFace(position, draco::FaceIndex(face), p[0].data(), p[1].data(),
                                        p[2].data());
      builder.SetAttributeValuesForFace(color, draco::FaceIndex(face++), c[0].data(), c[1].data(),
                                        c[2].data());
    };
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) {
        add({{{x, y}, {x + 1, y}, {x, y + 1}}});
        add({{{x, y + 1}, {x + 1, y}, {x + 1, y + 1}}});
      }
    const std::unique_ptr<draco::Mesh> mesh = builder.Finalize();
    draco::Encoder encoder;
    encoder.SetEncodingMethod(coding.method);
    if (coding.bits > 0) encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, coding.bits);
    draco::EncoderBuffer buffer;
    EXPECT_TRUE(encoder.EncodeMeshToBuffer(*mesh, &buffer).ok());

    GltfFile file;
    const int view = file.addView(std::vector<char>(buffer.data(), buffer.data() + buffer.size()));
    const std::size_t points = mesh->num_points();
    file.root["accessors"] = {
        {{"componentType", kFloat}, {"type", "VEC3"}, {"count", points}},
        {{"componentType", kUnsignedShort}, {"type", "SCALAR"}, {"count", 3 * soup.size()}},
        {{"componentType", kUnsignedByte}, {"normalized", true}, {"type", "VEC4"}, {"count", points}}};
    file.root["extensionsRequired"] = file.root["extensionsUsed"] = {"KHR_draco_mesh_compression"};
    file.root["meshes"] = {{{"primitives",
                             {{{"attributes", {{"POSITION", 0}, {"COLOR_0", 2}}},
                               {"indices", 1},
                               {"extensions",
                                {{"KHR_draco_mesh_compression",
                                  {{"bufferView", view},
                                   {"attributes",
                                    {{"POSITION", mesh->attribute(position)->unique_id()},
                                     {"COLOR_0", mesh->attribute(color)->unique_id()}}}}}}}}}}}};
    return file;
  }
  static json& extension(GltfFile& file) {
    return file.primitive()["extensions"]["KHR_draco_mesh_compression"];
  }

  std::vector<std::array<Corner, 3>> soup;  ///< the triangles of compressed()
};

/// The triangle whose corner is nearest to a point's place, by the sum over its corners in any turn.
double distanceToNearest(const std::array<glm::dvec3, 3>& seen,
                         const std::vector<std::array<Corner, 3>>& soup) {
  double nearest = 1e9;
  for (const std::array<Corner, 3>& triangle : soup)
    for (std::size_t turn = 0; turn < 3; ++turn) {
      double farthest = 0;
      for (std::size_t i = 0; i < 3; ++i) {
        const Corner& corner = triangle[(i + turn) % 3];
        for (int axis = 0; axis < 3; ++axis)
          farthest = std::max(farthest, std::abs(seen[i][axis] - double(corner[std::size_t(axis)])));
      }
      nearest = std::min(nearest, farthest);
    }
  return nearest;
}

TEST_F(GltfDraco, IsTheMeshThatWasCompressed) {
  for (const Coding& coding : {Coding{draco::MESH_EDGEBREAKER_ENCODING, 0},
                               {draco::MESH_EDGEBREAKER_ENCODING, 11},
                               {draco::MESH_SEQUENTIAL_ENCODING, 0},
                               {draco::MESH_SEQUENTIAL_ENCODING, 14}}) {
    const Scene scene = load(compressed(coding));
    EXPECT_TRUE(scene.warnings.empty());
    const Mesh& mesh = scene.meshes.at(0);
    ASSERT_EQ(mesh.triangles.size(), soup.size());
    ASSERT_EQ(mesh.colors.size(), mesh.positions.size());
    // Half a step of the longest side, 1, cut into 2^bits - 1 steps, and a float's rounding.
    const double step = coding.bits == 0 ? 0 : 0.5 / ((1 << coding.bits) - 1) + 0x1p-23;
    for (const glm::uvec3& t : mesh.triangles) {
      const std::array<glm::dvec3, 3> corners{mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]};
      EXPECT_LE(distanceToNearest(corners, soup), step) << coding.method << " " << coding.bits;
    }
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
      EXPECT_EQ(std::round(mesh.colors[i].r * 255), 20 * std::round(mesh.positions[i].x * kSide)) << i;
  }
}

TEST_F(GltfDraco, TheDuckIsTheDuck) {
  LUCIOLE_NEEDS_SHARED();
  Scene plain, packed;
  loadGltf((sharedScenes() / "khronos_Duck/glTF/Duck.gltf").string(), plain);
  loadGltf((sharedScenes() / "khronos_Duck/glTF-Draco/Duck.gltf").string(), packed);
  const Mesh &a = plain.meshes.at(0), &b = packed.meshes.at(0);
  ASSERT_EQ(a.triangles.size(), b.triangles.size());
  glm::vec3 low(1e9f), high(-1e9f), other_low(1e9f), other_high(-1e9f);
  for (const glm::vec3& p : a.positions) low = glm::min(low, p), high = glm::max(high, p);
  for (const glm::vec3& p : b.positions)
    other_low = glm::min(other_low, p), other_high = glm::max(other_high, p);
  // Its positions have 11 bits or more, of the longest side.
  const float step = 0.5f * std::max({high.x - low.x, high.y - low.y, high.z - low.z}) / 2047;
  EXPECT_LE(glm::length(low - other_low), std::sqrt(3.0f) * step);
  EXPECT_LE(glm::length(high - other_high), std::sqrt(3.0f) * step);
  EXPECT_EQ(b.uvs.size(), b.positions.size());
  EXPECT_EQ(b.normals.size(), b.positions.size());
}

TEST_F(GltfDraco, WhatTheExtensionDoesNotNameComesFromItsAccessor) {
  GltfFile file = compressed({});
  extension(file)["attributes"].erase("COLOR_0");
  const std::size_t points = file.accessor(0)["count"].get<std::size_t>();
  file.primitive()["attributes"]["COLOR_0"] =
      file.addAccessor("VEC3", kFloat, 3, std::vector<float>(3 * points, 0.25f));
  const Scene scene = load(file);
  EXPECT_EQ(scene.meshes.at(0).colors.at(5), glm::vec4(0.25f, 0.25f, 0.25f, 1));
}

TEST_F(GltfDraco, DataThatIsCutShortOrChangedIsRefusedOrAMesh) {
  for (const Coding& coding :
       {Coding{draco::MESH_EDGEBREAKER_ENCODING, 11}, {draco::MESH_SEQUENTIAL_ENCODING, 0}}) {
    const GltfFile whole = compressed(coding);
    const std::size_t bytes = whole.root["bufferViews"][0]["byteLength"].get<std::size_t>();
    for (std::size_t length = 1; length < bytes; length += 1 + length / 16) {
      GltfFile file = whole;
      file.root["bufferViews"][0]["byteLength"] = length;
      EXPECT_THAT(error(file), HasSubstr("can't be decoded: ")) << length;
    }
    for (std::size_t place = 11; place < bytes; place += 1 + place / 16) {
      GltfFile file = whole;
      file.data[place] = static_cast<char>(~file.data[place]);
      error(file);  // what it says depends on the place; it must not crash
    }
  }
}

TEST_F(GltfDraco, WhatContradictsTheDataIsRefused) {
  const auto refuses = [&](const char* what, auto change) {
    GltfFile file = compressed({});
    change(file);
    EXPECT_THAT(error(file), HasSubstr(what));
  };
  refuses("bufferView", [](GltfFile& f) { extension(f).erase("bufferView"); });
  refuses("bufferView", [](GltfFile& f) { extension(f)["bufferView"] = 7; });
  refuses("can't be decoded", [](GltfFile& f) { f.data[0] = 'd'; });
  refuses("POSITION: is not in the data", [](GltfFile& f) { extension(f)["attributes"]["POSITION"] = 77; });
  refuses("POSITION: is not in the data", [](GltfFile& f) { extension(f)["attributes"]["POSITION"] = "x"; });
  refuses("has no POSITION", [](GltfFile& f) { extension(f)["attributes"].erase("POSITION"); });
  refuses("TEXCOORD_0: is no attribute of its primitive",
          [](GltfFile& f) { extension(f)["attributes"]["TEXCOORD_0"] = 0; });
  refuses("its accessor 5", [](GltfFile& f) { f.accessor(0)["count"] = 5; });
  refuses("its accessor 3 indices", [](GltfFile& f) { f.accessor(1)["count"] = 3; });
  refuses("has 3 components an element, its accessor 2", [](GltfFile& f) { f.accessor(0)["type"] = "VEC2"; });
  refuses("mode 6 is none of triangles", [](GltfFile& f) { f.primitive()["mode"] = 6; });
}

/// Bytes of a number as Draco's headers have it: seven bits each, the lowest first.
std::string varint(std::uint32_t number) {
  std::string bytes;
  for (; number > 127; number >>= 7) bytes += static_cast<char>(number % 128 + 128);
  return bytes + static_cast<char>(number);
}

/// Data of 100 bytes that begin so: the header of Draco's format `version` with an encoder's type and method.
std::vector<char> draco(int type, int method, const std::string& counts, char version = 2) {
  std::string bytes = "DRACO";
  bytes += {2, version, static_cast<char>(type), static_cast<char>(method), 0, 0};
  bytes += counts;
  bytes.resize(100);
  return {bytes.begin(), bytes.end()};
}

TEST_F(GltfDraco, CountsThatFewBytesCannotHoldAreRefusedBeforeAnythingIsAllocated) {
  const auto refusal = [&](const std::vector<char>& data) {
    GltfFile file = compressed({});
    extension(file)["bufferView"] = file.addView(data);
    return error(file);
  };
  const std::string many = varint(300'000'000), some = varint(10);
  const int mesh = draco::TRIANGULAR_MESH, edgebreaker = draco::MESH_EDGEBREAKER_ENCODING,
            sequential = draco::MESH_SEQUENTIAL_ENCODING;
  const std::string traversal(1, '\0'), no_seams(1, '\0');
  // 200 vertices and 2,000 triangles are 6,000 corners, and as many again for each of 99 attributes.
  const std::string seams = varint(200) + varint(2000) + "\x63" + varint(2000) + some;
  EXPECT_THAT(refusal(draco(mesh, edgebreaker, traversal + seams)),
              HasSubstr("100 bytes can't hold 602210 "));
  EXPECT_THAT(refusal(draco(mesh, edgebreaker, traversal + some + many + no_seams + some + some)),
              HasSubstr("can't hold 900000030 numbers"));
  EXPECT_THAT(refusal(draco(mesh, edgebreaker, traversal + many + some + no_seams + some + some)),
              HasSubstr("can't hold 300000050 numbers"));
  EXPECT_THAT(refusal(draco(mesh, sequential, many + some)), HasSubstr("can't hold 900000010 numbers"));
  EXPECT_THAT(refusal(draco(mesh, sequential, some + many)), HasSubstr("can't hold 300000030 numbers"));
  EXPECT_THAT(refusal(draco(draco::POINT_CLOUD, 0, some)), HasSubstr("is no mesh of triangles"));
  EXPECT_THAT(refusal(draco(mesh, 2, some)), HasSubstr("method 2"));
  EXPECT_THAT(refusal(draco(mesh, sequential, some, 1)), HasSubstr("is of version 2.1"));
}

/// A flat grid of 128 x 128 squares and attributes of 100 zeros a vertex, which take nearly no bytes.
std::vector<char> packedGrid(int attributes) {
  constexpr std::uint32_t kPlaces = 129, kPoints = kPlaces * kPlaces;
  draco::Mesh mesh;
  mesh.set_num_points(kPoints);
  draco::GeometryAttribute attribute;
  attribute.Init(draco::GeometryAttribute::POSITION, nullptr, 3, draco::DT_FLOAT32, false, 12, 0);
  const int position = mesh.AddAttribute(attribute, true, kPoints);
  for (std::uint32_t i = 0; i < kPoints; ++i) {
    const std::uint32_t column = i % kPlaces, row = i / kPlaces;
    const Corner place{float(column), float(row), 0};
    mesh.attribute(position)->SetAttributeValue(draco::AttributeValueIndex(i), place.data());
  }
  attribute.Init(draco::GeometryAttribute::GENERIC, nullptr, 100, draco::DT_UINT8, false, 100, 0);
  for (int i = 0; i < attributes; ++i) mesh.AddAttribute(attribute, true, kPoints);
  for (std::uint32_t i = 0; i + kPlaces < kPoints; ++i) {
    if (i % kPlaces + 1 == kPlaces) continue;
    const draco::PointIndex a(i), b(i + 1), c(i + kPlaces), d(i + kPlaces + 1);
    mesh.AddFace({a, b, c});
    mesh.AddFace({c, b, d});
  }
  draco::Encoder encoder;
  encoder.SetEncodingMethod(draco::MESH_EDGEBREAKER_ENCODING);
  encoder.SetSpeedOptions(3, 3);
  encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, 7);
  draco::EncoderBuffer buffer;
  EXPECT_TRUE(encoder.EncodeMeshToBuffer(mesh, &buffer).ok());
  return {buffer.data(), buffer.data() + buffer.size()};
}

TEST_F(GltfDraco, NeitherAttributesNorViewsThatOverlapHoldMoreThanTheBytesCan) {
  // A byte of the grid stands for 3,260 numbers with one such attribute, and for 5,526 with two.
  const auto fileOf = [&](int attributes) {
    GltfFile file = compressed({});
    file.data.clear();
    file.root["bufferViews"] = json::array();
    file.addView(packedGrid(attributes));
    file.accessor(0)["count"] = 129 * 129;
    file.primitive().erase("indices");
    file.primitive()["attributes"].erase("COLOR_0");
    extension(file)["attributes"] = {{"POSITION", 0}};
    return file;
  };
  GltfFile file = fileOf(1);
  EXPECT_EQ(load(file).meshes.at(0).triangles.size(), 2u * 128 * 128);
  EXPECT_THAT(error(fileOf(2)), HasSubstr("bytes can't hold"));
  file.root["bufferViews"].push_back(file.root["bufferViews"][0]);
  file.root["meshes"][0]["primitives"].push_back(file.primitive());
  EXPECT_EQ(load(file).meshes.at(0).triangles.size(), 2u * 2 * 128 * 128) << "shared";
  file.root["meshes"][0]["primitives"][1]["extensions"]["KHR_draco_mesh_compression"]["bufferView"] = 1;
  EXPECT_THAT(error(file), testing::ContainsRegex("primitives\\[1\\].*: [0-9]+ bytes can't hold"));
}

TEST_F(GltfDraco, PrimitivesOfTheSameDataShareIt) {
  GltfFile file = compressed({});
  file.root["materials"] = {json::object(), json::object()};
  json second = file.primitive();
  second["material"] = 1;
  for (int i = 0; i < 3; ++i) file.root["meshes"][0]["primitives"].push_back(second);
  const Mesh mesh = load(file).meshes.at(0);
  ASSERT_EQ(mesh.triangles.size(), 4 * soup.size());
  const std::size_t points = mesh.positions.size() / 4;
  for (std::size_t i = 0; i < points; ++i) EXPECT_EQ(mesh.positions[i], mesh.positions[3 * points + i]) << i;
  // Other accessors are not the same: COLOR_0 comes from one.
  file.root["meshes"][0]["primitives"][3]["attributes"].erase("COLOR_0");
  EXPECT_THAT(error(file), HasSubstr("primitives[3].KHR_draco_mesh_compression.COLOR_0: is no attribute"));
}

TEST_F(GltfDraco, AStripIsItsTriangles) {
  GltfFile file = compressed({});
  file.primitive()["mode"] = 5;
  file.accessor(1)["count"] = 100;
  EXPECT_EQ(load(file).meshes.at(0).triangles.size(), soup.size());
}

}  // namespace
}  // namespace luciole::test
