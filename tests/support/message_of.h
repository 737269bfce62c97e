#pragma once

#include <functional>
#include <string>

#include "core/base/error.h"

namespace haptrial::test {

/// What an InputError that the call throws says.
inline std::string message_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return "nothing was thrown";
}

}  // namespace haptrial::test
