#include "core/base/alike_names.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>
#include <utility>

namespace haptrial {
namespace {

/// The name without what is easily typed by mistake.
std::string plain(const std::string& name) {
  std::string result;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const auto c = static_cast<unsigned char>(name[i]);
    if (name.compare(i, 2, "\u00a0") == 0) {
      ++i;  // a blank that does not break, of two bytes
    } else if (c > ' ' && c != '-' && c != '_') {
      result += static_cast<char>(c >= 'A' && c <= 'Z' ? c + 32 : c);
    }
  }
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
      "WARNING: the names of {} differ only in blanks, hyphens or capitals and are taken for "
      "different {}: {}.",
      what, what, fmt::join(shown, ", "));
}

}  // namespace haptrial
