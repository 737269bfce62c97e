#include <limits>
#include <optional>
#include <string>

#include "analysis/psychometric/fit/bootstrap_fit.h"
#include "analysis/psychometric/fit/stated_fit.h"
#include "analysis/python/arrays.h"
#include "core/base/error.h"
#include "core/psychometric/function/psychometric_function.h"

namespace haptrial::python {
namespace {

using analysis::LikelihoodOptions;
using analysis::Task;
using psychometric::Axis;
using psychometric::PsychometricFunction;
using psychometric::PsychometricParameters;
using psychometric::Scale;

Scale scale_named(const std::string& name) {
  if (name == "linear") {
    return Scale::kLinear;
  }
  if (name == "log10") {
    return Scale::kLog10;
  }
  if (name == "ln") {
    return Scale::kNaturalLog;
  }
  if (name == "decibel") {
    return Scale::kDecibel;
  }
  throw InputError("scale is '" + name + "'; allowed: linear, log10, ln, decibel");
}

/// @param scale  empty: as the function's name says, natural logarithms or none
PsychometricParameters function_shape(const std::string& function, const std::string& scale,
                                      double origin, double share, double tail) {
  PsychometricParameters p = psychometric::parameters_named(function);
  if (!scale.empty()) {
    p.axis.scale = scale_named(scale);
  }
  p.axis.origin = origin;
  p.share = share;
  p.tail = tail;
  return p;
}

std::vector<analysis::TrialBlock> blocks_of(const Numbers& levels, const std::vector<int>& correct,
                                            const std::vector<int>& total) {
  const std::span<const double> list = list_of(levels, "levels");
  if (list.size() != correct.size() || list.size() != total.size()) {
    throw InputError("levels, correct and total have " + std::to_string(list.size()) + ", " +
                     std::to_string(correct.size()) + " and " + std::to_string(total.size()) +
                     " items; allowed: as many of each");
  }
  std::vector<analysis::TrialBlock> blocks;
  for (std::size_t i = 0; i < list.size(); ++i) {
    blocks.push_back({analysis::nine_digits(list[i]), correct[i], total[i]});
  }
  return analysis::pooled(blocks);
}

py::dict described(const PsychometricParameters& p) {
  py::dict values;
  values["threshold"] = p.threshold;
  values["width"] = p.width;
  values["guess"] = p.guess;
  values["lapse"] = p.lapse;
  values["share"] = p.share;
  values["x_unit"] = p.axis.x_unit();
  return values;
}

/// Interval from low to high; an open side is `lowest`, or infinite; NaN if the fit has no
/// interval.
template <class Level>
py::tuple interval(const analysis::StatedFit& fit, const analysis::ProfileInterval& from,
                   Level level, double lowest) {
  if (!fit.no_interval.empty()) {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    return py::make_tuple(kNone, kNone);
  }
  return py::make_tuple(
      from.low_open ? lowest : level(from.low),
      from.high_open ? std::numeric_limits<double>::infinity() : level(from.high));
}

/// A fit's numbers, and the function that it found; levels in the unit of the stimulus.
/// @param how  draws that judge the scatter of answers to listed levels; a count of 0: chi-square
/// does
py::dict fit(const std::vector<analysis::TrialBlock>& blocks, const LikelihoodOptions& options,
             bool adaptive, const analysis::FitBootstrap& how) {
  std::optional<PsychometricFunction> function;
  analysis::StatedFit found;
  analysis::PsychometricDeviance deviance;
  double deviance_p = std::numeric_limits<double>::quiet_NaN();
  {
    const py::gil_scoped_release release;
    if (!adaptive && how.resampling.count > 0) {
      deviance_p = analysis::bootstrap_fit(blocks, options, {}, how).deviance_p;
    }
    found = analysis::stated_fit(blocks, options, adaptive, deviance_p);
    function = analysis::fitted_function(options.function, found.estimate);
    deviance = analysis::deviance_of(
        analysis::fitted_function(options.function, found.likeliest.parameters), blocks);
  }
  const auto on_axis = [&](double x) { return options.function.axis.level(x); };
  const auto same = [](double value) { return value; };
  const double lowest = options.function.axis.scale == Scale::kLinear
                            ? -std::numeric_limits<double>::infinity()
                            : options.function.axis.origin;
  py::dict result;
  result["function"] = *function;
  result["threshold"] = on_axis(found.estimate.threshold);
  result["threshold_interval"] = interval(found, found.threshold, on_axis, lowest);
  result["width"] = found.estimate.width;
  result["width_interval"] = interval(found, found.width, same, 0.0);
  result["width_unit"] = options.function.axis.x_unit();
  result["lapse"] = found.estimate.lapse;
  result["guess"] = found.estimate.guess;
  result["log_likelihood"] = found.likeliest.log_likelihood;
  result["deviance"] = deviance.deviance;
  result["deviance_p"] = found.deviance_p;
  result["undetermined"] = !found.told;
  result["no_interval"] = found.no_interval;
  return result;
}

void bind_function(py::module_& module) {
  py::class_<PsychometricFunction>(
      module, "PsychometricFunction",
      "Probability of answer 1 at a level, as haptrial.psychometric_function() makes it.")
      .def(
          "__call__",
          [](const PsychometricFunction& function, const py::array_t<double>& levels) {
            return py::vectorize([&function](double level) { return function(level); })(levels);
          },
          py::arg("level"), "Probability [1] at a level or an array of levels [unit of the level].")
      .def(
          "slope",
          [](const PsychometricFunction& function, const py::array_t<double>& levels) {
            return py::vectorize([&function](double level) { return function.derivative(level); })(
                levels);
          },
          py::arg("level"), "d probability / d level [1/unit of the level].")
      .def("level_for", &PsychometricFunction::level_for, py::arg("probability"),
           "The level at which the probability is this [unit of the level].")
      .def("level_for_share", &PsychometricFunction::level_for_share, py::arg("share"),
           "The level at which the function, free of guesses and lapses, is this.")
      .def_property_readonly(
          "parameters",
          [](const PsychometricFunction& function) { return described(function.parameters()); },
          "Threshold [unit of the level], width [x_unit], guess, lapse, share [1].");
}

}  // namespace

void bind_psychometric(py::module_& module) {
  bind_function(module);
  module.def(
      "psychometric_function",
      [](const std::string& function, double threshold, double width, double guess, double lapse,
         const std::string& scale, double origin, double share, double tail) {
        PsychometricParameters p = function_shape(function, scale, origin, share, tail);
        p.threshold = threshold;
        p.width = width;
        p.guess = guess;
        p.lapse = lapse;
        return PsychometricFunction(p);
      },
      py::arg("function"), py::arg("threshold"), py::arg("width"), py::arg("guess"),
      py::arg("lapse"), py::arg("scale"), py::arg("origin"), py::arg("share"), py::arg("tail"));
  module.def(
      "fit",
      [](const Numbers& levels, const std::vector<int>& correct, const std::vector<int>& total,
         const std::string& function, std::optional<double> guess, std::pair<double, double> lapse,
         const std::string& scale, double origin, double share, double tail, bool adaptive,
         const std::optional<std::pair<double, double>>& presentable, std::size_t resamples,
         const std::string& participant, const std::string& condition) {
        LikelihoodOptions options;
        options.function = function_shape(function, scale, origin, share, tail);
        options.function.guess = guess.value_or(0.0);
        options.lapse = {lapse.first, lapse.second};
        options.guess.high = lapse.second;
        options.task = guess && *guess > 0.0 ? Task::kForcedChoice : Task::kYesNo;
        if (guess && *guess == 0.0) {
          options.guess = {0.0, 0.0};
        }
        if (presentable) {
          const Axis& axis = options.function.axis;
          options.presentable = {axis.at(presentable->first), axis.at(presentable->second)};
        }
        analysis::FitBootstrap how = analysis::bootstrap_of(participant, condition);
        how.resampling.count = resamples;
        return fit(blocks_of(levels, correct, total), options, adaptive, how);
      },
      py::arg("levels"), py::arg("correct"), py::arg("total"), py::arg("function"),
      py::arg("guess"), py::arg("lapse"), py::arg("scale"), py::arg("origin"), py::arg("share"),
      py::arg("tail"), py::arg("adaptive"), py::arg("presentable"), py::arg("resamples"),
      py::arg("participant"), py::arg("condition"));
}

}  // namespace haptrial::python
