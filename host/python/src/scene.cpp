// Scenes from arrays.
#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/variant.h>
#include <nanobind/stl/vector.h>

#include <sys/mman.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <luciole/error.hpp>
#include <luciole/load_scene.hpp>
#include <luciole/pose.hpp>
#include <luciole/validate_scene.hpp>
#include <set>
#include <span>
#include <string>
#include <thread>
#include <tuple>
#include <variant>

#include "arrays.hpp"
#include "bindings.hpp"
#include "scene_handle.hpp"

namespace luciole::python {
namespace {

using Vec3 = std::array<double, 3>;

glm::dvec3 dvec3Of(const Vec3& v) { return {v[0], v[1], v[2]}; }
glm::vec3 vec3Of(const Vec3& v) { return glm::vec3(dvec3Of(v)); }
Vec3 listOf(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

/// In a turn of the scene and without Python's lock.
template <class Use>
auto inTurn(SceneHandle& handle, const Use& use) {
  const nb::gil_scoped_release unlocked;
  const auto turn = handle.turn();
  return use();
}

/// The lights of one kind that Python's arrays tell of. See luciole/lights.py for each.
struct LightColumns {
  LightKind kind;
  std::size_t count;
  std::string group;
  RangeWindow window;
  SpotFalloff falloff;
  std::optional<Column> position, direction, ambient, specular;
  Column color, attenuation, range, cutoff, inner_cone, exponent, radius, half_angle, shadow;
  std::vector<InRows> arrays;  ///< so that they stay
};

void fillLight(const LightColumns& columns, std::uint32_t group, std::size_t i, Light& light) {
  light = {.kind = columns.kind, .group = group};
  if (columns.position) light.position = columns.position->vec3(i);
  if (columns.direction) light.direction = glm::normalize(columns.direction->vec3(i));
  light.diffuse = glm::vec3(columns.color.vec3(i));
  light.specular = columns.specular ? glm::vec3(columns.specular->vec3(i)) : light.diffuse;
  if (columns.ambient) light.ambient = glm::vec3(columns.ambient->vec3(i));
  light.attenuation = glm::vec3(columns.attenuation.vec3(i));
  light.range = float(columns.range.at(i));
  light.window = columns.window;
  light.falloff = columns.falloff;
  light.cutoff = columns.cutoff.at(i);
  light.inner_cone = columns.inner_cone.at(i);
  light.exponent = float(columns.exponent.at(i));
  light.radius = columns.radius.at(i);
  light.half_angle = columns.half_angle.at(i);
  light.shadow = columns.shadow.at(i) != 0;
}

/// Fills the lights from `first` on, by two threads where that pays.
void fillLights(const LightColumns& columns, std::uint32_t group, std::size_t first,
                std::vector<Light>& lights) {
  constexpr std::size_t kWorthThreads = 50000;
  const auto fill = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) fillLight(columns, group, i, lights[first + i]);
  };
  const std::size_t middle = columns.count < kWorthThreads ? 0 : columns.count / 2;
  std::thread half;
  if (middle > 0) half = std::thread([&] { fill(0, middle); });
  fill(middle, columns.count);
  if (half.joinable()) half.join();
}

/// The number of a group of lights, which is added where there is none of the name.
std::uint32_t groupNamed(const std::string& name, Scene& scene) {
  if (name.empty()) return 0;
  const auto found = std::find(scene.light_groups.begin(), scene.light_groups.end(), name);
  const auto number = std::uint32_t(found - scene.light_groups.begin());
  if (found == scene.light_groups.end()) scene.light_groups.push_back(name);
  return number;
}

/// An environment or a face, and its group's name.
struct NamedSource {
  LightSource source;
  std::string group;
};

/// Asks for memory of huge pages, before it is touched: it then takes a tenth of the time to get.
void preferHugePages(void* memory, std::size_t bytes) {
  constexpr std::uintptr_t kPage = std::uintptr_t(2) << 20;
  const auto begin = (reinterpret_cast<std::uintptr_t>(memory) + kPage - 1) / kPage * kPage;
  const auto end = (reinterpret_cast<std::uintptr_t>(memory) + bytes) / kPage * kPage;
  if (begin < end) madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
}

/// Replaces the scene's lights. Those that it has had keep their memory, which takes longer to get than to
/// fill.
void setLights(SceneHandle& handle, const std::vector<const LightColumns*>& all,
               const std::vector<const NamedSource*>& sources) {
  inTurn(handle, [&] {
    Scene& scene = handle.sceneToChange();
    scene.source_lights = 0;
    scene.sources.clear();
    scene.animation.sources.clear();
    std::size_t count = 0;
    for (const LightColumns* columns : all) count += columns->count;
    if (count > scene.lights.capacity()) {
      scene.lights.clear();
      scene.lights.reserve(count);
      preferHugePages(scene.lights.data(), count * sizeof(Light));
    }
    scene.lights.resize(count);
    scene.light_groups.resize(1);
    // What moved the lights that were there.
    scene.animation.lights.clear();
    scene.animation.attached_lights.clear();
    std::size_t first = 0;
    for (const LightColumns* columns : all) {
      fillLights(*columns, groupNamed(columns->group, scene), first, scene.lights);
      first += columns->count;
    }
    for (const NamedSource* named : sources) {
      scene.sources.push_back(named->source);
      scene.sources.back().group = groupNamed(named->group, scene);
    }
    addSourceLights(scene);
  });
}

NamedSource environment(const std::variant<std::string, In<float, nb::shape<-1, -1, 3>>>& image,
                        double rotate, const Vec3& color, std::uint32_t count, bool shadow,
                        const std::string& group) {
  LightSource source{.kind = SourceKind::kEnvironment, .shadow = shadow, .count = count};
  source.radiance = vec3Of(color);
  source.rotate = glm::radians(rotate);
  std::vector<Warning> warnings;
  if (const std::string* path = std::get_if<std::string>(&image)) {
    source.sky = readSky(*path, warnings);
  } else {
    const auto& rows = std::get<1>(image);
    source.sky =
        makeSky(int(rows.shape(1)), int(rows.shape(0)), {rows.data(), rows.size()}, "image", warnings);
  }
  if (!warnings.empty()) throw InputError("lights: " + warnings.front().text);
  return {source, group};
}

NamedSource face(bool is_disc, const Vec3& position, const Vec3& direction, const Vec3& up, double width,
                 double height, const Vec3& color, std::uint32_t count, bool shadow,
                 const std::string& group) {
  LightSource source{
      .kind = is_disc ? SourceKind::kDisc : SourceKind::kRectangle, .shadow = shadow, .count = count};
  source.radiance = vec3Of(color);
  source.position = dvec3Of(position);
  source.direction = glm::normalize(dvec3Of(direction));
  source.up = glm::normalize(dvec3Of(up));
  source.width = width;
  source.height = height;
  return {source, group};
}

/// What Python's Environment or AreaLight are of.
nb::list listOfSources(SceneHandle& handle) {
  std::vector<NamedSource> all;
  inTurn(handle, [&] {
    const Scene& scene = handle.scene();
    for (const LightSource& source : scene.sources)
      all.push_back({source, source.group > 0 ? scene.light_groups[source.group] : ""});
  });
  nb::list list;
  for (const auto& [source, group] : all) {
    nb::dict of;
    of["color"] = listOf(source.radiance);
    of["count"] = source.count;
    of["cast_shadows"] = source.shadow;
    of["group"] = group;
    if (source.kind == SourceKind::kEnvironment) {
      const SkyLevel& level = source.sky->levels[0];
      of["image"] = arrayOf(std::vector<float>(level.texels.begin(), level.texels.end()),
                            {std::size_t(level.height), std::size_t(level.width), 3});
      of["rotate"] = glm::degrees(source.rotate);
    } else {
      of["disc"] = source.kind == SourceKind::kDisc;
      of["position"] = listOf(source.position);
      of["direction"] = listOf(source.direction);
      of["up"] = listOf(source.up);
      of["width"] = source.width;
      of["height"] = source.height;
    }
    list.append(of);
  }
  return list;
}

/// What lights of one array share: how they fade, and their group.
using LightFamily = std::tuple<int, int, std::string>;

LightFamily familyOf(const Light& light, const Scene& scene) {
  const bool is_named = light.group > 0 && light.group < scene.light_groups.size();
  return {int(light.window), int(light.falloff), is_named ? scene.light_groups[light.group] : ""};
}

LightColumns columnsOf(int kind, std::size_t count, const std::optional<InRows>& position,
                       const std::optional<InRows>& direction, const InRows& color,
                       const std::optional<InRows>& ambient, const std::optional<InRows>& specular,
                       const InRows& attenuation, const InRows& range, int window, int falloff,
                       const InRows& cutoff, const InRows& inner_cone, const InRows& exponent,
                       const InRows& radius, const InRows& half_angle, const InRows& shadow,
                       const std::string& group) {
  LightColumns columns{.kind = LightKind(kind),
                       .count = count,
                       .group = group,
                       .window = RangeWindow(window),
                       .falloff = SpotFalloff(falloff)};
  const auto take = [&](const InRows& rows, std::size_t width) {
    columns.arrays.push_back(rows);
    return columnOf(rows, width, count);
  };
  if (position) columns.position = take(*position, 3);
  if (direction) columns.direction = take(*direction, 3);
  if (ambient) columns.ambient = take(*ambient, 3);
  if (specular) columns.specular = take(*specular, 3);
  columns.color = take(color, 3);
  columns.attenuation = take(attenuation, 3);
  columns.range = take(range, 1);
  columns.cutoff = take(cutoff, 1);
  columns.inner_cone = take(inner_cone, 1);
  columns.exponent = take(exponent, 1);
  columns.radius = take(radius, 1);
  columns.half_angle = take(half_angle, 1);
  columns.shadow = take(shadow, 1);
  return columns;
}

/// The lights of a kind and family as arrays, by the names that columnsOf() has for them.
nb::dict lightArrays(SceneHandle& handle, int kind, int window, int falloff, const std::string& group) {
  const LightFamily family{window, falloff, group};
  std::vector<double> position, direction, cutoff, inner_cone, radius, half_angle;
  std::vector<float> color, ambient, specular, attenuation, range, exponent;
  std::vector<std::uint8_t> shadow;
  inTurn(handle, [&] {
    const std::span<const Light> lights = ownLights(handle.scene());
    const auto add = [](auto& to, const auto& v) { to.insert(to.end(), {v.x, v.y, v.z}); };
    for (const Light& light : lights) {
      if (int(light.kind) != kind || familyOf(light, handle.scene()) != family) continue;
      add(position, light.position);
      add(direction, light.direction);
      add(color, light.diffuse);
      add(ambient, light.ambient);
      add(specular, light.specular);
      add(attenuation, light.attenuation);
      range.push_back(light.range);
      cutoff.push_back(light.cutoff);
      inner_cone.push_back(light.inner_cone);
      exponent.push_back(light.exponent);
      radius.push_back(light.radius);
      half_angle.push_back(light.half_angle);
      shadow.push_back(light.shadow);
    }
  });
  const std::size_t n = range.size();
  nb::dict arrays;
  arrays["position"] = arrayOf(std::move(position), {n, 3});
  arrays["direction"] = arrayOf(std::move(direction), {n, 3});
  arrays["color"] = arrayOf(std::move(color), {n, 3});
  arrays["ambient"] = arrayOf(std::move(ambient), {n, 3});
  arrays["specular"] = arrayOf(std::move(specular), {n, 3});
  arrays["attenuation"] = arrayOf(std::move(attenuation), {n, 3});
  arrays["range"] = arrayOf(std::move(range), {n});
  arrays["cutoff"] = arrayOf(std::move(cutoff), {n});
  arrays["inner_cone"] = arrayOf(std::move(inner_cone), {n});
  arrays["exponent"] = arrayOf(std::move(exponent), {n});
  arrays["radius"] = arrayOf(std::move(radius), {n});
  arrays["half_angle"] = arrayOf(std::move(half_angle), {n});
  arrays["cast_shadows"] = arrayOf(std::move(shadow), {n});
  return arrays;
}

void fillMaterial(Material& material, const std::string& name, const Vec3& ambient, const Vec3& diffuse,
                  const Vec3& specular, const Vec3& emission, double shininess, double alpha,
                  double alpha_cutoff, bool blended, bool double_sided, int model,
                  const std::array<int, 4>& maps, double normal_scale, std::uint32_t emits) {
  material.emits = emits;
  material.name = name;
  material.ambient = vec3Of(ambient);
  material.diffuse = vec3Of(diffuse);
  material.specular = vec3Of(specular);
  material.emission = vec3Of(emission);
  material.shininess = float(shininess);
  material.alpha = float(alpha);
  material.alpha_cutoff = float(alpha_cutoff);
  material.blended = blended;
  material.double_sided = double_sided;
  material.model.reset();
  if (model >= 0) material.model = Model(model);
  constexpr int kKeep = -2;
  TextureUse* const uses[] = {&material.diffuse_map, &material.emission_map, &material.normal_map,
                              &material.alpha_map};
  for (std::size_t i = 0; i < maps.size(); ++i)
    if (maps[i] != kKeep) uses[i]->texture = maps[i];
  material.normal_scale = float(normal_scale);
}

Camera cameraOf(const std::string& name, const In<double, nb::shape<4, 4>>& camera_to_world,
                bool orthographic, double fov_y, double half_height, const std::array<double, 2>& shift,
                double pixel_aspect, double near, double far, const std::optional<Vec3>& target,
                const Vec3& up) {
  Camera camera{.name = name,
                .camera_to_world = matrixOf(camera_to_world.data()),
                .orthographic = orthographic,
                .fov_y = fov_y,
                .half_height = half_height,
                .shift = {shift[0], shift[1]},
                .pixel_aspect = pixel_aspect,
                .near = near,
                .far = far,
                .up = dvec3Of(up)};
  if (target) camera.target = dvec3Of(*target);
  if (const std::string fault = cameraFault(camera); !fault.empty()) throw InputError("camera." + fault);
  return camera;
}

nb::object arrayOfMatrix(const glm::dmat4& matrix) {
  std::vector<double> rows(16);
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) rows[std::size_t(4 * row + column)] = matrix[column][row];
  return nb::cast(arrayOf(std::move(rows), {4, 4}));
}

