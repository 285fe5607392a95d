// The compiled half of Luciole's Python package. It takes what the Python half has checked: arrays of the
// right type, shape and layout. Its functions hold Python's lock only where they touch Python.
#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <luciole/device.hpp>
#include <luciole/error.hpp>
#include <luciole/settings.hpp>

#include "bindings.hpp"

namespace nb = nanobind;

namespace {

nb::list devices() {
  std::vector<luciole::DeviceDescription> found;
  {
    const nb::gil_scoped_release unlocked;
    found = luciole::listDevices();
  }
  nb::list list;
  for (const luciole::DeviceDescription& one : found) {
    nb::dict device;
    device["platform"] = one.platform;
    device["name"] = one.name;
    device["version"] = one.version;
    device["lanes"] = one.lanes;
    device["compute_units"] = one.compute_units;
    list.append(device);
  }
  return list;
}

/// The rows of the library's table that Python's keywords come from.
nb::list settings() {
  nb::list rows;
  for (const luciole::NamedSetting& setting : luciole::namedSettings()) {
    nb::dict row;
    row["name"] = setting.name;
    row["help"] = setting.help;
    row["initial"] = setting.initial;
    row["choices"] = setting.choices;
    row["is_flag"] = setting.is_flag;
    row["is_list"] = setting.is_list;
    row["of_file"] = setting.set_file != nullptr;
    rows.append(row);
  }
  return rows;
}

}  // namespace

NB_MODULE(_luciole, module) {
  nb::register_exception_translator(
      [](const std::exception_ptr& thrown, void* payload) {
        (void)payload;
        const auto raise = [](const char* kind, const char* what) {
          const nb::object error = nb::module_::import_("luciole._errors").attr(kind);
          PyErr_SetString(error.ptr(), what);
        };
        try {
          std::rethrow_exception(thrown);
        } catch (const luciole::InputError& error) {
          raise("InputError", error.what());
        } catch (const luciole::MachineError& error) {
          raise("MachineError", error.what());
        } catch (const std::bad_alloc&) {
          raise("MachineError", "out of memory");
        }
      },
      nullptr);
  module.def("devices", devices);
  module.def("settings", settings);
  luciole::python::bindScene(module);
  luciole::python::bindGBuffers(module);
  luciole::python::bindPictures(module);
  luciole::python::bindImages(module);
}
