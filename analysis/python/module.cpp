#include <string>

#include "analysis/python/arrays.h"
#include "core/base/error.h"

namespace haptrial::python {

std::span<const double> list_of(const Numbers& numbers, const char* name) {
  if (numbers.ndim() != 1) {
    throw py::value_error(std::string(name) + " has " + std::to_string(numbers.ndim()) +
                          " dimensions; allowed: 1");
  }
  return {numbers.data(), static_cast<std::size_t>(numbers.size())};
}

std::vector<std::span<const double>> lists_of(const std::vector<Numbers>& numbers,
                                              const char* name) {
  std::vector<std::span<const double>> lists;
  for (const Numbers& each : numbers) {
    lists.push_back(list_of(each, name));
  }
  return lists;
}

}  // namespace haptrial::python

PYBIND11_MODULE(_haptrial, module) {
  namespace py = haptrial::python::py;
  module.doc() = "The C++ side of the package haptrial, which checks and explains what goes in.";
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      std::rethrow_exception(thrown);
    } catch (const haptrial::InputError& error) {
      PyErr_SetString(PyExc_ValueError, error.what());
    }
  });
  haptrial::python::bind_session(module);
  haptrial::python::bind_scores(module);
  haptrial::python::bind_psychometric(module);
  haptrial::python::bind_procedures(module);
  haptrial::python::bind_touch(module);
}
