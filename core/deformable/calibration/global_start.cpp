#include "core/deformable/calibration/global_start.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include "core/deformable/body/load_case.h"
#include "core/deformable/springs/spring_tangent.h"

namespace haptrial::deformable {
namespace {

using Eigen::Vector3d;
using Positions = std::vector<Vector3d>;

/// Loads that only push, with their forces by vertex.
struct Pushed {
  const CalibrationLoad* load;
  Positions forces;
  double moved;  // root mean square of the reference's displacements [m]
};

std::vector<Pushed> pushed_loads(const CalibrationProblem& problem) {
  std::vector<Pushed> result;
  for (const CalibrationLoad& load : problem.loads()) {
    const bool moves = std::ranges::any_of(
        load.load.holds, [](const Hold& hold) { return !hold.displacement.isZero(0); });
    const double moved = distance_error(load.reference, problem.body().rest);
    if (moves || load.load.forces.empty() || moved == 0.0) {
      continue;
    }
    Positions forces(load.reference.size(), Vector3d::Zero());
    for (const NodalForce& nodal : load.load.forces) {
      forces[static_cast<std::size_t>(nodal.vertex)] += nodal.force;
    }
    result.push_back({&load, std::move(forces), moved});
  }
  return result;
}

/// The response at rest, which the best common scale divides.
std::optional<EvenStart> scaled_start(const SpringBody& body, const std::vector<Pushed>& loads,
                                      const ThreeLogarithms& ratios) {
  double along = 0.0, square = 0.0, all = 0.0;
  for (const Pushed& pushed : loads) {
    const auto response =
        small_displacements(body, pushed.load->load.holds, body.rest, pushed.forces);
    if (!response) {
      return std::nullopt;
    }
    for (std::size_t v = 0; v < response->size(); ++v) {
      const Vector3d u = (*response)[v] / pushed.moved;
      const Vector3d wanted = (pushed.load->reference[v] - body.rest[v]) / pushed.moved;
      along += u.dot(wanted);
      all += wanted.squaredNorm();
      square += u.squaredNorm();
    }
  }
  if (!(along > 0.0) || !std::isfinite(square)) {
    return std::nullopt;
  }
  EvenStart start{ratios, std::sqrt(std::max(0.0, 1.0 - along * along / (square * all)))};
  for (double& logarithm : start.logarithms) {
    logarithm += std::log10(square / along);
  }
  return start;
}

std::vector<ThreeLogarithms> all_ratios(const RatioGrid& grid) {
  const int most = grid.decades * grid.per_decade;
  std::vector<ThreeLogarithms> ratios;
  for (int area = -most; area <= most; ++area) {
    for (int volume = -most; volume <= most; ++volume) {
      ratios.push_back({0.0, static_cast<double>(area) / grid.per_decade,
                        static_cast<double>(volume) / grid.per_decade});
    }
  }
  std::ranges::stable_sort(
      ratios, {}, [](const ThreeLogarithms& r) { return std::abs(r[1]) + std::abs(r[2]); });
  return ratios;
}

}  // namespace

std::vector<EvenStart> global_starts(const CalibrationProblem& problem,
                                     const SpringParameters& parameters,
                                     std::span<const SearchRange> ranges, const RatioGrid& grid) {
  const std::vector<Pushed> loads = pushed_loads(problem);
  SpringBody body = problem.body();
  std::vector<EvenStart> starts;
  for (const ThreeLogarithms& ratios : all_ratios(grid)) {
    if (loads.empty()) {
      const double middle = 0.5 * (ranges[0].low + ranges[0].high);
      starts.push_back({{middle, middle + ratios[1], middle + ratios[2]}, 1.0});
      continue;
    }
    body.constants = parameters.constants(parameters.even(ratios));
    if (const auto start = scaled_start(body, loads, ratios)) {
      starts.push_back(*start);
    }
  }
  std::ranges::stable_sort(starts, {}, &EvenStart::left);
  for (EvenStart& start : starts) {
    for (double& logarithm : start.logarithms) {
      logarithm = std::clamp(logarithm, ranges[0].low, ranges[0].high);
    }
  }
  return starts;
}

namespace {

/// One parameter's part in one coordinate's force.
struct Entry {
  std::size_t row;  // of all loads' coordinates
  double value;
};
/// The forces on the free vertices with one parameter 1 and the others 0, by parameter.
using Columns = std::vector<std::vector<Entry>>;

/// Forces that act from outside on the free vertices, load after load.
std::vector<double> acting_forces(const CalibrationProblem& problem) {
  std::vector<double> all;
  for (const CalibrationLoad& load : problem.loads()) {
    std::vector<Eigen::Vector3d> acting(load.reference.size(), Eigen::Vector3d::Zero());
    for (const NodalForce& nodal : load.load.forces) {
      acting[static_cast<std::size_t>(nodal.vertex)] += nodal.force;
    }
    for (const Hold& hold : load.load.holds) {
      acting[static_cast<std::size_t>(hold.vertex)].setZero();
    }
    for (const Eigen::Vector3d& f : acting) {
      all.insert(all.end(), f.begin(), f.end());
    }
  }
  return all;
}

class ForceColumns {
 public:
  ForceColumns(const CalibrationProblem& problem, const SpringParameters& parameters)
      : parameters_(parameters), columns_(parameters.size()) {
    const SpringBody& body = problem.body();
    for (const CalibrationLoad& load : problem.loads()) {
      held_ = held_flags(body.rest.size(), load.load.holds);
      add(SpringKind::kLength, body.parts.edges, body.lengths, load,
          [](const Spring& s, const Points2& p) { return length_forces(s, p); });
      add(SpringKind::kArea, body.parts.faces, body.areas, load,
          [](const Spring& s, const Points3& p) { return area_forces(s, p, ForceForm::kExact); });
      add(SpringKind::kVolume, body.tetrahedra, body.volumes, load,
          [](const Spring& s, const Points4& p) { return volume_forces(s, p, ForceForm::kExact); });
      begin_ += 3 * body.rest.size();
    }
    for (auto& column : columns_) {
      sum_rows(column);
    }
  }
  Columns take() { return std::move(columns_); }

