#include <chrono>
#include <string>

#include "analysis/alignment/alignment.h"
#include "analysis/force_training/score/score.h"
#include "analysis/force_training/score/scores_csv.h"
#include "analysis/force_training/study/session_recalls.h"
#include "analysis/python/arrays.h"
#include "core/base/definition/table.h"
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/record/read/session_reader.h"

namespace haptrial::python {
namespace {

using analysis::Alignment;
using analysis::AlignmentOptions;
using analysis::ScoreParameters;
using Lists = std::vector<std::span<const double>>;

/// Results of a batch of alignments; paths go to Python without a copy, when they are asked for.
class Alignments {
 public:
  Alignments(std::vector<Alignment> found, double seconds)
      : found_(std::move(found)), seconds_(seconds) {}

  std::size_t count() const { return found_.size(); }
  double seconds() const { return seconds_; }
  py::array_t<double> costs() const { return each(&Alignment::cost); }
  py::array_t<double> weights() const { return each(&Alignment::weight); }
  /// (pairs x 2) indices, in memory of `self`.
  py::array_t<std::uint32_t> path(std::size_t i, const py::object& self) const {
    static_assert(sizeof(analysis::PathPoint) == 2 * sizeof(std::uint32_t));
    const auto& path = found_.at(i).path;
    const std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(path.size()), 2};
    return py::array_t<std::uint32_t>(shape, reinterpret_cast<const std::uint32_t*>(path.data()),
                                      self);
  }

 private:
  py::array_t<double> each(double Alignment::*member) const {
    std::vector<double> values;
    for (const Alignment& one : found_) {
      values.push_back(one.*member);
    }
    return array_of(std::move(values));
  }

