#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <luciole/array_memory.hpp>
#include <vector>

namespace luciole::python {

namespace nb = nanobind;

/// An array that is only read: of this type, row after row without gaps. Python's half of the package makes
/// it so.
template <class T, class... Config>
using In = nb::ndarray<const T, nb::c_contig, nb::device::cpu, Config...>;

/// A new array for Python, which owns it. `make` may fill it without Python's lock.
template <class T>
nb::ndarray<nb::numpy, T> arrayOf(std::vector<T>&& values, std::initializer_list<std::size_t> shape) {
  auto* const kept = new std::vector<T>(std::move(values));
  const nb::capsule owner(kept, [](void* p) noexcept { delete static_cast<std::vector<T>*>(p); });
  return nb::ndarray<nb::numpy, T>(kept->data(), shape, owner);
}

/// A number for each of many rows, or one for all: float32 or float64.
struct Column {
  const float* floats = nullptr;
  const double* doubles = nullptr;
  std::size_t stride = 0;  ///< from row to row; 0: all rows are the first

  /// Component c of row i.
  double at(std::size_t i, std::size_t c = 0) const {
    const std::size_t place = i * stride + c;
    return floats ? double(floats[place]) : doubles[place];
  }
  glm::dvec3 vec3(std::size_t i) const { return {at(i), at(i, 1), at(i, 2)}; }
};

/// Rows of float32 or float64 numbers, `width` of each: (N, width) or (1, width).
using InRows = nb::ndarray<nb::ro, nb::ndim<2>, nb::c_contig, nb::device::cpu>;

/// Throws nb::value_error unless it is so.
inline Column columnOf(const InRows& rows, std::size_t width, std::size_t count) {
  Column column;
  if (rows.shape(1) != width || (rows.shape(0) != count && rows.shape(0) != 1))
    throw nb::value_error("_luciole: an array of another shape");
  if (rows.dtype() == nb::dtype<float>())
    column.floats = static_cast<const float*>(rows.data());
  else if (rows.dtype() == nb::dtype<double>())
    column.doubles = static_cast<const double*>(rows.data());
  else
    throw nb::value_error("_luciole: an array of another type");
  column.stride = rows.shape(0) == 1 ? 0 : width;
  return column;
}

/// Vectors of floats as an array of GLM's.
template <class Vector>
std::vector<Vector> vectorsOf(const float* numbers, std::size_t count) {
  static_assert(sizeof(Vector) == sizeof(float) * Vector::length());
  const auto* const first = reinterpret_cast<const Vector*>(numbers);
  return {first, first + count};
}

/// A 4×4 matrix, of rows as NumPy has them.
inline glm::dmat4 matrixOf(const double* rows) {
  glm::dmat4 matrix;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) matrix[column][row] = rows[4 * row + column];
  return matrix;
}

}  // namespace luciole::python
