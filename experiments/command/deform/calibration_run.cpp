#include "experiments/command/deform/calibration_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <string_view>
#include <utility>

#include "core/base/error.h"
#include "core/base/file_text.h"
#include "core/base/parallel.h"
#include "core/base/whole_file.h"

namespace haptrial::experiments {
namespace {

using deformable::CalibrationProblem;
using deformable::SpringBody;

/// Measures of one load with the constants set by hand and those found.
JudgedLoad judged(const AnsweredLoad& given, const SpringBody& springs,
                  const deformable::SpringConstants& hand,
                  const deformable::SpringConstants& constants) {
  const CalibrationProblem alone(springs, {given.answer});
  JudgedLoad load;
  load.name = given.named.load.name;
  load.part = given.part;
  load.reference = given.named.setup.reference.empty() ? "elements" : given.named.setup.reference;
  load.markers = !given.answer.markers.empty();
  load.moved = load_error(given.answer, springs.rest);
  load.at_reference = given.answer.reference;
  load.hand = alone.error(hand, false).mean;
  load.at_hand = alone.rest(hand, 0);
  const auto found = alone.error(constants, false);
  load.found = found.mean;
  load.unstable = found.unstable;
  load.at_found = alone.rest(constants, 0);
  if (load.unstable.empty()) {
    load.shape = load_error(given.answer, load.at_found, deformable::ErrorMeasure::kShape);
    const double wanted = way_of_tool(given.answer.load, springs.rest, given.answer.reference);
    load.force = wanted / way_of_tool(given.answer.load, springs.rest, load.at_found) - 1.0;
  }
  return load;
}

}  // namespace

void judge_loads(const std::vector<AnsweredLoad>& loads, const SpringBody& springs,
                 const deformable::SpringConstants& hand, int threads, CalibrationRun& run) {
  run.loads.resize(loads.size());
  parallel_for(loads.size(), threads,
               [&](std::size_t i) { run.loads[i] = judged(loads[i], springs, hand, run.springs); });
}

double seen_error(const CalibrationRun& run, bool by_hand) {
  double sum = 0.0;
  int seen = 0;
  for (const JudgedLoad& load : run.loads) {
    if (load.part == LoadPart::kSeen) {
      sum += by_hand ? load.hand : load.found;
      ++seen;
    }
  }
  return sum / seen;
}

double share_left(const CalibrationRun& run, LoadPart part) {
  double sum = 0.0;
  int loads = 0;
  for (const JudgedLoad& load : run.loads) {
    if (load.part == part) {
      sum += load.found / load.moved;
      ++loads;
    }
  }
  return loads == 0 ? NAN : sum / loads;
}

namespace {

namespace fs = std::filesystem;
using deformable::CalibrationStep;

/// error, that of held-out loads, logarithms ... , why unstable; numbers so that they come back to
/// the bit
std::string line_of(const CalibrationStep& step) {
  std::string line = fmt::format("{},{}", step.error, step.held_out);
  for (const double x : step.logarithms) {
    fmt::format_to(std::back_inserter(line), ",{}", x);
  }
  return line + "," + step.unstable + "\n";
}

/// False: the line is not one.
bool read_line(std::string_view line, std::size_t parameters, CalibrationStep& step) {
  const char* at = line.data();
  const char* const end = at + line.size();
  for (std::size_t i = 0; i < parameters + 2; ++i) {
    double value = 0.0;
    const auto [next, error] = std::from_chars(at, end, value);
    if (error != std::errc() || next == end || *next != ',') {
      return false;
    }
    if (i == 0) {
      step.error = value;
    } else if (i == 1) {
      step.held_out = value;
    } else {
      step.logarithms.push_back(value);
    }
    at = next + 1;
  }
  step.unstable.assign(at, end);
  return true;
}

}  // namespace

CalibrationJournal::CalibrationJournal(fs::path file, std::uint64_t what, std::size_t parameters)
    : file_(std::move(file)) {
  const std::string head = fmt::format("calibration {:016x}\n", what);
  std::string kept = head;
  if (fs::exists(file_)) {
    read(file_text(file_), head, parameters);
    for (const CalibrationStep& step : known_) {
      kept += line_of(step);
    }
  }
  write_whole(file_, kept);  // without what was cut off
  out_.open(file_, std::ios::app);
}

void CalibrationJournal::read(const std::string& text, const std::string& head,
                              std::size_t parameters) {
  if (!text.starts_with(head)) {
    throw InputError(
        fmt::format("{}: is the journal of another calibration; remove it or choose "
                    "another --out",
                    file_.string()));
  }
  std::size_t at = head.size();
  for (std::size_t end = text.find('\n', at); end != std::string::npos; end = text.find('\n', at)) {
    CalibrationStep step;
    if (!read_line(std::string_view(text).substr(at, end - at), parameters, step)) {
      throw InputError(fmt::format("{}: evaluation {} is damaged; remove the file", file_.string(),
                                   known_.size() + 1));
    }
    known_.push_back(std::move(step));
    at = end + 1;
  }
}

void CalibrationJournal::add(const CalibrationStep& step) {
  out_ << line_of(step) << std::flush;
  if (!out_) {
    throw RunError(fmt::format("{}: cannot be written", file_.string()));
  }
}

void CalibrationJournal::remove() {
  out_.close();
  std::error_code ignored;
  fs::remove(file_, ignored);
}

std::string evaluations_csv(const std::vector<CalibrationStep>& steps) {
  constexpr std::size_t kMostColumns = 30;  // more parameters stay out
  constexpr double kMilli = 1e3;
  const bool wide = !steps.empty() && steps[0].logarithms.size() <= kMostColumns;
  std::string text = "evaluation,error_mm,best_mm,held_out_mm,unstable";
  for (std::size_t i = 0; wide && i < steps[0].logarithms.size(); ++i) {
    fmt::format_to(std::back_inserter(text), ",log10_constant_{}", i + 1);
  }
  text += "\n";
  double best = INFINITY;
  const auto number = [](double x) {
    return std::isfinite(x) ? fmt::format("{:.6g}", kMilli * x) : std::string();
  };
  for (std::size_t i = 0; i < steps.size(); ++i) {
    best = std::min(best, steps[i].error);
    fmt::format_to(std::back_inserter(text), "{},{},{},{},{}", i + 1, number(steps[i].error),
                   number(best), number(steps[i].held_out),
                   steps[i].unstable.empty() ? "" : "\"" + steps[i].unstable + "\"");
    for (std::size_t k = 0; wide && k < steps[i].logarithms.size(); ++k) {
      fmt::format_to(std::back_inserter(text), ",{:.6g}", steps[i].logarithms[k]);
    }
    text += "\n";
  }
  return text;
}

}  // namespace haptrial::experiments
