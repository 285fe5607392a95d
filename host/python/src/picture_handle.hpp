#pragma once

#include <luciole/render.hpp>

namespace luciole::python {

/// A picture whose pixels Python's arrays show.
struct PictureHandle {
  Picture picture = {};
  double ended = 0;  ///< see statsJson()

  void took(double milliseconds) { ended = picture.stats.began + milliseconds; }
};

}  // namespace luciole::python
