#include "experiments/studies/recorded_kinds.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "core/record/read/session_reader.h"
#include "experiments/studies/experiment.h"

namespace haptrial::experiments {
namespace fs = std::filesystem;
namespace {

/// Null if the file is no session, of which another sentence has told already.
std::optional<record::SessionInfo> info_of(const fs::path& file) {
  try {
    return record::SessionReader(file).info();
  } catch (const InputError&) {
    return std::nullopt;
  }
}

}  // namespace

void check_recorded_kinds(const fs::path& sessions) {
  std::vector<fs::path> files{sessions};
  if (fs::is_directory(sessions)) {
    files.assign(fs::directory_iterator(sessions), fs::directory_iterator());
    std::erase_if(files, [](const fs::path& file) { return file.extension() != ".h5"; });
    std::sort(files.begin(), files.end());
  }
  for (const fs::path& file : files) {
    const std::optional<record::SessionInfo> info = info_of(file);
    if (!info) {
      continue;
    }
    try {
      static_cast<void>(parse_experiment(info->definition, info->definition_name));
    } catch (const InputError& error) {
      throw InputError(fmt::format(
          "{}: this program cannot read its definition, and may lack kinds of the program that "
          "recorded it: {}",
          file.string(), error.what()));
    }
  }
}

}  // namespace haptrial::experiments
