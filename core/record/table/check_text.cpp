#include "core/record/table/check_text.h"

#include <stdexcept>
#include <string>

namespace haptrial::record {

void check_text(std::string_view text, std::size_t bytes, const char* what) {
  if (text.size() > bytes) {
    throw std::invalid_argument(std::string(what) + " '" + std::string(text) + "' has " +
                                std::to_string(text.size()) + " bytes; allowed: at most " +
                                std::to_string(bytes));
  }
  if (text.find('\0') != std::string_view::npos) {
    throw std::invalid_argument(std::string(what) + " holds a NUL byte; remove it");
  }
}

}  // namespace haptrial::record
