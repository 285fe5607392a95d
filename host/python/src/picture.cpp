// Pictures, and what is made of scenes: G-buffers, references, light maps.
#include <nanobind/stl/array.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <luciole/error.hpp>
#include <luciole/reference.hpp>
#include <luciole/render.hpp>
#include <map>
#include <memory>
#include <string>

#include "arrays.hpp"
#include "bindings.hpp"
#include "picture_handle.hpp"
#include "scene_handle.hpp"

namespace luciole::python {
namespace {

/// What Python asks for: see luciole/settings.py.
struct Request {
  SettingValues values = {};  ///< of the settings that were given, and initial ones
  bool shadows_given = false;
  int camera_index = 0;
  std::optional<Camera> camera = {};                     ///< instead of a camera of the scene's
  std::vector<std::string> surfaces = {}, screens = {};  ///< files
  nb::object progress = nb::none();
};

const std::string& valueOf(const Request& request, std::string_view name) {
  static const std::string none;
  const auto found = request.values.find(name);
  return found == request.values.end() ? none : found->second;
}

Model modelNamed(const std::string& name) {
  for (std::size_t i = 0; i < kNumberOfModels; ++i)
    if (name == modelName(Model(i))) return Model(i);
  throw InputError("model: '" + name + "' is no model, and no file *.clh");
}

/// The changes of a scene that a request means for its picture alone.
class ChangeForPicture {
 public:
  /// What may be refused comes first: then nothing has been changed.
  ChangeForPicture(const Request& request, Scene& scene)
      : scene_(scene), model_count_(scene.user_models.size()) {
    const std::string& model = valueOf(request, "model");
    model_ =
        std::string_view(model).ends_with(kShaderExtension) ? addUserModel(model, scene) : modelNamed(model);
    if (takesFacets(model_)) {
      materials_ = scene.materials;
      takeFacets(scene);
    }
    if (const std::string& count = valueOf(request, "light_count"); !count.empty()) {
      sources_ = countsOf(scene);
      setLightCounts(count, scene);
    }
    const std::string &shadows = valueOf(request, "shadows"), &casters = valueOf(request, "cast_shadows");
    const bool asked_for = request.shadows_given && shadows != "off";
    if (casters.empty() && !asked_for) return;
    for (const Light& light : scene.lights) marks_.push_back(light.shadow);
    castShadows(casters, asked_for, scene);
  }
  ~ChangeForPicture() {
    // All but those of sources, if they have become fewer or more.
    for (std::size_t i = 0; i < std::min(marks_.size(), scene_.lights.size()); ++i)
      scene_.lights[i].shadow = marks_[i];
    if (sources_) takeBackCounts();
    if (materials_) scene_.materials = std::move(*materials_);
    scene_.user_models.resize(model_count_);
  }
  ChangeForPicture(const ChangeForPicture&) = delete;
  ChangeForPicture& operator=(const ChangeForPicture&) = delete;

  Model model() const { return model_; }

 private:
  /// How many lights take the place of each source and of what glows.
  static std::vector<std::uint32_t> countsOf(const Scene& scene) {
    std::vector<std::uint32_t> counts;
    for (const LightSource& source : scene.sources) counts.push_back(source.count);
    for (const Object& object : scene.objects) counts.push_back(object.emits);
    for (const Material& material : scene.materials) counts.push_back(material.emits);
    return counts;
  }
  void takeBackCounts() {
    auto next = sources_->begin();
    for (LightSource& source : scene_.sources) source.count = *next++;
    for (Object& object : scene_.objects) object.emits = *next++;
    for (Material& material : scene_.materials) material.emits = *next++;
    addSourceLights(scene_);
  }

