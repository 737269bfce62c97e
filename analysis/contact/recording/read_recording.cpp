#include "analysis/contact/recording/read_recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "analysis/files/csv.h"
#include "core/base/error.h"

namespace haptrial::evaluation {
namespace {

using analysis::CsvTable;

struct NamedUnit {
  const char* suffix;
  double factor;  // to SI
};
constexpr std::array<NamedUnit, 3> kSeconds{{{"_s", 1.0}, {"_ms", 1e-3}, {"_us", 1e-6}}};
constexpr std::array<NamedUnit, 2> kMetres{{{"_m", 1.0}, {"_mm", 1e-3}}};
constexpr std::array<NamedUnit, 2> kNewtons{{{"_N", 1.0}, {"_mN", 1e-3}}};
constexpr std::array<NamedUnit, 2> kNewtonMetres{{{"_Nm", 1.0}, {"_Nmm", 1e-3}}};

/// A column whose name is `stem` with one of the units; the table's `columns` where there is none.
struct FoundColumn {
  std::size_t place;
  double factor;
};
FoundColumn find_column(const CsvTable& table, const std::string& stem,
                        std::span<const NamedUnit> units) {
  FoundColumn found{table.columns().size(), 1.0};
  for (const NamedUnit& unit : units) {
    const std::string name = stem + unit.suffix;
    if (!table.has(name)) {
      continue;
    }
    if (found.place != table.columns().size()) {
      throw InputError(
          fmt::format("{}: columns '{}' and '{}' say the same in two units; leave one of them out",
                      table.name(), table.columns()[found.place], name));
    }
    found = {table.column(name), unit.factor};
  }
  return found;
}

std::vector<double> read_column(const CsvTable& table, const std::string& stem,
                                std::span<const NamedUnit> units) {
  const FoundColumn found = find_column(table, stem, units);
  if (found.place == table.columns().size()) {
    std::string allowed;
    for (const NamedUnit& unit : units) {
      allowed += (allowed.empty() ? "" : ", ") + stem + unit.suffix;
    }
    throw InputError(fmt::format("{}: no column of '{}' with its unit; allowed: {}", table.name(),
                                 stem, allowed));
  }
  std::vector<double> values = table.numbers(found.place);
  for (double& value : values) {
    value *= found.factor;
  }
  return values;
}

std::vector<Eigen::Vector3d> read_vectors(const CsvTable& table,
                                          const std::array<const char*, 3>& stems,
                                          std::span<const NamedUnit> units) {
  const std::array columns{read_column(table, stems[0], units), read_column(table, stems[1], units),
                           read_column(table, stems[2], units)};
  std::vector<Eigen::Vector3d> values;
  for (std::size_t i = 0; i < table.rows(); ++i) {
    values.emplace_back(columns[0][i], columns[1][i], columns[2][i]);
  }
  return values;
}

std::vector<Eigen::Quaterniond> read_orientations(const CsvTable& table) {
  const std::array<const char*, 4> names{"qw", "qx", "qy", "qz"};
  if (std::none_of(names.begin(), names.end(), [&](auto* name) { return table.has(name); })) {
    return std::vector(table.rows(), Eigen::Quaterniond::Identity());
  }
  std::array<std::vector<double>, 4> columns;
  for (std::size_t c = 0; c < 4; ++c) {
    columns[c] = table.numbers(table.column(names[c]));
  }
  std::vector<Eigen::Quaterniond> orientations;
  for (std::size_t i = 0; i < table.rows(); ++i) {
    const Eigen::Quaterniond q(columns[0][i], columns[1][i], columns[2][i], columns[3][i]);
    if (!(std::abs(q.norm() - 1.0) <= 0.01)) {
      table.refuse(i, table.column("qw"), "quaternions qw, qx, qy, qz of length 0.99 to 1.01");
    }
    orientations.push_back(q.normalized());
  }
  return orientations;
}

/// The rows to keep: the last one of those with equal times. Times that go back are refused.
std::vector<std::size_t> rows_in_time(const CsvTable& table, const std::vector<double>& times) {
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (i > 0 && times[i] < times[i - 1]) {
      table.refuse(i, find_column(table, "time", kSeconds).place, "times that do not go back");
    }
    if (i + 1 == times.size() || times[i + 1] != times[i]) {
      rows.push_back(i);
    }
  }
  if (rows.size() < 2) {
    throw InputError(fmt::format("{}: the table has {} distinct times; allowed: two or more",
                                 table.name(), rows.size()));
  }
  return rows;
}

template <class T>
std::vector<T> at_rows(const std::vector<T>& values, const std::vector<std::size_t>& rows) {
  std::vector<T> result;
  for (const std::size_t row : rows) {
    result.push_back(values[row]);
  }
  return result;
}

}  // namespace

PoseStream read_poses(const CsvTable& table) {
  const std::vector<double> times = read_column(table, "time", kSeconds);
  const auto positions = read_vectors(table, {"x", "y", "z"}, kMetres);
  const auto orientations = read_orientations(table);
  const std::vector<std::size_t> rows = rows_in_time(table, times);
  return {at_rows(times, rows), at_rows(positions, rows), at_rows(orientations, rows)};
}

ForceStream read_forces(const CsvTable& table) {
  const std::vector<double> times = read_column(table, "time", kSeconds);
  const auto forces = read_vectors(table, {"force_x", "force_y", "force_z"}, kNewtons);
  std::vector<Eigen::Vector3d> torques;
  const std::array<const char*, 3> names{"torque_x", "torque_y", "torque_z"};
  if (std::any_of(names.begin(), names.end(), [&](const char* name) {
        return find_column(table, name, kNewtonMetres).place != table.columns().size();
      })) {
    torques = read_vectors(table, names, kNewtonMetres);
  }
  const std::vector<std::size_t> rows = rows_in_time(table, times);
  return {at_rows(times, rows), at_rows(forces, rows),
          torques.empty() ? torques : at_rows(torques, rows)};
}

ContactRecording read_recording(const std::filesystem::path& poses,
                                const std::filesystem::path& forces) {
  const CsvTable pose_table = CsvTable::load(poses);
  ContactRecording recording;
  recording.pose = changes(read_poses(pose_table));
  recording.force = changes(read_forces(forces == poses ? pose_table : CsvTable::load(forces)));
  const double first = std::max(recording.pose.time.front(), recording.force.time.front());
  const double last = std::min(recording.pose.time.back(), recording.force.time.back());
  const auto check_moves = [](std::size_t values, const char* what, const auto& file) {
    if (values < 2) {
      throw InputError(fmt::format("{}: {} never change; allowed: a recording of a hand that moves",
                                   file.string(), what));
    }
  };
  check_moves(recording.pose.size(), "its poses", poses);
  check_moves(recording.force.size(), "its forces", forces);
  if (!(last - first >= 1.0)) {
    throw InputError(
        fmt::format("{} and {}: poses that move and forces that change overlap for {:.3g} s; "
                    "allowed: 1 s or more",
                    poses.string(), forces.string(), std::max(0.0, last - first)));
  }
  return recording;
}

}  // namespace haptrial::evaluation
