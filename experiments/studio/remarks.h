#pragma once

#include <string>
#include <vector>

namespace haptrial::experiments {

/// A sentence of `haptrial validate` about a definition.
struct Remark {
  bool is_mistake{true};  // else a warning
  int line{0};            // from 1; 0: of no line
  int column{0};          // from 1; 0: of the whole line
  std::string text;
};

/// The mistakes and warnings among the lines that `haptrial validate FILE` printed.
/// @param file  as it was given to the command
/// @param valid  whether the exit status was 0
std::vector<Remark> read_remarks(const std::string& output, const std::string& file, bool valid);

}  // namespace haptrial::experiments
