#include "analysis/contact/exam/exam_stability.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>

#include "analysis/contact/exam/exam_bodies.h"
#include "analysis/contact/exam/mesh_file.h"
#include "analysis/files/csv.h"
#include "core/base/error.h"

namespace haptrial::evaluation {
namespace {

using Eigen::Vector3d;

constexpr double kMass = 0.05, kDamping = 1.0;  // of the hand [kg], [N·s/m]
constexpr double kPress = 2.0, kSway = 0.4;     // [N]
constexpr double kSwayRate = 2.0;               // [Hz]
constexpr double kSeconds = 3.0, kJudged = 1.0;
constexpr double kAway = 1.0;  // the hand has been thrown off [m]

/// Where a hand is, and how fast.
struct Hand {
  Vector3d place{0.0, 1e-3, 0.0};       // [m]
  Vector3d velocity{Vector3d::Zero()};  // [m/s]

  /// The exact motion of mass and damper under a constant force.
  void move(const Vector3d& force, double period) {
    const double keep = std::exp(-kDamping / kMass * period);
    const Vector3d end = force / kDamping;  // the velocity that it comes to
    place += end * period + (velocity - end) * (1.0 - keep) * kMass / kDamping;
    velocity = end + (velocity - end) * keep;
  }
};

double span_of(Candidate& candidate, const ContactTask& task) {
  candidate.begin(task);
  Hand hand;
  const auto pose = [&] { return Eigen::Isometry3d(Eigen::Translation3d(hand.place)); };
  candidate.start(pose());
  const double period = 1.0 / task.rate;
  const auto ticks = static_cast<int>(kSeconds * task.rate);
  double low = kAway, high = -kAway;
  for (int i = 0; i < ticks; ++i) {
    const double time = i * period;
    const double sway = kSway * std::sin(2.0 * std::numbers::pi * kSwayRate * time);
    hand.move(candidate.tick(time, pose()).force + Vector3d(sway, -kPress, 0.0), period);
    if (!(hand.place.norm() < kAway)) {
      return kAway;
    }
    if (time >= kSeconds - kJudged) {
      low = std::min(low, hand.place.y());
      high = std::max(high, hand.place.y());
    }
  }
  return high - low;
}

constexpr std::array kColumns{"stiffness_N_per_m", "friction", "rate_Hz", "span_m"};

}  // namespace

bool StabilityCell::passive() const { return kDamping > 0.5 * stiffness / rate; }

std::vector<StabilityCell> stability_cells() {
  std::vector<StabilityCell> cells;
  for (const double stiffness : {500.0, 1500.0, 3000.0, 6000.0}) {
    for (const double friction : {0.0, 0.3, 0.6}) {
      for (const double rate : {500.0, 1000.0, 2000.0}) {
        cells.push_back({stiffness, friction, rate});
      }
    }
  }
  return cells;
}

std::vector<StabilityCell> stability_of(Candidate& candidate) {
  const MeshFile plane(mesh_of(TruePlane{}, 1));
  std::vector<StabilityCell> cells = stability_cells();
  for (StabilityCell& cell : cells) {
    const ContactTask task{.body = plane.path(),
                           .stiffness = cell.stiffness,
                           .friction = cell.friction,
                           .rate = cell.rate};
    cell.span = span_of(candidate, task);
  }
  return cells;
}

std::string stability_csv(const std::vector<StabilityCell>& cells) {
  std::string text =
      fmt::format("{},{},{},{}\n", kColumns[0], kColumns[1], kColumns[2], kColumns[3]);
  for (const StabilityCell& cell : cells) {
    fmt::format_to(std::back_inserter(text), "{},{},{},{:.7f}\n", cell.stiffness, cell.friction,
                   cell.rate, cell.span);
  }
  return text;
}

std::vector<StabilityCell> read_stability(const std::filesystem::path& file) {
  const auto table = analysis::CsvTable::load(file);
  std::array<std::vector<double>, kColumns.size()> columns;
  for (std::size_t c = 0; c < kColumns.size(); ++c) {
    columns[c] = table.numbers(table.column(kColumns[c]));
  }
  const auto same = [](const StabilityCell& a, const StabilityCell& b) {
    return a.stiffness == b.stiffness && a.friction == b.friction && a.rate == b.rate;
  };
  std::vector<StabilityCell> cells, missing = stability_cells();
  for (std::size_t i = 0; i < table.rows(); ++i) {
    const StabilityCell cell{columns[0][i], columns[1][i], columns[2][i], columns[3][i]};
    if (std::erase_if(missing, [&](const StabilityCell& m) { return same(m, cell); }) == 0) {
      table.refuse(i, table.column(kColumns[0]),
                   "with friction and rate a cell that is asked, each once");
    }
    if (!(cell.span >= 0.0)) {
      table.refuse(i, table.column(kColumns[3]), "a span of at least 0 [m]");
    }
    cells.push_back(cell);
  }
  if (!missing.empty()) {
    throw InputError(fmt::format(
        "{}: has no row for {} N/m, friction {}, {} Hz; allowed: a row for each of {} cells",
        file.string(), missing[0].stiffness, missing[0].friction, missing[0].rate,
        stability_cells().size()));
  }
  return cells;
}

}  // namespace haptrial::evaluation