 private:
  template <std::size_t n, class Forces>
  void add(SpringKind kind, const std::vector<std::array<std::int32_t, n>>& springs,
           const std::vector<double>& rest, const CalibrationLoad& load, Forces forces) {
    for (std::size_t s = 0; s < springs.size(); ++s) {
      const auto force = forces(Spring{1.0, rest[s]}, points_of<n>(load.reference, springs[s]));
      for (const auto& [parameter, weight] : parameters_.shares(kind, s)) {
        auto& column = columns_[static_cast<std::size_t>(parameter)];
        for (std::size_t i = 0; i < n; ++i) {
          const auto v = static_cast<std::size_t>(springs[s][i]);
          for (int axis = 0; held_[v] == 0 && axis < 3; ++axis) {
            column.push_back(
                {begin_ + 3 * v + static_cast<std::size_t>(axis), weight * force[i][axis]});
          }
        }
      }
    }
  }

  /// One entry a row.
  static void sum_rows(std::vector<Entry>& column) {
    std::sort(column.begin(), column.end(),
              [](const Entry& a, const Entry& b) { return a.row < b.row; });
    std::size_t kept = 0;
    for (std::size_t i = 0; i < column.size(); ++i) {
      if (kept > 0 && column[kept - 1].row == column[i].row) {
        column[kept - 1].value += column[i].value;
      } else {
        column[kept++] = column[i];
      }
    }
    column.resize(kept);
  }

  const SpringParameters& parameters_;
  Columns columns_;
  std::vector<std::uint8_t> held_;
  std::size_t begin_{0};
};

/// min |A x + b|² with x >= 0, one unknown after another, each to its best.
std::vector<double> non_negative(const Columns& a, std::vector<double> left_over) {
  constexpr double kMostWork = 4e9;  // products: some seconds
  constexpr double kSame = 1e-12;
  std::vector<double> x(a.size(), 0.0), squares(a.size(), 0.0);
  double work = 1.0;
  for (std::size_t j = 0; j < a.size(); ++j) {
    for (const Entry& entry : a[j]) {
      squares[j] += entry.value * entry.value;
    }
    work += static_cast<double>(a[j].size());
  }
  for (double done = 0.0; done < kMostWork; done += work) {
    double change = 0.0;
    for (std::size_t j = 0; j < x.size(); ++j) {
      if (!(squares[j] > 0.0)) {
        continue;
      }
      double slope = 0.0;
      for (const Entry& entry : a[j]) {
        slope -= entry.value * left_over[entry.row];
      }
      const double step = std::max(-x[j], slope / squares[j]);
      for (const Entry& entry : a[j]) {
        left_over[entry.row] += step * entry.value;
      }
      change = std::max(change, std::abs(step));
      x[j] += step;
    }
    if (change <= kSame * *std::max_element(x.begin(), x.end())) {
      break;
    }
  }
  return x;
}

}  // namespace

std::vector<double> starting_constants(const CalibrationProblem& problem,
                                       const SpringParameters& parameters,
                                       std::span<const SearchRange> ranges) {
  const std::vector<double> acting = acting_forces(problem);
  std::vector<double> logarithms;
  if (std::all_of(acting.begin(), acting.end(), [](double f) { return f == 0.0; })) {
    for (const SearchRange& range : ranges) {
      logarithms.push_back(0.5 * (range.low + range.high));
    }
    return logarithms;
  }
  const std::vector<double> x = non_negative(ForceColumns(problem, parameters).take(), acting);
  for (std::size_t j = 0; j < x.size(); ++j) {
    const double logarithm = x[j] > 0.0 ? std::log10(x[j]) : ranges[j].low;
    logarithms.push_back(std::clamp(logarithm, ranges[j].low, ranges[j].high));
  }
  return logarithms;
}

}  // namespace haptrial::deformable
