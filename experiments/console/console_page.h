#pragma once

#include <string>
#include <string_view>

namespace haptrial::experiments {

/// console.html as it stands in the source; built in.
std::string_view console_page_template();

/// A page with its nonce in place: only scripts and styles that carry it run.
std::string console_page(std::string_view html, const std::string& nonce);

/// The Content-Security-Policy for that page.
std::string console_page_policy(const std::string& nonce);

}  // namespace haptrial::experiments
