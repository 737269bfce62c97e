#pragma once

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

/// Functions that the sources of the Python module share; pybind11 is in no other header of ours.
namespace haptrial::python {

namespace py = pybind11;

/// Numbers from Python, contiguous: an array of another type or layout is copied.
using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// @throws py::value_error "NAME has 2 dimensions; allowed: 1" for what is no list of numbers
std::span<const double> list_of(const Numbers& numbers, const char* name);
/// The same of several. They stay valid as long as `numbers`.
std::vector<std::span<const double>> lists_of(const std::vector<Numbers>& numbers,
                                              const char* name);

/// An array that takes over the memory of `values` without a copy.
/// @param shape  its product of T's items must lie in `values`
template <class T, class Value>
py::array_t<T> array_of(std::vector<Value>&& values, std::vector<py::ssize_t> shape) {
  static_assert(sizeof(Value) % sizeof(T) == 0);
  auto* held = new std::vector<Value>(std::move(values));
  const py::capsule owner(held, [](void* p) { delete static_cast<std::vector<Value>*>(p); });
  return py::array_t<T>(std::move(shape), reinterpret_cast<const T*>(held->data()), owner);
}
template <class T>
py::array_t<T> array_of(std::vector<T>&& values) {
  const auto count = static_cast<py::ssize_t>(values.size());
  return array_of<T, T>(std::move(values), {count});
}

/// Each adds its part to the module.
void bind_session(py::module_& module);
void bind_scores(py::module_& module);
void bind_psychometric(py::module_& module);
void bind_procedures(py::module_& module);
void bind_touch(py::module_& module);

}  // namespace haptrial::python
