#include "experiments/studies/drilling/live_drilling.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <exception>
#include <tuple>
#include <utility>

#include "core/base/counted.h"
#include "core/base/exception_words.h"

namespace haptrial::experiments {

namespace drilling = analysis::drilling;

/// Rows of one call of add(samples), and the pass that began before them.
struct LiveDrilling::Batch {
  std::optional<record::PassRow> pass;
  std::shared_ptr<const bone::BoneModel> bone;
  std::shared_ptr<const drilling::Procedure> earlier;
  std::vector<record::Sample> samples;
  std::vector<record::ToolRow> tool;
  std::vector<record::RemovalRow> removals;
  std::vector<record::CameraRow> views;
  std::vector<record::SplitRow> splits;
  std::vector<record::PieceRow> pieces;
  std::vector<record::ScrewRow> screws;
};

/// One bone under the meter.
struct LiveDrilling::Bone {
  Bone(const record::PassRow& row, const std::shared_ptr<const bone::BoneModel>& model,
       const drilling::ProcedureSetup& setup, double rate)
      : pass(row),
        metrics(model, setup.pose_WB(model->grid), setup.tools, setup.scale, rate, setup.handle,
                setup.plans ? setup.plans(model) : drilling::ProcedurePlans{}) {}

  record::PassRow pass;
  drilling::LiveMetrics metrics;
  std::vector<record::ToolRow> early;  // their samples are still to come
};

namespace {

template <class Row>
void append(std::vector<Row>& to, std::span<const Row> rows) {
  to.insert(to.end(), rows.begin(), rows.end());
}

auto bone_key(const record::PassRow& pass) {
  return std::tuple(pass.practice, pass.trial, pass.repetition);
}

}  // namespace

LiveDrilling::LiveDrilling(drilling::ProcedureSetup setup, double rate)
    : setup_(std::move(setup)), rate_(rate), given_(std::make_unique<Batch>()) {
  thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

LiveDrilling::~LiveDrilling() { finish(); }

void LiveDrilling::begin(const record::PassRow& pass, std::shared_ptr<const bone::BoneModel> bone,
                         std::shared_ptr<const drilling::Procedure> earlier) {
  given_->pass = pass;
  given_->bone = std::move(bone);
  given_->earlier = std::move(earlier);
}

void LiveDrilling::add(std::span<const record::ToolRow> rows) { append(given_->tool, rows); }
void LiveDrilling::add(std::span<const record::RemovalRow> rows) { append(given_->removals, rows); }
void LiveDrilling::add(std::span<const record::CameraRow> rows) { append(given_->views, rows); }
void LiveDrilling::add(std::span<const record::SplitRow> rows) { append(given_->splits, rows); }
void LiveDrilling::add(std::span<const record::PieceRow> rows) { append(given_->pieces, rows); }
void LiveDrilling::add(std::span<const record::ScrewRow> rows) { append(given_->screws, rows); }

void LiveDrilling::add(std::span<const record::Sample> samples) {
  append(given_->samples, samples);
  const std::lock_guard lock(mutex_);
  if (trouble_.empty()) {
    waiting_.push_back(std::move(given_));
  }
  given_ = std::make_unique<Batch>();
}

void LiveDrilling::finish() {
  if (thread_.joinable()) {
    thread_.request_stop();
    thread_.join();
  }
}

void LiveDrilling::run(const std::stop_token& stop) {
  constexpr std::chrono::milliseconds kBetween{100};
  for (bool ended = false; !ended;) {
    std::vector<std::unique_ptr<Batch>> batches;
    {
      std::unique_lock lock(mutex_);
      ended_.wait_for(lock, stop, kBetween, [] { return false; });
      ended = stop.stop_requested();
      batches.swap(waiting_);
    }
    try {
      for (const auto& batch : batches) {
        measure(*batch);
      }
      if (bone_ && !batches.empty()) {
        show(*bone_);
      }
    } catch (const std::exception& error) {
      const std::lock_guard lock(mutex_);
      trouble_ = fmt::format("the drilling is still recorded but no longer measured: {}",
                             sentence_of(error));
      waiting_.clear();
      return;
    }
  }
}

void LiveDrilling::measure(Batch& batch) {
  if (batch.pass && (!bone_ || bone_key(bone_->pass) != bone_key(*batch.pass))) {
    if (bone_) {
      show(*bone_);
    }
    bone_ = std::make_unique<Bone>(*batch.pass, batch.bone, setup_, rate_);
    if (batch.earlier) {
      bone_->metrics.add(*batch.earlier);
    }
  }
  if (!bone_ || batch.samples.empty()) {
    return;
  }
  // Rows of a tick are in the logs before its sample is, so some are ahead of their samples. Where
  // a log lost rows, ticks that are not whole are passed over.
  std::vector<record::ToolRow>& tool = bone_->early;
  append(tool, std::span<const record::ToolRow>(batch.tool));
  std::vector<record::Sample> samples;
  std::vector<record::ToolRow> of_samples;
  auto row = tool.begin();
  for (const record::Sample& sample : batch.samples) {
    row = std::find_if(row, tool.end(),
                       [&](const auto& each) { return each.sequence >= sample.sequence; });
    if (row != tool.end() && row->sequence == sample.sequence) {
      samples.push_back(sample);
      of_samples.push_back(*row++);
    }
  }
  tool.erase(tool.begin(), row);
  drilling::LiveMetrics& metrics = bone_->metrics;
  metrics.add(samples, of_samples);
  metrics.add(std::span<const record::RemovalRow>(batch.removals));
  metrics.add(std::span<const record::CameraRow>(batch.views));
  metrics.add(std::span<const record::SplitRow>(batch.splits));
  metrics.add(std::span<const record::PieceRow>(batch.pieces));
  metrics.add(std::span<const record::ScrewRow>(batch.screws));
  metrics.advance(batch.samples.back().sequence);
}

void LiveDrilling::show(const Bone& bone) {
  DrilledProcedure procedure{bone.pass.trial, bone.pass.practice, bone.metrics.figures()};
  const std::lock_guard lock(mutex_);
  if (!procedures_.empty() && procedures_.back().trial == procedure.trial &&
      procedures_.back().practice == procedure.practice) {
    procedures_.back() = std::move(procedure);
  } else {
    procedures_.push_back(std::move(procedure));
  }
}

std::optional<DrilledProcedure> LiveDrilling::now() const {
  const std::lock_guard lock(mutex_);
  return procedures_.empty() ? std::nullopt : std::optional(procedures_.back());
}

std::vector<DrilledProcedure> LiveDrilling::procedures() const {
  const std::lock_guard lock(mutex_);
  std::vector<DrilledProcedure> done;
  std::copy_if(procedures_.begin(), procedures_.end(), std::back_inserter(done),
               [](const DrilledProcedure& procedure) { return !procedure.practice; });
  return done;
}

std::string LiveDrilling::trouble() const {
  const std::lock_guard lock(mutex_);
  return trouble_;
}

namespace {

std::string clock(double seconds) {
  const auto whole = static_cast<long>(seconds);
  return fmt::format("{}:{:02}", whole / 60, whole % 60);
}

/// A bone without known structures has no all-clear.
std::string injured(const analysis::drilling::LiveFigures& figures) {
  if (figures.injuries.empty()) {
    return "vital structures unknown: the bone has none by a known name";
  }
  std::string list;
  for (const analysis::drilling::Injury& injury : figures.injuries) {
    if (injury.voxels + injury.crumbled > 0) {
      list += fmt::format("{} {} {}", list.empty() ? "" : ",", injury.structure,
                          injury.voxels + injury.crumbled);
    }
  }
  return list.empty() ? "nothing vital injured" : fmt::format("INJURED:{}", list);
}

std::string of_the_plan(const analysis::drilling::Achieved& achieved) {
  if (achieved.fragment) {
    const analysis::drilling::FragmentFit& fit = *achieved.fragment;
    return fit.came_off ? fmt::format("gap {:.1f} mm, step {:.1f} mm, {} hold, ", 1e3 * fit.gap,
                                      1e3 * fit.step, counted(fit.screws, "screw", "screws"))
                        : "no fragment has come off, ";
  }
  const auto share = achieved.plan ? achieved.plan->share() : std::nullopt;
  return share ? fmt::format("{:.0f} % of the cavity, {:.1f} mm3 beyond it, ", 100.0 * *share,
                             1e9 * *achieved.beyond())
               : "";
}

std::string line_of(const DrilledProcedure& procedure) {
  const analysis::drilling::LiveFigures& f = procedure.figures;
  return fmt::format(
      "{}: {}, drilling {}, {:.1f} mm3 of bone, {} voxels, {}{}{}{}",
      procedure.practice ? "practice" : fmt::format("procedure {}", procedure.trial), clock(f.time),
      clock(f.drilling), 1e9 * f.removed, f.voxels, of_the_plan(f.achieved),
      f.visible_share ? fmt::format("{:.0f} % in sight, ", 100.0 * *f.visible_share) : "",
      f.mean_force ? fmt::format("{:.2f} N, ", *f.mean_force) : "", injured(f));
}

std::string capital(std::string text) {
  if (!text.empty()) {
    text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  }
  return text;
}

void add_figure(const analysis::drilling::AchievedFigure& figure, record::LiveState& state) {
  const std::string unit = figure.unit == "mm3"     ? "mm\u00b3"
                           : figure.unit == "mm3/m" ? "mm\u00b3/m"
                                                    : figure.unit;
  state.figures.push_back(
      {capital(figure.title),
       fmt::format("{:.{}f} {}", *figure.value, figure.unit == "screws" ? 0 : 1, unit), false});
}

}  // namespace

record::LiveState state_of(const DrilledProcedure& procedure) {
  const analysis::drilling::LiveFigures& f = procedure.figures;
  record::LiveState state;
  state.trial = procedure.trial;
  state.practice = procedure.practice;
  state.title = procedure.practice ? "Practice" : fmt::format("Procedure {}", procedure.trial);
  state.line = line_of(procedure);
  const auto add = [&state](const char* name, std::string value, bool alarm = false) {
    state.figures.push_back({name, std::move(value), alarm});
  };
  add("Time (drilling)", fmt::format("{} ({})", clock(f.time), clock(f.drilling)));
  add("Bone removed", fmt::format("{:.1f} mm\u00b3", 1e9 * f.removed));
  add("Voxels removed (visible)",
      fmt::format("{}{}", f.voxels,
                  f.visible_share ? fmt::format(" ({:.0f} %)", 100.0 * *f.visible_share) : ""));
  for (const analysis::drilling::AchievedFigure& figure :
       analysis::drilling::figures_of(f.achieved)) {
    if (figure.value) {
      add_figure(figure, state);
    }
  }
  add("Mean force while drilling",
      f.mean_force ? fmt::format("{:.2f} N", *f.mean_force) : "\u2013");
  std::vector<record::LiveState::Figure> injuries;
  for (const analysis::drilling::Injury& injury : f.injuries) {
    if (const auto voxels = injury.voxels + injury.crumbled; voxels > 0) {
      injuries.push_back({capital(injury.structure), fmt::format("{} voxels", voxels), true});
    }
  }
  const bool unknown = f.injuries.empty();
  add("Vital structures",
      unknown            ? "unknown: none by a known name"
      : injuries.empty() ? "none injured"
                         : fmt::format("{} injured", injuries.size()),
      unknown || !injuries.empty());
  state.figures.insert(state.figures.end(), injuries.begin(), injuries.end());
  return state;
}

}  // namespace haptrial::experiments
