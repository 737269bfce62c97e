#include <fmt/format.h>

#include <filesystem>

#include "core/base/error.h"
#include "experiments/command/arguments.h"
#include "experiments/command/drilling/drilling_commands.h"
#include "experiments/studies/drilling/trainee_pages.h"

namespace haptrial::experiments {

int bone_page(const BonePageOptions& options) {
  if (std::filesystem::path(options.out).extension() != ".html") {
    throw InputError(fmt::format("{}: is not a page by its name; allowed: .html", options.out));
  }
  TraineeRequest request;
  request.sessions.assign(options.sessions.begin(), options.sessions.end());
  request.experts.assign(options.experts.begin(), options.experts.end());
  request.study = options.study;
  request.out = options.out;
  request.overwrite = options.overwrite;
  if (options.trial) {
    request.trial = checked_number("--trial", *options.trial, 1, 1000);
  }
  for (const std::filesystem::path& file : write_trainee_pages(request)) {
    fmt::print("wrote       {}\n", file.string());
  }
  return 0;
}

}  // namespace haptrial::experiments
