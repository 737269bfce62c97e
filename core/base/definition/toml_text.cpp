#include "core/base/definition/toml_text_internal.h"

#include <fmt/format.h>

#include "core/base/definition/toml_mistake_internal.h"
#include "core/base/error.h"

namespace haptrial {
namespace {

/// A key may hold keys in turn ("a.b.c = 1"). Thousands of them on one line are one inside the
/// other, and a tree that deep overflows the stack when it is destroyed.
constexpr int kMostDotsInKey = 100;

/// Counts dots up to the end of a line, or to a comma that is not quoted: keys have none, but a
/// list of decimals does.
void refuse_deep_keys(std::string_view text, std::string_view file_name) {
  unsigned line = 1;
  int dots = 0;
  char quote = 0;  // the open one
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '\n') {
      ++line;
      dots = 0;
      quote = 0;
    } else if (c == '\\' && quote == '"' && i + 1 < text.size() && text[i + 1] != '\n') {
      ++i;
    } else if (c == '"' || c == '\'') {
      quote = quote == 0 ? c : quote == c ? 0 : quote;
    } else if (c == ',' && quote == 0) {
      dots = 0;
    } else if (c == '.' && ++dots > kMostDotsInKey) {
      throw InputError(
          fmt::format("{}:{}: the line has more than {} dots without a comma; write shorter keys",
                      file_name, line, kMostDotsInKey));
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
