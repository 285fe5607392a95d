#pragma once

#include <nanobind/nanobind.h>

namespace luciole::python {

// Each adds its part to the module.
void bindScene(nanobind::module_& module);
void bindPictures(nanobind::module_& module);
void bindGBuffers(nanobind::module_& module);
void bindImages(nanobind::module_& module);

}  // namespace luciole::python
