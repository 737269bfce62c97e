#include "analysis/exchange/bids_label.h"

namespace haptrial::exchange {

std::string bids_label(std::string_view text) {
  std::string label;
  for (const char c : text) {
    if ((c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z')) {
      label += c;
    }
  }
  return label;
}

}  // namespace haptrial::exchange