  Scene& scene_;
  std::size_t model_count_;
  Model model_ = Model::kPhong;
  std::optional<std::vector<Material>> materials_;
  std::vector<bool> marks_;
  std::optional<std::vector<std::uint32_t>> sources_;  ///< countsOf() before
};

/// Ends a picture on Ctrl-C, which Python's main thread is told of, and tells how far it is. It is called
/// without Python's lock: in the thread that asked, or for a reference in any.
std::function<void(int, int)> reporterOf(const Request& request) {
  return [progress = request.progress.ptr()](int done, int all) {
    const nb::gil_scoped_acquire locked;
    if (PyErr_CheckSignals() != 0) throw nb::python_error();
    if (progress == Py_None) return;
    in_callback = true;
    try {
      nb::borrow<nb::object>(progress)(done, all);
    } catch (...) {
      in_callback = false;
      throw;
    }
    in_callback = false;
  };
}

/// A picture that is long enough that Ctrl-C should end it in between is made in bands. Their height must be
/// a multiple of 64 for clusters of lights to be the same.
constexpr int kBandHeight = 128;
constexpr double kLongPicture = 8e6;

int bandHeight(const RenderSettings& settings, std::size_t lights) {
  const double work =
      double(settings.size.x) * settings.size.y * settings.samples * (1 + double(lights) / 1000);
  return work < kLongPicture || settings.wants(Aov::kListLength) ? 0 : kBandHeight;
}

RenderSettings settingsOf(const Request& request, const Scene& scene, Model model) {
  RenderSettings settings;
  if (scene.size) settings.size = *scene.size;
  applySettings(request.values, settings);
  settings.shade.model = model;
  if (request.camera)
    settings.camera = *request.camera;
  else if (std::size_t(request.camera_index) < scene.cameras.size())
    settings.camera = scene.cameras[std::size_t(request.camera_index)];
  else
    throw InputError("camera: the scene has none, expected camera=luciole.Camera(…) or scene.cameras = […]");
  for (const std::string& path : request.surfaces)
    settings.surfaces.push_back(readShader(path, ShaderKind::kSurface));
  for (const std::string& path : request.screens)
    settings.screens.push_back(readShader(path, ShaderKind::kScreen));
  settings.on_pass = reporterOf(request);
  return settings;
}

/// Calls make(scene, settings) in a turn, with what the request changes of the scene.
template <class Make>
auto makeOf(SceneHandle& handle, const Request& request, const Make& make) {
  const nb::gil_scoped_release unlocked;
  const auto turn = handle.turn();
  const ChangeForPicture change(request, handle.scene());
  if (valueOf(request, "light_count") == "auto")
    throw InputError("light_count: only render chooses, expected a number");
  return make(handle.scene(), settingsOf(request, handle.scene(), change.model()));
}

std::unique_ptr<PictureHandle> render(SceneHandle& handle, const std::shared_ptr<Device>& device,
                                      const Request& request) {
  const nb::gil_scoped_release unlocked;
  const auto turn = handle.turn();
  const auto start = std::chrono::steady_clock::now();
  auto picture = std::make_unique<PictureHandle>();
  handle.withRenderer(device, [&](Renderer& renderer) {
    Scene& scene = renderer.scene();
    const ChangeForPicture change(request, scene);
    RenderSettings settings = settingsOf(request, scene, change.model());
    settings.band_height = bandHeight(settings, scene.lights.size());
    Stats& stats = picture->stats;
    if (valueOf(request, "light_count") == "auto") renderer.chooseLightCounts(settings, stats);
    if (valueOf(request, "exposure") == "auto") {
      stats.measured_exposure = renderer.measureExposure(settings, stats);
      settings.exposure = float(*stats.measured_exposure);
    }
    const int rows = settings.crop ? settings.crop->height : settings.size.y;
    renderer.render(
        settings, [&](const Image& next) { picture->append(next, rows); }, stats);
  });
  picture->tookSince(start);
  return picture;
}

std::unique_ptr<PictureHandle> shadeGBuffer(SceneHandle& handle, const std::shared_ptr<Device>& device,
                                            const GBuffer& gbuffer, Request request) {
  if (!request.camera) request.camera = gbuffer.camera;
  return makeOf(handle, request, [&](const Scene& scene, const RenderSettings& settings) {
    const auto start = std::chrono::steady_clock::now();
    auto picture = std::make_unique<PictureHandle>(shade(*device, scene, gbuffer, settings));
    picture->tookSince(start);
    return picture;
  });
}

std::unique_ptr<PictureHandle> bake(SceneHandle& handle, const std::shared_ptr<Device>& device,
                                    std::uint32_t object, const std::optional<std::array<double, 3>>& eye,
                                    bool irradiance, Request request) {
  request.camera = Camera{};  // it isn't asked for
  return makeOf(handle, request, [&](const Scene& scene, const RenderSettings& settings) {
    const auto start = std::chrono::steady_clock::now();
    BakeSettings light{.irradiance = irradiance};
    if (eye) light.eye = {(*eye)[0], (*eye)[1], (*eye)[2]};
    auto picture = std::make_unique<PictureHandle>(bakeLight(*device, scene, object, light, settings));
    picture->tookSince(start);
    return picture;
  });
}

nb::ndarray<nb::numpy, double> reference(SceneHandle& handle,
                                         const In<std::int32_t, nb::shape<-1, 2>>& pixels,
                                         const Request& request) {
  std::vector<double> colors;
  makeOf(handle, request, [&](const Scene& scene, const RenderSettings& settings) {
    std::vector<glm::ivec2> places;
    for (std::size_t i = 0; i < pixels.shape(0); ++i)
      places.emplace_back(pixels.data()[2 * i], pixels.data()[2 * i + 1]);
    for (const glm::dvec3& color : referencePicture(scene, settings, places))
      colors.insert(colors.end(), {color.x, color.y, color.z});
  });
  const std::size_t count = colors.size() / 3;
  return arrayOf(std::move(colors), {count, 3});
}

Request requestOf(const std::map<std::string, std::string>& values, bool shadows_given, int camera_index,
                  const std::optional<Camera>& camera, const std::vector<std::string>& surfaces,
                  const std::vector<std::string>& screens, const nb::object& progress) {
  Request request{.shadows_given = shadows_given,
                  .camera_index = camera_index,
                  .camera = camera,
                  .surfaces = surfaces,
                  .screens = screens,
                  .progress = progress};
  request.values.insert(values.begin(), values.end());
  return request;
}

}  // namespace

void bindPictures(nb::module_& module) {
  nb::list models;
  for (std::size_t i = 0; i < kNumberOfModels; ++i) models.append(modelName(Model(i)));
  module.attr("MODELS") = nb::tuple(models);
  nb::class_<Request>(module, "Request");
  module.def("request", requestOf, nb::arg("values"), nb::arg("shadows_given"), nb::arg("camera_index"),
             nb::arg("camera").none(), nb::arg("surfaces"), nb::arg("screens"), nb::arg("progress").none());
  nb::class_<Device>(module, "Device").def_prop_ro("name", [](const Device& device) {
    return device.description().name;
  });
  module.def("open_device", [](const std::string& selector) {
    const nb::gil_scoped_release unlocked;
    return std::make_shared<Device>(Device::open(selector));
  });
  module.def("keep", [](SceneHandle& handle, const std::shared_ptr<Device>& device) {
    const nb::gil_scoped_release unlocked;
    const auto turn = handle.turn();
    handle.keep(device);
  });
  module.def("render", render);
  module.def("shade", shadeGBuffer);
  module.def("bake", bake, nb::arg("scene"), nb::arg("device"), nb::arg("object"), nb::arg("eye").none(),
             nb::arg("irradiance"), nb::arg("request"));
  module.def("reference", reference);
  module.def("window", [](SceneHandle& handle, const Request& request) {
    return makeOf(handle, request, [](const Scene&, const RenderSettings& settings) {
      return settings.crop ? std::array{settings.crop->width, settings.crop->height}
                           : std::array{settings.size.x, settings.size.y};
    });
  });
  module.def("draw_gbuffer",
             [](SceneHandle& handle, const std::shared_ptr<Device>& device, const Request& request) {
               return makeOf(handle, request, [&](const Scene& scene, const RenderSettings& settings) {
                 return std::make_unique<GBuffer>(drawGBuffer(*device, scene, settings));
               });
             });
}

}  // namespace luciole::python
