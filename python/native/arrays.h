#pragma once

#include <pybind11/numpy.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "base/core/types.h"

namespace shaken::python {

namespace py = pybind11;

using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;

using Integers = py::array_t<std::int32_t, py::array::c_style | py::array::forcecast>;

/// (n, 3)
inline Doubles array_of(const std::vector<Vec3>& vectors) {
  Doubles array({static_cast<py::ssize_t>(vectors.size()), py::ssize_t{3}});
  auto values = array.mutable_unchecked<2>();
  for (std::size_t i = 0; i < vectors.size(); ++i) {
    for (Eigen::Index k = 0; k < 3; ++k) values(static_cast<py::ssize_t>(i), k) = vectors[i][k];
  }
  return array;
}

/// The rows of an array (n, 3); fails with what it is called where it has another shape.
inline std::vector<Vec3> vectors_of(const Doubles& array, const std::string& name) {
  if (array.ndim() != 2 || array.shape(1) != 3) throw py::value_error(name + " must have the shape (n, 3)");
  std::vector<Vec3> vectors(static_cast<std::size_t>(array.shape(0)));
  const auto values = array.unchecked<2>();
  for (std::size_t i = 0; i < vectors.size(); ++i) {
    const auto row = static_cast<py::ssize_t>(i);
    vectors[i] = {values(row, 0), values(row, 1), values(row, 2)};
  }
  return vectors;
}

}  // namespace shaken::python
