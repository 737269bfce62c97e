#pragma once

#include <string>
#include <string_view>

namespace haptrial::experiments {

/// A page with its nonce in place of the word NONCE: only scripts and styles that carry it run.
std::string page_with_nonce(std::string_view html, const std::string& nonce);

/// The Content-Security-Policy for that page.
std::string page_policy(const std::string& nonce);

}  // namespace haptrial::experiments
