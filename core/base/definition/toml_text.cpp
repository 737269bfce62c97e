#include "core/base/definition/toml_text_internal.h"

#include <fmt/format.h>

#include "core/base/definition/toml_mistake_internal.h"
#include "core/base/error.h"

namespace haptrial {
namespace {

/// A key may hold keys in turn ("a.b.c = 1"). Thousands of them on one line are one inside the
/// other, and a tree that deep overflows the stack when it is destroyed.
constexpr int kMostDotsInLine = 100;

void refuse_deep_keys(std::string_view text, std::string_view file_name) {
  unsigned line = 1;
  int dots = 0;
  for (const char c : text) {
    if (c == '\n') {
      ++line;
      dots = 0;
    } else if (c == '.' && ++dots > kMostDotsInLine) {
      throw InputError(fmt::format("{}:{}: the line has more than {} dots; write shorter keys",
                                   file_name, line, kMostDotsInLine));
    }
  }
}

}  // namespace

toml::table parse_toml(std::string_view text, std::string_view file_name) {
  refuse_deep_keys(text, file_name);
  try {
    return toml::parse(text, file_name);
  } catch (const toml::parse_error& error) {
    if (const auto mistake = find_toml_mistake(text)) {
      throw InputError(fmt::format("{}:{}: {}", file_name, mistake->line, mistake->sentence));
    }
    throw InputError(fmt::format("{}:{}: not valid TOML: {}", file_name, error.source().begin.line,
                                 error.description()));
  }
}

}  // namespace haptrial
