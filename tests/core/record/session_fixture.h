#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/record/session_types.h"

namespace haptrial::test {

/// A directory of its own, removed at the end.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

record::SessionInfo example_info();

/// What a participant's hand gives: a smooth curve at 16 mm/s with tremor, read by an encoder with
/// steps of 1e-5 m, velocity from a first-order filter, forces smooth with noise, passes of 18 s.
std::vector<record::Sample> hand_motion(std::size_t count, std::uint64_t seed);

/// The row as it must come back: each value on the grid of its column, computed with
/// std::nearbyint.
record::Sample on_file(const record::Sample& sample);

bool same(const record::Sample& a, const record::Sample& b);

}  // namespace haptrial::test
