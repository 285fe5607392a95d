#include <luciole/device.hpp>
#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>

namespace nb = nanobind;

namespace {

nb::list devices() {
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
  return all;
}

}  // namespace

NB_MODULE(_luciole, m) { m.def("devices", &devices); }
