#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>
#include <luciole/device.hpp>

namespace nb = nanobind;

namespace {

nb::typed<nb::list, nb::typed<nb::dict, nb::str, nb::object>> devices() {
  nb::list all;
  for (const luciole::DeviceDescription& device : luciole::listDevices()) {
    nb::dict one;
    one["platform"] = device.platform;
    one["name"] = device.name;
    one["version"] = device.version;
    one["lanes"] = device.lanes;
    one["compute_units"] = device.compute_units;
    all.append(one);
  }
  return nb::typed<nb::list, nb::typed<nb::dict, nb::str, nb::object>>(all);
}

}  // namespace

NB_MODULE(_luciole, m) { m.def("devices", &devices); }
