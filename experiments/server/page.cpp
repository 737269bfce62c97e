#include "experiments/server/page.h"

#include <fmt/format.h>

namespace haptrial::experiments {

std::string page_with_nonce(std::string_view html, const std::string& nonce) {
  constexpr std::string_view kPlace = "NONCE";
  std::string page(html);
  for (auto at = page.find(kPlace); at != std::string::npos; at = page.find(kPlace, at)) {
    page.replace(at, kPlace.size(), nonce);
  }
  return page;
}

std::string page_policy(const std::string& nonce) {
  return fmt::format(
      "default-src 'none'; script-src 'nonce-{0}'; style-src 'nonce-{0}'; connect-src 'self'; "
      "img-src 'self' data:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
      nonce);
}

}  // namespace haptrial::experiments