  std::vector<Alignment> found_;
  double seconds_;
};

std::vector<std::vector<double>> slopes_of(const Lists& curves, double rate) {
  std::vector<std::vector<double>> slopes;
  for (const auto& curve : curves) {
    const double steps = static_cast<double>(curve.size()) - 1.0;
    if (curve.size() < 2 || !(rate > 0.0)) {
      throw InputError(curve.size() < 2 ? "a curve has fewer than two samples; allowed: 2 or more"
                                        : "rate is not above 0; allowed: above 0 [Hz]");
    }
    slopes.push_back(analysis::slope(curve, {steps / rate, curve.size()}));
  }
  return slopes;
}

Alignments align(const std::vector<Numbers>& references, const std::vector<Numbers>& curves,
                 double rate, const AlignmentOptions& options, int threads) {
  const Lists targets = lists_of(references, "a reference");
  const Lists applied = lists_of(curves, "a curve");
  if (targets.size() != 1 && targets.size() != applied.size()) {
    throw InputError("there are " + std::to_string(targets.size()) + " references for " +
                     std::to_string(applied.size()) + " curves; allowed: one, or one for each");
  }
  if (const std::string problem = problem_of(options); !problem.empty()) {
    throw InputError(problem);
  }
  const py::gil_scoped_release release;
  const auto start = std::chrono::steady_clock::now();
  const auto target_slopes = slopes_of(targets, rate);
  const auto applied_slopes = slopes_of(applied, rate);
  std::vector<analysis::AlignmentPair> pairs;
  for (std::size_t i = 0; i < applied.size(); ++i) {
    const std::size_t t = targets.size() == 1 ? 0 : i;
    pairs.push_back({{targets[t], target_slopes[t]}, {applied[i], applied_slopes[i]}});
  }
  auto found = analysis::align_batch(pairs, options, threads_or_all(threads));
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  return {std::move(found), took.count()};
}

AlignmentOptions options_of(double force_weight, double slope_weight, double penalty, double power,
                            const std::string& pattern, std::optional<std::size_t> window,
                            bool open_begin, bool open_end) {
  const auto named = analysis::pattern_of(pattern);
  if (!named) {
    std::string names;
    for (const std::string& name : analysis::pattern_names()) {
      names += (names.empty() ? "" : ", ") + name;
    }
    throw InputError("step_pattern is '" + pattern + "'; allowed: " + names);
  }
  return {force_weight, slope_weight, penalty, power, *named, window, open_begin, open_end};
}

/// The scoring that a definition states; `text` has at least its [analysis] and [guidance].
ScoreParameters scoring_of(const std::string& text, const std::string& name) {
  Table root = Table::parse(text, name);
  Table table = root.table("analysis");
  const ScoreParameters parameters = analysis::read_scoring(root, table);
  root.check();
  return parameters;
}

/// The keys of [analysis] with the values that are meant where nobody states others.
py::dict score_defaults() {
  const ScoreParameters p;
  py::dict keys;
  keys["samples"] = p.samples;
  keys["filter_width"] = p.filter_width;
  keys["force_weight"] = p.alignment.force_weight;
  keys["slope_weight"] = p.alignment.slope_weight;
  keys["power"] = p.alignment.power;
  keys["penalty"] = p.alignment.penalty;
  keys["cost_share"] = p.cost_share;
  keys["force_share"] = p.force_share;
  keys["slope_share"] = p.slope_share;
  return keys;
}

/// (recalls x 5): score, alignment_cost, rms_force, rms_slope, rms_unaligned.
py::array_t<double> scores(const std::vector<Numbers>& targets, const std::vector<Numbers>& applied,
                           double rate, const std::string& scoring, int threads) {
  const Lists target_lists = lists_of(targets, "a target");
  const Lists applied_lists = lists_of(applied, "a curve");
  if (target_lists.size() != 1 && target_lists.size() != applied_lists.size()) {
    throw InputError("there are " + std::to_string(target_lists.size()) + " targets for " +
                     std::to_string(applied_lists.size()) +
                     " curves; allowed: one, or one for each");
  }
  constexpr py::ssize_t kNumbers = 5;
  static_assert(sizeof(analysis::RecallScore) == kNumbers * sizeof(double));
  std::vector<analysis::RecallScore> found;
  {
    const py::gil_scoped_release release;
    const ScoreParameters parameters = scoring_of(scoring, "parameters");
    std::vector<analysis::ForceCurve> curves;
    for (const Lists* lists : {&target_lists, &applied_lists}) {
      for (const auto& list : *lists) {
        curves.push_back({rate, {list.begin(), list.end()}});
      }
    }
    std::vector<analysis::RecallPair> pairs;
    for (std::size_t i = 0; i < applied_lists.size(); ++i) {
      pairs.push_back(
          {&curves[target_lists.size() == 1 ? 0 : i], &curves[target_lists.size() + i]});
    }
    found = analysis::score_recalls(pairs, parameters, threads_or_all(threads));
  }
  const auto rows = static_cast<py::ssize_t>(found.size());
  return array_of<double>(std::move(found), {rows, kNumbers});
}

/// The scored test passes of session files as scores.csv has them.
std::string study_scores(const std::vector<std::string>& paths, int threads) {
  const py::gil_scoped_release release;
  std::vector<std::vector<analysis::ScoredPass>> scored(paths.size());
  parallel_for(paths.size(), threads_or_all(threads), [&](std::size_t i) {
    const record::SessionReader reader(paths[i]);
    const ScoreParameters parameters =
        scoring_of(reader.info().definition, reader.info().definition_name);
    scored[i] = analysis::session_recalls(reader, parameters, 1).scored;
  });
  std::vector<analysis::TrialScore> all;
  for (const auto& session : scored) {
    for (const analysis::ScoredPass& pass : session) {
      all.push_back(pass.score);
    }
  }
  return analysis::scores_csv(all);
}

void bind_alignments(py::module_& module) {
  py::class_<Alignments>(module, "Alignments",
                         "What haptrial.align() found; as many items as curves.")
      .def("__len__", &Alignments::count)
      .def_property_readonly("seconds", &Alignments::seconds,
                             "Time that slopes and alignments took in C++ [s].")
      .def_property_readonly("costs", &Alignments::costs,
                             "(curves) sum of weighted errors and penalties along each path [1].")
      .def_property_readonly("weights", &Alignments::weights,
                             "(curves) sum of the weights of the errors on each path [1].")
      .def(
          "path",
          [](const py::object& self, std::size_t i) {
            const auto& alignments = self.cast<const Alignments&>();
            if (i >= alignments.count()) {
              throw py::index_error("no curve " + std::to_string(i) + "; there are " +
                                    std::to_string(alignments.count()));
            }
            return alignments.path(i, self);
          },
          py::arg("i"),
          "(pairs x 2) indices of the pairs of curve i: into the reference, into the curve.");
}

}  // namespace

void bind_scores(py::module_& module) {
  bind_alignments(module);
  module.def(
      "align",
      [](const std::vector<Numbers>& references, const std::vector<Numbers>& curves, double rate,
         double force_weight, double slope_weight, double penalty, double power,
         const std::string& pattern, std::optional<std::size_t> window, bool open_begin,
         bool open_end, int threads) {
        return align(references, curves, rate,
                     options_of(force_weight, slope_weight, penalty, power, pattern, window,
                                open_begin, open_end),
                     threads);
      },
      py::arg("references"), py::arg("curves"), py::arg("rate"), py::arg("force_weight"),
      py::arg("slope_weight"), py::arg("penalty"), py::arg("power"), py::arg("pattern"),
      py::arg("window"), py::arg("open_begin"), py::arg("open_end"), py::arg("threads"));
  module.def("score_defaults", &score_defaults);
  module.def("scores", &scores, py::arg("targets"), py::arg("applied"), py::arg("rate"),
             py::arg("scoring"), py::arg("threads"));
  module.def("study_scores", &study_scores, py::arg("paths"), py::arg("threads"));
}

}  // namespace haptrial::python
