#pragma once

#include <functional>
#include <string>

#include "core/base/error.h"

namespace haptrial::test {

/// Message of the error that the call throws.
template <class Error = InputError>
std::string message_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "nothing was thrown";
}

}  // namespace haptrial::test