std::uint32_t addMesh(SceneHandle& handle, const std::string& name,
                      const In<float, nb::shape<-1, 3>>& positions,
                      const std::optional<In<float, nb::shape<-1, 3>>>& normals,
                      const std::optional<In<float, nb::shape<-1, 2>>>& uvs,
                      const std::optional<In<float, nb::shape<-1, 4>>>& colors,
                      const In<std::uint32_t, nb::shape<-1, 3>>& triangles,
                      const In<std::uint32_t, nb::ndim<1>>& triangle_materials) {
  return inTurn(handle, [&] {
    Scene& scene = handle.sceneToBuild("meshes");
    Mesh mesh{.name = name, .positions = vectorsOf<glm::vec3>(positions.data(), positions.shape(0))};
    if (normals) mesh.normals = vectorsOf<glm::vec3>(normals->data(), normals->shape(0));
    if (uvs) mesh.uvs = vectorsOf<glm::vec2>(uvs->data(), uvs->shape(0));
    if (colors) mesh.colors = vectorsOf<glm::vec4>(colors->data(), colors->shape(0));
    const auto* const corners = reinterpret_cast<const glm::uvec3*>(triangles.data());
    mesh.triangles.assign(corners, corners + triangles.shape(0));
    mesh.triangle_materials.assign(triangle_materials.data(),
                                   triangle_materials.data() + triangle_materials.shape(0));
    scene.meshes.push_back(std::move(mesh));
    return std::uint32_t(scene.meshes.size() - 1);
  });
}

