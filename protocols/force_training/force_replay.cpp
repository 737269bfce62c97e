#include "protocols/force_training/force_replay.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "core/base/error.h"
#include "core/record/read/tick_rows.h"
#include "protocols/force_training/recorded_pass.h"
#include "protocols/interface/recorded_definition.h"

namespace haptrial::protocols {
namespace {

constexpr double kSame = 1e-9;  // [m] and [N]

ForceDefinition definition_of(const record::SessionReader& reader, int trial) {
  try {
    Table root = recorded_definition(reader, trial);
    ForceDefinition d = read_force_definition(root, reader.info().definition_name, nullptr);
    root.finish();
    show_as_recorded(reader, d);
    return d;
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: its definition is not one of this version of haptrial: {}",
                                 reader.path().string(), error.what()));
  }
}

/// Rows of the trial, one for each phase that is asked for.
std::vector<record::PassRow> chosen(const record::SessionReader& reader, int trial,
                                    std::optional<record::Phase> phase) {
  std::set<int> known;
  std::map<record::Phase, record::PassRow> last;
  for (const record::PassRow& row : reader.passes()) {
    if (row.practice) {
      continue;
    }
    known.insert(row.trial);
    if (row.trial == trial && (!phase || *phase == row.phase)) {
      last[row.phase] = row;  // a later attempt replaces an earlier one
    }
  }
  if (known.empty()) {
    throw InputError(fmt::format("{}: holds no trials", reader.path().string()));
  }
  if (last.empty() && known.contains(trial)) {
    throw InputError(
        fmt::format("{}: trial {} was aborted before this phase; choose another --phase",
                    reader.path().string(), trial));
  }
  if (last.empty()) {
    throw InputError(fmt::format("--trial is {}; allowed: {} to {}, the trials of {}", trial,
                                 *known.begin(), *known.rbegin(), reader.path().string()));
  }
  std::vector<record::PassRow> rows;
  for (const auto& [which, row] : last) {
    rows.push_back(row);
  }
  std::sort(rows.begin(), rows.end(),
            [](const auto& a, const auto& b) { return a.first_sample < b.first_sample; });
  return rows;
}

render::Image below(const render::Image& upper, const render::Image& lower) {
  // Videos need even sides: a column or row of the edge's own colour is added where one is odd.
  const int width = upper.width + upper.width % 2;
  const int height = upper.height + lower.height + (upper.height + lower.height) % 2;
  render::Image whole{width, height, {}};
  whole.rgb.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3);
  for (const render::Image* part : {&upper, &lower}) {
    const auto row = static_cast<std::size_t>(part->width) * 3;
    for (int y = 0; y < part->height; ++y) {
      const auto begin = part->rgb.begin() + static_cast<std::ptrdiff_t>(y * row);
      whole.rgb.insert(whole.rgb.end(), begin, begin + static_cast<std::ptrdiff_t>(row));
      if (width > part->width) {
        const std::vector<std::uint8_t> edge(whole.rgb.end() - 3, whole.rgb.end());
        whole.rgb.insert(whole.rgb.end(), edge.begin(), edge.end());
      }
    }
  }
  while (whole.rgb.size() <
         static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3) {
    const std::vector<std::uint8_t> edge(whole.rgb.end() - 3 * width, whole.rgb.end());
    whole.rgb.insert(whole.rgb.end(), edge.begin(), edge.end());
  }
  return whole;
}

}  // namespace

ForceReplay::ForceReplay(const std::filesystem::path& session, int trial,
                         std::optional<record::Phase> phase)
    : definition_(definition_of(record::SessionReader(session), trial)),
      renderer_(definition_.display),
      panel_context_(definition_.display.width, kPanelHeight),
      panel_(panel_context_.gl(), definition_.display, definition_.display.width, kPanelHeight) {
  const record::SessionReader reader(session);
  for (const record::PassRow& row : chosen(reader, trial, phase)) {
    passes_.push_back(read(reader, row));
  }
}

