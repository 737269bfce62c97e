#include "protocols/definition/window_keys.h"

#include <fmt/format.h>

#include <array>
#include <cctype>
#include <utility>

#include "core/base/definition/table.h"

namespace haptrial::protocols {

std::optional<int> key_code(const std::string& name) {
  static constexpr std::array<std::pair<const char*, int>, 6> kNamed{{{"space", kSpaceKey},
                                                                      {"enter", kEnterKey},
                                                                      {"right", 262},
                                                                      {"left", 263},
                                                                      {"down", 264},
                                                                      {"up", 265}}};
  for (const auto& [known, code] : kNamed) {
    if (name == known) {
      return code;
    }
  }
  const bool plain = name.size() == 1 && (std::isdigit(static_cast<unsigned char>(name[0])) != 0 ||
                                          (name[0] >= 'A' && name[0] <= 'Z'));
  return plain ? std::optional<int>(name[0]) : std::nullopt;
}

std::vector<int> read_window_keys(Table& table, const std::string& key) {
  std::vector<int> codes;
  for (const std::string& name : table.texts(key)) {
    if (const auto code = key_code(name)) {
      codes.push_back(*code);
    } else {
      table.reject(key, fmt::format("a list with '{}'", name), kKeyNames);
    }
  }
  return codes;
}

}  // namespace haptrial::protocols