void bindLights(nb::class_<SceneHandle>& scene) {
  scene.def("set_lights", setLights)
      .def("light_arrays", lightArrays)
      .def("light_families",
           [](SceneHandle& handle) {
             std::set<LightFamily> families;
             inTurn(handle, [&] {
               for (const Light& light : ownLights(handle.scene()))
                 families.insert(familyOf(light, handle.scene()));
             });
             return std::vector<LightFamily>(families.begin(), families.end());
           })
      .def("sources", listOfSources)
      .def("light_count",
           [](SceneHandle& handle) { return inTurn(handle, [&] { return handle.scene().lights.size(); }); });
}

int addTexture(SceneHandle& handle, const In<std::uint16_t, nb::shape<-1, -1, 4>>& texels, bool is_normals,
               bool is_linear, const std::string& name) {
  return inTurn(handle, [&] {
    std::vector<Texture>& textures = handle.sceneToBuild("textures").textures;
    textures.push_back(makeTexture(int(texels.shape(1)), int(texels.shape(0)), {texels.data(), texels.size()},
                                   is_normals ? TextureKind::kNormals : TextureKind::kColor, is_linear,
                                   name));
    return int(textures.size() - 1);
  });
}

/// After the last mesh: adds what meshes lack.
void finishMeshes(SceneHandle& handle) {
  inTurn(handle, [&] {
    Scene& scene = handle.sceneToBuild("meshes");
    addNormals(scene);
    validateScene(scene);
    addTangents(scene);
  });
}

