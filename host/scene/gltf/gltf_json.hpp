#pragma once

#include <cstddef>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace luciole {

// A glTF file's JSON as it is written, with the specification's defaults. Indices are -1 where there are
// none, and else any number: they may lie beyond their list.

using GltfJson = nlohmann::json;

struct GltfBuffer {
  std::optional<std::string> uri;
  std::size_t length = 0;  ///< that the file says; `bytes` may be more
  std::span<const std::byte> bytes;
};

struct GltfView {
  int buffer = -1;
  std::size_t offset = 0, length = 0;
  std::size_t stride = 0;  ///< 0: elements lie one behind the other
  GltfJson extensions;
};

/// The numbers of glTF's componentType.
enum : int {
  kGltfByte = 5120,
  kGltfUnsignedByte = 5121,
  kGltfShort = 5122,
  kGltfUnsignedShort = 5123,
  kGltfUnsignedInt = 5125,
  kGltfFloat = 5126
};

/// The numbers of glTF's primitive modes; those below kGltfTriangles are of points and lines.
enum : int { kGltfTriangles = 4, kGltfStrip = 5, kGltfFan = 6 };

struct GltfSparse {
  std::size_t count = 0, index_offset = 0, value_offset = 0;
  int index_view = -1, index_type = 0, value_view = -1;
};

struct GltfAccessor {
  int view = -1;
  std::size_t offset = 0, count = 0;
  int type = 0;        ///< of its numbers: kGltfByte …
  int components = 0;  ///< numbers an element; 0 for a type that isn't one of glTF's
  bool normalized = false;
  std::optional<GltfSparse> sparse;
};

/// A file that isn't JSON: a picture, or a luminaire's profile.
struct GltfImage {
  std::string name, uri;  ///< uri: without the data of a data URI
  int view = -1;
  std::string file;                  ///< the path of what the uri means; "": there is none
  std::span<const std::byte> bytes;  ///< of a data URI
};

/// The numbers of glTF's samplers, which may be any.
struct GltfSampler {
  std::optional<double> wrap_u, wrap_v, magnified, minified;
};

struct GltfTexture {
  int sampler = -1, source = -1;
  int webp = -1;  ///< EXT_texture_webp's source
  GltfJson extensions;
};

/// How a material uses a texture.
struct GltfTextureInfo {
  int texture = -1, uv_set = 0;
  double scale = 1;  ///< of normals
  /// KHR_texture_transform's offset, scale and rotation; empty: the file says nothing.
  std::vector<double> uv_offset, uv_scale;
  double uv_rotation = 0;
};

/// KHR_materials_specular.
struct GltfSpecular {
  double factor = 1;
  std::vector<double> color_factor;
  GltfTextureInfo texture, color_texture;
};

/// KHR_materials_pbrSpecularGlossiness.
struct GltfGlossy {
  std::vector<double> diffuse_factor, specular_factor;
  double glossiness = 1;
  GltfTextureInfo diffuse, specular_glossiness;
};

struct GltfMaterial {
  std::string name;
  std::vector<double> base_factor, emissive_factor;  ///< empty: the file says nothing
  double metallic = 1, roughness = 1, alpha_cutoff = 0.5;
  GltfTextureInfo base, metallic_roughness, normal, emissive;
  std::string alpha_mode = "OPAQUE";
  bool double_sided = false, unlit = false;
  double emissive_strength = 1, ior = 1.5;
  GltfSpecular specular;
  std::optional<GltfGlossy> glossy;
};

using GltfAttributes = std::map<std::string, int>;  ///< name -> accessor

struct GltfPrimitive {
  GltfAttributes attributes;
  int indices = -1, material = -1, mode = kGltfTriangles;
  std::vector<GltfAttributes> targets;
  GltfJson extensions;
};

struct GltfMesh {
  std::string name;
  std::vector<GltfPrimitive> primitives;
  std::vector<double> weights;
};

/// A node's light of EXT_lights_ies.
struct GltfLuminaire {
  int profile = -1;
  double multiplier = 1;
  std::vector<double> color;
};

struct GltfNode {
  std::string name;
  std::vector<int> children;
  int mesh = -1, camera = -1, skin = -1, light = -1;
  GltfLuminaire luminaire;
  std::vector<double> matrix, translation, rotation, scale, weights;
  bool hidden = false;               ///< with all below it (KHR_node_visibility)
  std::optional<std::string> group;  ///< a text "group" of its extras
  GltfJson extensions;
};

struct GltfSkinEntry {
  std::vector<int> joints;
  int inverse_binds = -1;
};

struct GltfChannel {
  int sampler = -1, node = -1;
  std::string path;
};

struct GltfKeys {
  int input = -1, output = -1;
  std::string interpolation = "LINEAR";
};

struct GltfAnimationEntry {
  std::string name;
  std::vector<GltfChannel> channels;
  std::vector<GltfKeys> samplers;
};

struct GltfCamera {
  std::string name, type;
  bool orthographic = false;  ///< by its type, else by what it has
  std::optional<double> ymag, yfov, near, far;
};

struct GltfLight {
  std::string name, type;
  std::vector<double> color;
  double intensity = 1, inner_cone = 0, outer_cone = 0.7853981633974483;
  std::optional<double> range;
  std::optional<std::string> group;  ///< as GltfNode has it
};

struct GltfFile {
  std::string version;
  std::vector<std::string> extensions_used, extensions_required;
  GltfJson extensions;
  std::vector<GltfBuffer> buffers;
  std::vector<GltfView> views;
  std::vector<GltfAccessor> accessors;
  std::vector<GltfImage> images;
  std::vector<GltfSampler> samplers;
  std::vector<GltfTexture> textures;
  std::vector<GltfMaterial> materials;
  std::vector<GltfMesh> meshes;
  std::vector<GltfNode> nodes;
  std::vector<GltfSkinEntry> skins;
  std::vector<GltfAnimationEntry> animations;
  std::vector<GltfCamera> cameras;
  std::vector<GltfLight> lights;         ///< KHR_lights_punctual's
  std::vector<GltfImage> profiles;       ///< files of EXT_lights_ies
  std::vector<std::vector<int>> scenes;  ///< their nodes
  int scene = -1;
};

struct GltfModel;

/// Reads a file's JSON into `model.file`. Throws InputError, which names the place, for what isn't JSON, is
/// nested too deep, or has a value of another kind than the specification says. Negative indices become -1,
/// bytes that are no UTF-8 Latin-1's letters, and zeros behind it are left out, each with a warning.
void parseGltf(std::string_view text, GltfModel& model);

/// The bytes of a component of an accessor; 0 for a type that isn't one of glTF's.
std::size_t gltfComponentSize(int type);

}  // namespace luciole
