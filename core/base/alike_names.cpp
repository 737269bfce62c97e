#include "core/base/alike_names.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <utility>

namespace haptrial {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Whether a zero may be left out: it begins a whole number with further digits. Behind a decimal
/// mark it counts.
bool leads(const std::string& name, std::size_t i, const std::string& before) {
  const bool begins =
      before.empty() || !(is_digit(before.back()) || before.back() == '.' || before.back() == ',');
  return name[i] == '0' && begins && i + 1 < name.size() && is_digit(name[i + 1]);
}

/// Leaves out zeros that end a decimal number: 0.10 is 0.1.
void cut_zeros(std::string& name) {
  const std::size_t mark = name.find('.');
  const bool number =
      mark != name.npos && std::ranges::count_if(name, is_digit) + 1 == std::ssize(name);
  if (number) {
    name.resize(name.find_last_not_of('0') + 1);
    name.resize(name.size() - (name.back() == '.' ? 1 : 0));
  }
}

/// The name without what is easily typed by mistake.
std::string plain(const std::string& name) {
  std::string result;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const auto c = static_cast<unsigned char>(name[i]);
    if (leads(name, i, result)) {
      continue;
    }
    if (name.compare(i, 2, "\u00a0") == 0) {
      ++i;  // a blank that does not break, of two bytes
    } else if (c > ' ' && c != '-' && c != '_') {
      result += static_cast<char>(c >= 'A' && c <= 'Z' ? c + 32 : c);
    }
  }
  cut_zeros(result);
  return result;
}

}  // namespace

std::vector<std::vector<std::string>> alike_names(const std::vector<std::string>& names) {
  std::map<std::string, std::vector<std::string>> alike;
  for (const std::string& name : names) {
    alike[plain(name)].push_back(name);
  }
  std::vector<std::vector<std::string>> groups;
  for (auto& [key, group] : alike) {
    if (group.size() > 1) {
      groups.push_back(std::move(group));
    }
  }
  return groups;
}

std::string alike_names_warning(const std::string& what, const std::vector<std::string>& shown) {
  return fmt::format(
      "WARNING: the names of {} differ only in blanks, hyphens, capitals or zeros that change no "
      "number and are "
      "taken for different {}: {}.",
      what, what, fmt::join(shown, ", "));
}

std::vector<std::string> alike_names_warnings(const std::string& what,
                                              const std::vector<std::string>& names) {
  std::vector<std::string> warnings;
  for (std::vector<std::string>& group : alike_names(names)) {
    for (std::string& name : group) {
      name = fmt::format("\"{}\"", name);
    }
    warnings.push_back(alike_names_warning(what, group));
  }
  return warnings;
}

}  // namespace haptrial