void bindParts(nb::class_<SceneHandle>& scene) {
  scene.def("add_texture", addTexture)
      .def("finish_meshes", finishMeshes)
      .def("set_material",
           [](SceneHandle& handle, int index, const std::string& name, const Vec3& ambient,
              const Vec3& diffuse, const Vec3& specular, const Vec3& emission, double shininess, double alpha,
              double alpha_cutoff, bool blended, bool double_sided, int model, const std::array<int, 4>& maps,
              double normal_scale, std::uint32_t emits) {
             return inTurn(handle, [&] {
               const bool is_new = index < 0;
               Scene& to = is_new ? handle.sceneToBuild("materials") : handle.sceneToChange();
               if (is_new) index = int(to.materials.size());
               if (is_new) to.materials.emplace_back();
               if (std::size_t(index) >= to.materials.size()) throw InputError("materials: no such index");
               fillMaterial(to.materials[std::size_t(index)], name, ambient, diffuse, specular, emission,
                            shininess, alpha, alpha_cutoff, blended, double_sided, model, maps, normal_scale,
                            emits);
               if (!is_new) addSourceLights(to);
               return index;
             });
           })
      .def("add_mesh", addMesh, nb::arg("name"), nb::arg("positions"), nb::arg("normals").none(),
           nb::arg("uvs").none(), nb::arg("colors").none(), nb::arg("triangles"),
           nb::arg("triangle_materials"))
      .def("add_objects",
           [](SceneHandle& handle, std::uint32_t mesh, const In<double, nb::shape<-1, 4, 4>>& transforms,
              int material, const std::string& name) {
             inTurn(handle, [&] {
               Scene& to = handle.sceneToBuild("objects");
               for (std::size_t i = 0; i < transforms.shape(0); ++i)
                 to.objects.push_back({mesh, matrixOf(transforms.data() + 16 * i), material, name});
             });
           })
      .def("set_transforms",
           [](SceneHandle& handle, std::size_t first, const In<double, nb::shape<-1, 4, 4>>& transforms) {
             inTurn(handle, [&] {
               Scene& to = handle.sceneToChange();
               if (first > to.objects.size() || transforms.shape(0) > to.objects.size() - first)
                 throw InputError("transforms: more than there are objects");
               for (std::size_t i = 0; i < transforms.shape(0); ++i)
                 to.objects[first + i].object_to_world = matrixOf(transforms.data() + 16 * i);
               if (to.source_lights > 0) addSourceLights(to);
             });
           })
      .def("transforms",
           [](SceneHandle& handle) {
             std::vector<double> rows;
             inTurn(handle, [&] {
               for (const Object& object : handle.scene().objects)
                 for (int row = 0; row < 4; ++row)
                   for (int column = 0; column < 4; ++column)
                     rows.push_back(object.object_to_world[column][row]);
             });
             const std::size_t count = rows.size() / 16;
             return arrayOf(std::move(rows), {count, 4, 4});
           })
      .def("object_names",
           [](SceneHandle& handle) {
             std::vector<std::string> names;
             inTurn(handle, [&] {
               for (const Object& object : handle.scene().objects) {
                 const std::string& of_mesh = handle.scene().meshes[object.mesh].name;
                 names.push_back(object.name.empty() ? of_mesh : object.name);
               }
             });
             return names;
           })
      .def("counts", [](SceneHandle& handle) {
        nb::dict counts;
        std::size_t meshes = 0, objects = 0, materials = 0, triangles = 0;
        inTurn(handle, [&] {
          const Scene& of = handle.scene();
          meshes = of.meshes.size();
          objects = of.objects.size();
          materials = of.materials.size();
          for (const Object& object : of.objects) triangles += of.meshes[object.mesh].triangles.size();
        });
        counts["meshes"] = meshes;
        counts["objects"] = objects;
        counts["materials"] = materials;
        counts["triangles"] = triangles;
        return counts;
      });
}

