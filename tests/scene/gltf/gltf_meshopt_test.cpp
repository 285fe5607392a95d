#include "scene/gltf/gltf_meshopt.hpp"

#include <meshoptimizer.h>

#include <array>
#include <cstring>

#include "scene/gltf/gltf_file.hpp"

namespace luciole::test {
namespace {

using testing::HasSubstr;

/// A grid of 20 × 20 vertices whose positions, normals and indices are compressed, as gltfpack writes it: the
/// views lie in a buffer that isn't there.
class GltfMeshopt : public GltfTest {
 protected:
  static constexpr std::uint32_t kSide = 20;

  struct Vertex {
    float x, y, z;
  };

  GltfMeshopt() {
    std::vector<Vertex> vertices;
    for (std::uint32_t i = 0; i < kSide * kSide; ++i) {
      const std::uint32_t column = i % kSide, row = i / kSide;
      vertices.push_back({float(column), float(row), float(i % 7) * 0.25f});
    }
    std::vector<std::uint32_t> indices;
    for (std::uint32_t y = 0; y + 1 < kSide; ++y)
      for (std::uint32_t x = 0; x + 1 < kSide; ++x) {
        const std::uint32_t a = y * kSide + x, b = a + kSide;
        indices.insert(indices.end(), {a, a + 1, b, b, a + 1, b + 1});
      }
    positions = vertices;
    triangles = indices;
    std::vector<unsigned char> packed(meshopt_encodeVertexBufferBound(vertices.size(), sizeof(Vertex)));
    packed.resize(meshopt_encodeVertexBuffer(packed.data(), packed.size(), vertices.data(), vertices.size(),
                                             sizeof(Vertex)));
    std::vector<unsigned char> packed_indices(
        meshopt_encodeIndexBufferBound(indices.size(), vertices.size()));
    packed_indices.resize(meshopt_encodeIndexBuffer(packed_indices.data(), packed_indices.size(),
                                                    indices.data(), indices.size()));
    // Octahedral normals, (0, 0, 1) in 8 bits.
    const std::vector<std::array<signed char, 4>> normals(vertices.size(), {0, 0, 127, 0});
    std::vector<unsigned char> packed_normals(meshopt_encodeVertexBufferBound(normals.size(), 4));
    packed_normals.resize(meshopt_encodeVertexBuffer(packed_normals.data(), packed_normals.size(),
                                                     normals.data(), normals.size(), 4));
    file.root["meshes"] = {
        {{"primitives", {{{"attributes", {{"POSITION", 0}, {"NORMAL", 2}}}, {"indices", 1}}}}}};
    addView("ATTRIBUTES", vertices.size(), sizeof(Vertex), packed, "NONE");
    addView("TRIANGLES", indices.size(), 4, packed_indices, "NONE");
    addView("ATTRIBUTES", normals.size(), 4, packed_normals, "OCTAHEDRAL");
    const std::size_t n = vertices.size();
    file.root["accessors"] = {
        {{"bufferView", 0}, {"componentType", kFloat}, {"type", "VEC3"}, {"count", n}},
        {{"bufferView", 1}, {"componentType", kUnsignedInt}, {"type", "SCALAR"}, {"count", indices.size()}},
        {{"bufferView", 2}, {"componentType", kByte}, {"normalized", true}, {"type", "VEC3"}, {"count", n}}};
    file.root["bufferViews"][2]["byteStride"] = 4;
    file.root["extensionsRequired"] =
        file.root["extensionsUsed"] = {"EXT_meshopt_compression", "KHR_mesh_quantization"};
  }

  void addView(const char* mode, std::size_t count, std::size_t stride,
               const std::vector<unsigned char>& packed, const char* filter) {
    while (file.data.size() % 4) file.data += '\0';
    const json extension = {
        {"buffer", 0},     {"byteOffset", file.data.size()}, {"byteLength", packed.size()},
        {"count", count},  {"byteStride", stride},           {"mode", mode},
        {"filter", filter}};
    file.root["bufferViews"].push_back({{"buffer", 1},
                                        {"byteOffset", missing_bytes},
                                        {"byteLength", count * stride},
                                        {"extensions", {{"EXT_meshopt_compression", extension}}}});
    missing_bytes += count * stride;
    file.data.append(packed.begin(), packed.end());
  }
  json& extension(int view) {
    return file.root["bufferViews"][view]["extensions"]["EXT_meshopt_compression"];
  }

