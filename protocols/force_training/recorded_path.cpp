#include "protocols/force_training/recorded_path.h"

#include <fmt/format.h>

#include <charconv>
#include <optional>

#include "core/base/error.h"
#include "core/record/read/session_reader.h"
#include "core/record/read/tick_rows.h"

namespace haptrial::protocols {
namespace {

constexpr double kSpacing = 2.5e-4;  // [m]

struct Source {
  std::filesystem::path file;
  int trial{0};
};

Source parsed(const std::string& from, const std::filesystem::path& folder) {
  const auto colon = from.rfind(':');
  Source source;
  if (colon != std::string::npos && colon > 0) {
    source.file = folder / from.substr(0, colon);
    const char* end = from.data() + from.size();
    const auto [rest, error] = std::from_chars(from.data() + colon + 1, end, source.trial);
    source.trial = error == std::errc{} && rest == end ? source.trial : 0;
  }
  if (source.trial < 1) {
    throw InputError(fmt::format(
        "trajectory.from is '{}'; allowed: FILE.h5:TRIAL, a session file and a number from 1",
        from));
  }
  return source;
}

std::optional<record::PassRow> last_completed(const record::SessionReader& reader, int trial) {
  std::optional<record::PassRow> found;
  for (const record::PassRow& row : reader.passes()) {
    if (!row.practice && row.trial == trial && row.status == record::PassStatus::kCompleted) {
      found = row;
    }
  }
  return found;
}

}  // namespace

std::vector<Eigen::Vector3d> recorded_path(const std::string& from,
                                           const std::filesystem::path& folder) {
  const Source source = parsed(from, folder);
  const record::SessionReader reader(source.file);
  const auto row = last_completed(reader, source.trial);
  if (!row) {
    throw InputError(
        fmt::format("{}: holds no completed pass of trial {}, which trajectory.from "
                    "names",
                    source.file.string(), source.trial));
  }
  std::vector<Eigen::Vector3d> path;
  Eigen::Vector3d last = Eigen::Vector3d::Zero();
  for (const record::Sample& s : record::samples_of_pass(reader, *row)) {
    if (s.stage != record::Stage::kRun) {
      continue;
    }
    last = {s.position.x(), 0.0, s.position.z()};
    if (path.empty() || (last - path.back()).norm() >= kSpacing) {
      path.push_back(last);
    }
  }
  if (path.size() < 2) {
    throw InputError(
        fmt::format("{}: the tool stayed where it was in trial {}, so trajectory.from "
                    "names no path",
                    source.file.string(), source.trial));
  }
  return path;
}

}  // namespace haptrial::protocols