void bindSurroundings(nb::class_<SceneHandle>& scene) {
  scene
      .def("set_surroundings",
           [](SceneHandle& handle, const Vec3& background, const Vec3& ambient, bool lighting, int fog_mode,
              bool radial, const Vec3& density, double start, double end, const Vec3& color) {
             inTurn(handle, [&] {
               Scene& to = handle.sceneToChange();
               to.background = vec3Of(background);
               to.ambient = vec3Of(ambient);
               to.lighting = lighting;
               to.fog = {FogMode(fog_mode), radial, vec3Of(density), float(start), float(end), vec3Of(color)};
             });
           })
      .def("surroundings",
           [](SceneHandle& handle) {
             Scene copy;
             inTurn(handle, [&] {
               const Scene& of = handle.scene();
               copy.background = of.background;
               copy.ambient = of.ambient;
               copy.lighting = of.lighting;
               copy.fog = of.fog;
             });
             const Fog& fog = copy.fog;
             return nb::make_tuple(listOf(copy.background), listOf(copy.ambient), copy.lighting,
                                   int(fog.mode), fog.radial, listOf(fog.density), fog.start, fog.end,
                                   listOf(fog.color));
           })
      .def("set_cameras",
           [](SceneHandle& handle, const std::vector<Camera>& cameras) {
             inTurn(handle, [&] {
               Scene& scene = handle.sceneToChange();
               scene.cameras = cameras;
               // What moved the cameras that were there.
               scene.animation.cameras.clear();
               scene.animation.attached_cameras.clear();
             });
           })
      .def("cameras",
           [](SceneHandle& handle) { return inTurn(handle, [&] { return handle.scene().cameras; }); })
      .def("set_size",
           [](SceneHandle& handle, int width, int height) {
             inTurn(handle, [&] { handle.sceneToChange().size = glm::ivec2(width, height); });
           })
      .def("size",
           [](SceneHandle& handle) {
             const auto size = inTurn(handle, [&] { return handle.scene().size; });
             return size ? std::optional(std::array{size->x, size->y}) : std::nullopt;
           })
      .def("warnings",
           [](SceneHandle& handle) {
             std::vector<std::string> texts;
             inTurn(handle, [&] {
               for (const Warning& warning : handle.scene().warnings) texts.push_back(warning.text);
             });
             return texts;
           })
      .def("name", [](SceneHandle& handle) { return inTurn(handle, [&] { return handle.scene().name; }); });
}

}  // namespace

