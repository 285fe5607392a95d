#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "luciole/animation.hpp"
#include "luciole/light.hpp"
#include "luciole/model.hpp"
#include "luciole/shader.hpp"
#include "luciole/texture.hpp"
#include "luciole/warning.hpp"

namespace luciole {

enum class Wrap : std::int32_t { kRepeat, kMirroredRepeat, kClampToEdge };  // as wide as vector lanes

/// The levels of a texture's mip chain that are sampled where a pixel covers several texels.
enum class Mips : std::uint8_t {
  kBlended,  ///< the two nearest in size, interpolated
  kNearest,  ///< the nearest
  kNone,     ///< the finest one
};

/// A material's texture, and how it is sampled. `texture` indexes Scene::textures; -1: no texture.
struct TextureUse {
  int texture = -1;
  Wrap wrap_u = Wrap::kRepeat;
  Wrap wrap_v = Wrap::kRepeat;
  /// The nearest texel instead of a mix of the four around a point, where a texel is larger than a pixel …
  bool nearest_magnified = false;
  bool nearest_minified = false;  ///< … and where it is smaller
  Mips mips = Mips::kBlended;
};

/// A limit of Material::normal_scale.
inline constexpr float kMostNormalScale = 1000;

/// A microfacet surface, as glTF's materials are.
struct Facets {
  glm::vec3 f0{0.0f};  ///< the share of light that it reflects head-on
  float alpha = 1.0f;  ///< GGX's, in (0, 1]: the square of glTF's roughness
};

/// Phong's reflection coefficients, linear Rec.709. Defaults are OpenGL's.
/// The diffuse map multiplies ambient and diffuse; vertex colours likewise, and emission where it says so.
struct Material {
  std::string name = {};
  glm::vec3 ambient{0.2f};
  glm::vec3 diffuse{0.8f};
  glm::vec3 specular{0.0f};
  glm::vec3 emission{0.0f};
  float shininess = 0.0f;  ///< exponent n ≥ 0 of the specular lobe
  TextureUse diffuse_map = {};
  TextureUse emission_map = {};
  /// Bends the normals that surfaces are lit by, with Shading::kPhong. Of a texture of TextureKind::kNormals
  /// or kBump.
  TextureUse normal_map = {};
  float normal_scale = 1.0f;  ///< multiplies the map's slopes; |normal_scale| ≤ kMostNormalScale
  TextureUse alpha_map = {};  ///< opacity: its alpha where it has one that varies, else its red (OBJ map_d)
  float alpha = 1.0f;         ///< constant opacity, multiplied with the maps' and the vertex colour's alpha
  float alpha_cutoff = 0.0f;  ///< a sample whose opacity is below it is a hole; 0: everything is opaque
  /// For cameras the surface is dithered by its opacity: a sample shows it or not, so that the share of
  /// samples that do is the opacity. alpha_cutoff holds for shadows alone.
  bool blended = false;
  bool double_sided = false;        ///< otherwise back faces are culled
  bool colored_emission = false;    ///< vertex colours multiply the emission too
  std::optional<Model> model = {};  ///< how it reflects light; none: as the picture's settings say
  /// The microfacets that `specular` and `shininess`, which are of Phong's model, approximate. See
  /// takeFacets().
  std::optional<Facets> facets = {};
  std::uint32_t emits = 0;  ///< how many lights take the place of each object's triangles of it that glow
};

/// An indexed triangle mesh in its own (object) space, metres. All per-vertex arrays have positions.size()
/// elements or, where optional, none. Counter-clockwise triangles face the viewer.
struct Mesh {
  std::string name = {};
  std::vector<glm::vec3> positions = {};
  std::vector<glm::vec3> normals = {};  ///< unit, never missing: loaders make them, or addNormals()
  std::vector<glm::vec2> uvs = {};  ///< optional; v grows downwards: (0,0) is the picture's top left corner
  std::vector<glm::vec2> emission_uvs = {};  ///< optional; emission maps use these instead of `uvs`
  /// Optional; the direction of a normal map's red, unit, and in w the side of green: ±1 × cross(normal,
  /// tangent) points up in the picture. All zero at vertices that have none: normals there aren't bent.
  std::vector<glm::vec4> tangents = {};
  std::vector<glm::vec2> normal_uvs = {};  ///< optional; normal maps use these instead of `uvs`
  /// Optional; light maps are laid out by these instead of `uvs`. They may be any numbers.
  std::vector<glm::vec2> lightmap_uvs = {};
  std::vector<glm::vec4> colors = {};  ///< optional; linear RGBA that multiplies the material's
  std::vector<glm::uvec3> triangles = {};
  std::vector<std::uint32_t> triangle_materials = {};  ///< one a triangle, indexes Scene::materials
  std::vector<std::uint32_t> sources = {};  ///< of a mesh that deforms: which vertex of the RestShape each is
  /// The same surface in smaller triangles, which takes its place where colours are lit at vertices (Gouraud
  /// shading). Null: the mesh itself.
  std::shared_ptr<const Mesh> divided = {};
};

/// A mesh placed in the world.
struct Object {
  std::uint32_t mesh = 0;
  glm::dmat4 object_to_world{1.0};
  int material = -1;      ///< replaces the material of every triangle of the mesh, unless -1
  std::string name = {};  ///< may be empty; need not be unique
  /// How many lights take the place of those of its triangles that glow; 0: of those whose material emits.
  std::uint32_t emits = 0;
};

enum class FogMode : std::uint8_t { kNone, kLinear, kExp, kExp2 };

/// OpenGL's fog: colour = f·colour + (1 − f)·fog colour, with f = (end − z)/(end − start), exp(−density·z) or
/// exp(−(density·z)²), clamped to [0,1]. Defaults are OpenGL's.
struct Fog {
  FogMode mode = FogMode::kNone;
  bool radial = false;      ///< z is the distance from the eye instead of the depth along the view axis
  glm::vec3 density{1.0f};  ///< per channel, 1/m, ≥ 0; not for kLinear
  float start = 0.0f;       ///< metres, kLinear only
  float end = 1.0f;         ///< metres, kLinear only
  glm::vec3 color{0.0f};
};

/// Limits of Camera::shift and Camera::pixel_aspect.
inline constexpr double kMostLensShift = 1e6, kMostPixelAspect = 1e6;

/// A camera looks along its −z, x to the right, y up (OpenGL's eye space, which is also glTF's). Without skew
/// a matrix of intrinsics, in pixels from the top left corner of a picture of w × h pixels, is
///
///     fx 0  cx      fov_y        = 2 atan(h / (2 fy))
///     0  fy cy      shift        = (2 cx / w − 1, 1 − 2 cy / h)
///     0  0  1       pixel_aspect = fy / fx
///
/// OpenCV counts from the middle of the top left pixel instead: there cx and cy are smaller by ½.
struct Camera {
  std::string name = {};
  glm::dmat4 camera_to_world{1.0};  ///< a rigid motion: rotation and translation only
  bool orthographic = false;
  double fov_y = 0.7853981633974483;  ///< radians, perspective only
  double half_height = 1.0;           ///< metres, orthographic only
  /// Where the axis of the view meets the picture, from its middle: x to the right in halves of its width, y
  /// upwards in halves of its height. Each from −kMostLensShift to kMostLensShift.
  glm::dvec2 shift{0.0};
  /// The width by the height of what a pixel shows, 1 / kMostPixelAspect to kMostPixelAspect.
  double pixel_aspect = 1.0;
  double near = 0.1;    ///< metres, > 0
  double far = 1000.0;  ///< metres, > near; of a perspective camera it may be infinite
  /// The point that it looks at, world, metres; empty: not known. Cameras that orbit go around it.
  std::optional<glm::dvec3> target = {};
  glm::dvec3 up{0.0, 1.0, 0.0};  ///< upwards, world, of any length but 0; the axis of an orbit
};

/// Everything a picture is made of: the output of the loaders, and the input of every later stage.
/// Indices are valid, and numbers finite unless their comment says otherwise: see validateScene().
struct Scene {
  std::string name = {};               ///< the file, for messages and metadata
  std::vector<Warning> warnings = {};  ///< all of them; the command line prints them
  /// Picture files that the scene names and that don't exist, a line each as above. Materials are loaded
  /// without them; loadScene() decides whether that is an error.
  std::vector<std::string> missing_textures = {};
  /// glTF extensions that a file uses and that are not supported, each once. There is a warning of each.
  std::vector<std::string> ignored_extensions = {};
  std::vector<std::string> variants = {};    ///< of a glTF file: names of KHR_materials_variants
  std::vector<std::string> animations = {};  ///< of a glTF file: their names, or indices where they have none
  std::vector<Texture> textures = {};
  std::vector<Material> materials = {};
  std::vector<Shader> user_models = {};  ///< ShaderKind::kModel; userModel(i) is that with the index i
  std::vector<Mesh> meshes = {};
  std::vector<Object> objects = {};
  std::vector<Light> lights = {};  ///< the scene's own, then those of sources
  std::size_t source_lights = 0;   ///< how many of them take the place of `sources` and of what glows
  std::vector<LightSource> sources = {};
  std::vector<Luminaire> luminaires = {};
  std::vector<std::string> light_groups{"default"};  ///< names; the first is of lights that name no group
  std::vector<Camera> cameras = {};     ///< may be empty after a loader; never after completeScene()
  std::optional<glm::ivec2> size = {};  ///< the picture's size that the file asks for
  glm::vec3 background{0.0f};
  glm::vec3 ambient{0.0f};  ///< the light model's global ambient light
  Fog fog = {};
  bool says_light = false;   ///< the file has lights, or asks for none
  bool adds_camera = false;  ///< completeScene() added a camera, because the file has none
  bool adds_lights = false;  ///< completeScene() added lights, because the file says nothing about light
  bool lighting = true;      ///< false: every surface shows its emission + diffuse colour unlit
  Animation animation = {};  ///< by which poseScene() sets cameras, lights, objects and meshes
};

/// Which of a glTF file's choices a scene shows.
struct GltfChoice {
  std::string variant{};    ///< of materials (KHR_materials_variants), by its name; "": the default materials
  std::string animation{};  ///< the only one that runs, by its name or counted from 0; "": all run together
};

/// The models of the scene's surfaces. O(triangles) if any material has a model of its own.
ModelChoices modelChoices(const Scene& scene);

/// The model of a shader's file, which is added to the scene's unless it is there already. Throws as
/// readShader(), and InputError for more than kMostUserModels.
Model addUserModel(const std::string& path, Scene& scene);

/// Sets `specular` and `shininess` of materials with `facets` and no model of their own to what
/// Model::kCookTorrance and Model::kWard take: f0, and 2/α² − 2. For scenes that are shown by one of them.
void takeFacets(Scene& scene);

/// Fills Mesh::normals of meshes that have none: smooth, the mean of the unit normals of the triangles that
/// use a vertex, each weighted by its angle there (Thürmer & Wüthrich, "Computing Vertex Normals from
/// Polygonal Facets", 1998). Triangles that share no vertex get flat normals. Where triangles meet at more
/// than 60 degrees, as a box's do, vertices are duplicated, so that the edge stays sharp. Throws InputError
/// where arrays' sizes don't fit or a triangle refers to a vertex that there isn't. O(n log n).
void addNormals(Scene& scene);

/// Computes missing tangents at vertices of materials with a normal map, as M. Mikkelsen's MikkTSpace does
/// for triangles, with v growing upwards ("Simulation of Wrinkled Surfaces Revisited", 2008, and his
/// mikktspace.c, 2011, which glTF prescribes). Corners with the same position, normal and texture coordinates
/// are welded. Around a welded corner, triangles that share an edge and have the same winding in texture
/// space share a tangent: the mean of theirs, each projected into the plane of the normal and weighted by its
/// angle there. Vertices with several tangents are duplicated. Triangles without area in texture space take
/// the tangents of others around their corners; without any the tangent is zero, and the normal isn't bent.
/// The scene must be valid. O(n log n).
void addTangents(Scene& scene);

/// The same for all materials, after those with a normal map, and for the meshes' divided forms: for shaders.
/// What they get differs where texture coordinates jump along an edge but go on alike beyond it, as around a
/// sphere: there the triangles of both sides share a tangent, so that highlights along it show no seam.
void addAllTangents(Scene& scene);

/// Lets lights take the place of the scene's sources and of objects and materials that emit, in place of
/// those that did before: `count` lights each, at the end of Scene::lights. Loaders call it, and poseScene()
/// where it has been called.
/// - An environment is divided into cells of about the same light. Each has a directional light, and together
///   they give a surface that sees all of them the irradiance of the sky.
/// - Faces and glowing triangles have spots that shine as the cosine of the angle to their normal, in places
///   that are spread by area and brightness, and share the light evenly. They stand for both sides of
///   triangles whose material is double-sided.
/// The same scene has the same lights; where there are as many as before, each keeps Light::shadow. Throws
/// InputError for a source out of its range.. O(texels + triangles
/// + lights).
void addSourceLights(Scene& scene);

/// Sets the number of lights for each source and each object or material that emits, and places them.
void setLightCounts(Scene& scene, std::uint32_t count);

/// The lights of a scene that don't take the place of anything.
inline std::span<const Light> ownLights(const Scene& scene) {
  return std::span(scene.lights).first(scene.lights.size() - scene.source_lights);
}

/// Removes all lights, and sources; nothing emits any more.
void clearLights(Scene& scene);

/// The scene's environment, or null: of several the first.
const LightSource* environmentOf(const Scene& scene);

/// The indices of all objects of the scene.
inline std::vector<std::uint32_t> allObjects(const Scene& scene) {
  std::vector<std::uint32_t> all(scene.objects.size());
  std::iota(all.begin(), all.end(), 0u);
  return all;
}

}  // namespace luciole
