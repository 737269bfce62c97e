#include "experiments/studio/remarks.h"

#include <charconv>
#include <sstream>
#include <string_view>

namespace haptrial::experiments {
namespace {

/// Removes "NUMBER:" from the front. @returns the number, or 0 if there is none.
int take_number(std::string_view& text) {
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const auto digits = static_cast<std::size_t>(end - text.data());
  if (error != std::errc{} || digits >= text.size() || text[digits] != ':') {
    return 0;
  }
  text.remove_prefix(digits + 1);
  return number;
}

bool take_start(std::string_view& text, std::string_view start) {
  const bool there = text.starts_with(start);
  text.remove_prefix(there ? start.size() : 0);
  return there;
}

Remark read_remark(std::string_view line, const std::string& file, bool is_mistake) {
  Remark remark;
  remark.is_mistake = is_mistake;
  if (take_start(line, file + ":")) {
    remark.line = take_number(line);
    remark.column = take_number(line);
  }
  take_start(line, " ");
  remark.text = line;
  return remark;
}

}  // namespace

std::vector<Remark> read_remarks(const std::string& output, const std::string& file, bool valid) {
  std::vector<Remark> remarks;
  std::istringstream lines(output);
  for (std::string line; std::getline(lines, line);) {
    std::string_view rest = line;
    if (take_start(rest, "warning: ")) {
      remarks.push_back(read_remark(rest, file, false));
      continue;
    }
    take_start(rest, "haptrial: ");
    if (!valid && !rest.empty()) {
      remarks.push_back(read_remark(rest, file, true));
    }
  }
  return remarks;
}

}  // namespace haptrial::experiments