void bindScene(nb::module_& module) {
  nb::class_<Camera>(module, "Camera")
      .def_ro("name", &Camera::name)
      .def_prop_ro("camera_to_world",
                   [](const Camera& camera) { return arrayOfMatrix(camera.camera_to_world); })
      .def_ro("orthographic", &Camera::orthographic)
      .def_ro("fov_y", &Camera::fov_y)
      .def_ro("half_height", &Camera::half_height)
      .def_prop_ro("shift",
                   [](const Camera& camera) { return nb::make_tuple(camera.shift.x, camera.shift.y); })
      .def_ro("pixel_aspect", &Camera::pixel_aspect)
      .def_ro("near", &Camera::near)
      .def_ro("far", &Camera::far)
      .def_prop_ro("target",
                   [](const Camera& camera) {
                     return camera.target ? std::optional(listOf(*camera.target)) : std::nullopt;
                   })
      .def_prop_ro("up", [](const Camera& camera) { return listOf(camera.up); });
  module.def("camera", cameraOf, nb::arg("name"), nb::arg("camera_to_world"), nb::arg("orthographic"),
             nb::arg("fov_y"), nb::arg("half_height"), nb::arg("shift"), nb::arg("pixel_aspect"),
             nb::arg("near"), nb::arg("far"), nb::arg("target").none(), nb::arg("up"));
  module.def("look_at", [](const Vec3& eye, const Vec3& target, const Vec3& up) {
    return arrayOfMatrix(cameraToWorld(dvec3Of(eye), dvec3Of(target), dvec3Of(up)));
  });

  nb::class_<LightColumns>(module, "LightColumns");
  module.def("light_columns", columnsOf, nb::arg("kind"), nb::arg("count"), nb::arg("position").none(),
             nb::arg("direction").none(), nb::arg("color"), nb::arg("ambient").none(),
             nb::arg("specular").none(), nb::arg("attenuation"), nb::arg("range"), nb::arg("window"),
             nb::arg("falloff"), nb::arg("cutoff"), nb::arg("inner_cone"), nb::arg("exponent"),
             nb::arg("radius"), nb::arg("half_angle"), nb::arg("cast_shadows"), nb::arg("group"));
  nb::class_<NamedSource>(module, "Source");
  module.def("environment", environment);
  module.def("face", face);
  nb::class_<SceneHandle> scene(module, "Scene");
  scene.def(nb::init<>());
  bindLights(scene);
  bindParts(scene);
  bindSurroundings(scene);
  scene
      .def("copy",
           [](SceneHandle& handle) {
             return inTurn(handle, [&] { return std::make_unique<SceneHandle>(handle.scene()); });
           })
      .def("complete",
           [](SceneHandle& handle, bool says_light) {
             inTurn(handle, [&] {
               Scene& to = handle.sceneToBuild("scene");
               to.says_light = says_light;
               validateScene(to);
               addSourceLights(to);
               completeScene(to, false);
             });
           })
      .def("pose", [](SceneHandle& handle, double frame) {
        inTurn(handle, [&] { poseScene(handle.sceneToChange(), frame); });
      });
  module.def(
      "load",
      [](const std::string& path, double frame, bool missing_textures_warn, bool strict,
         const std::vector<std::string>& search, const std::string& variant, const std::string& animation,
         bool tangents, const std::vector<std::string>& changes, const std::string& environment) {
        const nb::gil_scoped_release unlocked;
        LoadSettings settings{.strict = strict,
                              .search = search,
                              .choice = {variant, animation},
                              .tangents = tangents,
                              .changes = changes,
                              .environment = environment};
        if (missing_textures_warn) settings.missing = MissingTextures::kWarn;
        return std::make_unique<SceneHandle>(loadScene(path, frame, settings));
      },
      nb::arg("path"), nb::arg("frame"), nb::arg("missing_textures_warn"), nb::arg("strict"),
      nb::arg("search"), nb::arg("variant"), nb::arg("animation"), nb::arg("tangents"), nb::arg("changes"),
      nb::arg("environment"));
}

}  // namespace luciole::python