/// The stimulus of the row's seed, unless the file says that it was another.
stimulus::Stimulus ForceReplay::stimulus_of(const record::SessionReader& reader,
                                            const record::PassRow& row) {
  stimulus::Stimulus made =
      stimulus::make_stimulus(definition_.trajectory, definition_.force_pattern, row.stimulus_seed);
  const bool recorded = !definition_.trajectory.from.empty();  // and not made of a seed at all
  std::vector<Eigen::Vector3d> points;
  std::vector<double> forces;
  bool same = true;
  double end = 0.0;
  std::vector<record::StimulusRow> stored = reader.stimuli();
  // Older files do not have that of practice, whose block is 0 there; a recorded path is the same
  // in every block.
  const bool borrows = recorded && row.practice && row.block == 0 && !stored.empty();
  const std::int32_t block = borrows ? stored.front().block : row.block;
  std::erase_if(stored, [block](const record::StimulusRow& s) { return s.block != block; });
  record::keep_even(stored);
  for (const record::StimulusRow& s : stored) {
    points.push_back(s.position);
    forces.push_back(s.force);
    end = s.time;
    same = same && (made.path.at(s.time).position - s.position).norm() < kSame &&
           std::abs(made.force.at(s.time) - s.force) < kSame;
  }
  if ((same || row.practice) && !recorded) {
    return made;
  }
  if (points.size() < 2) {
    return made;
  }
  if (!recorded) {
    notice_ = fmt::format(
        "block {}: drawn as recorded, for this version makes another stimulus of its seed",
        row.block);
  }
  double length = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    length += (points[i] - points[i - 1]).norm();
  }
  return {stimulus::SpatialTrajectory(points, length / end),
          stimulus::ForcePattern(std::move(forces), end)};
}

ForceReplay::Pass ForceReplay::read(const record::SessionReader& reader,
                                    const record::PassRow& row) {
  Pass pass;
  pass.row = row;
  const std::vector<record::Sample> samples = record::samples_of_pass(reader, row);
  const stimulus::Stimulus stimulus = stimulus_of(reader, row);
  const auto rules =
      protocols::make_pass(row.condition, row.phase, stimulus, definition_.guidance, row.block);
  std::vector<record::TutoringRow> expert;
  if (definition_.shows_expert()) {
    expert = reader.rows<record::TutoringRow>();
    std::erase_if(expert, [&row](const record::TutoringRow& r) {
      return r.sequence < row.first_sample || r.sequence > row.last_sample;
    });
  }
  pass.seen = protocols::presentations(*rules, samples, reader.info().rate, expert);
  pass.path = stimulus.path.points();
  render::ForceCurves& curves = pass.curves;
  bool ran = false;
  for (const record::Sample& s : samples) {
    const double time = 1e-9 * static_cast<double>(s.time_ns - samples.front().time_ns);
    const bool runs = s.stage == record::Stage::kRun;
    pass.time.push_back(time);
    curves.target.push_back(s.target_force);
    curves.applied.push_back(s.applied_force);
    curves.run_begin = runs && !ran ? time : curves.run_begin;
    curves.run_end = runs ? time : curves.run_end;
    ran = ran || runs;
  }
  curves.time = pass.time;
  curves.title =
      fmt::format("{}   trial {}   {}", reader.info().subject, row.trial,
                  row.phase == record::Phase::kTest ? "test after " + row.condition + " training"
                                                    : row.condition + " training");
  curves.remark = reader.info().simulated ? "simulated participant" : "";
  return pass;
}

double ForceReplay::duration() const {
  double duration = 0.0;
  for (const Pass& pass : passes_) {
    duration += pass.time.back();
  }
  return duration;
}

const std::vector<stimulus::Presentation>& ForceReplay::seen(std::size_t pass) const {
  return passes_.at(pass).seen;
}

void ForceReplay::use(std::size_t pass) {
  if (pass != used_) {
    renderer_.set_trajectory(passes_[pass].path);
    panel_.set_curves(passes_[pass].curves);
    used_ = pass;
  }
}

render::Image ForceReplay::trial_picture(std::size_t pass, std::size_t sample) {
  const stimulus::Presentation& seen = passes_.at(pass).seen.at(sample);
  use(pass);
  return renderer_.draw(seen);
}

render::Image ForceReplay::draw(double time) {
  std::size_t number = 0;
  while (number + 1 < passes_.size() && time > passes_[number].time.back()) {
    time -= passes_[number++].time.back();
  }
  const Pass& pass = passes_[number];
  const auto next = std::upper_bound(pass.time.begin(), pass.time.end(), time);
  const auto sample =
      static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, next - pass.time.begin() - 1));
  const render::Image upper = trial_picture(number, sample);
  panel_context_.make_current();
  panel_.draw(pass.time[sample]);
  return below(upper, panel_context_.read());
}

}  // namespace haptrial::protocols