  /// As load(), with the second buffer that has no bytes; as a .glb, too.
  Scene loadCompressed(bool as_binary = false) {
    json buffers = {
        {{"byteLength", file.data.size()}},
        {{"byteLength", missing_bytes}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}}};
    const std::string path = folder / (as_binary ? "a.glb" : "a.gltf");
    if (as_binary) {
      file.root["buffers"] = buffers;
      std::string text = file.root.dump();
      text.append((4 - text.size() % 4) % 4, ' ');
      std::string data = file.data;
      data.append((4 - data.size() % 4) % 4, '\0');
      std::ofstream out(path, std::ios::binary);
      const auto word = [&](std::size_t value) {
        const std::uint32_t bits = std::uint32_t(value);
        out.write(reinterpret_cast<const char*>(&bits), 4);
      };
      out << "glTF";
      word(2);
      word(12 + 8 + text.size() + 8 + data.size());
      word(text.size());
      out << "JSON" << text;
      word(data.size());
      out << std::string("BIN\0", 4) << data;
    } else {
      buffers[0]["uri"] = "data.bin";
      file.root["buffers"] = buffers;
      std::ofstream(folder / "data.bin", std::ios::binary) << file.data;
      std::ofstream(path) << file.root.dump();
    }
    Scene scene;
    loadGltf(path, scene);
    return scene;
  }
  std::string refusal() {
    try {
      loadCompressed();
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), testing::Not(HasSubstr("\n")));
      return error.what();
    }
    return "no error";
  }

  GltfFile file;
  std::size_t missing_bytes = 0;
  std::vector<Vertex> positions;
  std::vector<std::uint32_t> triangles;
};

TEST_F(GltfMeshopt, GivesBackWhatWasCompressed) {
  for (const bool as_binary : {false, true}) {
    const Scene scene = loadCompressed(as_binary);
    EXPECT_TRUE(scene.warnings.empty());
    const Mesh& mesh = scene.meshes.at(0);
    ASSERT_EQ(mesh.positions.size(), positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i) {
      EXPECT_EQ(mesh.positions[i], glm::vec3(positions[i].x, positions[i].y, positions[i].z));
      EXPECT_EQ(mesh.normals[i], glm::vec3(0, 0, 1));
    }
    ASSERT_EQ(3 * mesh.triangles.size(), triangles.size());
    // The coder may turn a triangle's corners round, and nothing else.
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const glm::uvec3 expected(triangles[3 * t], triangles[3 * t + 1], triangles[3 * t + 2]),
          got = mesh.triangles[t];
      EXPECT_TRUE(got == expected || got == glm::uvec3(expected.y, expected.z, expected.x) ||
                  got == glm::uvec3(expected.z, expected.x, expected.y))
          << t;
    }
  }
}

TEST_F(GltfMeshopt, DataCutShortIsRefused) {
  for (const int view : {0, 1, 2}) {
    const std::size_t length = extension(view)["byteLength"];
    // A stream whose middle is missing may end well, but one that ends early does not.
    for (const std::size_t cut : {std::size_t(0), std::size_t(1), length / 2, length - 1}) {
      extension(view)["byteLength"] = cut;
      EXPECT_THAT(refusal(), testing::AnyOf(HasSubstr("cut short"), HasSubstr("can't hold")))
          << view << " " << cut;
    }
    extension(view)["byteLength"] = length;
  }
}

TEST_F(GltfMeshopt, SizesThatLieAreRefusedBeforeAnythingIsAllocated) {
  extension(0)["count"] = 2'000'000'000;
  EXPECT_THAT(refusal(), HasSubstr("but the view has"));
  file.root["bufferViews"][0]["byteLength"] = 24'000'000'000u;
  EXPECT_THAT(refusal(), HasSubstr("can't hold"));
  file.root["bufferViews"][0]["byteLength"] = kSide * kSide * sizeof(Vertex);
  for (const auto& [member, value, what] : std::vector<std::tuple<const char*, json, const char*>>{
           {"count", -1, "count is -1"},
           {"byteStride", 13, "byteStride is 13"},
           {"byteStride", 260, "byteStride is 260"},
           {"mode", "LINES", "mode is none of"},
           {"filter", "QUATERNION", "filter"},
           {"buffer", 9, "buffer"},
           {"byteOffset", 1'000'000, "reach past its buffer"},
           {"byteLength", 1'000'000, "reach past its buffer"}}) {
    const json before = extension(0);
    extension(0)["count"] = kSide * kSide;
    extension(0)[member] = value;
    EXPECT_THAT(refusal(), HasSubstr(what)) << member;
    extension(0) = before;
  }
  file.root["bufferViews"][0]["extensions"]["EXT_meshopt_compression"] = {{"mode", 3}};
  EXPECT_THAT(refusal(), HasSubstr("bufferViews[0].EXT_meshopt_compression"));
}

}  // namespace
}  // namespace luciole::test
