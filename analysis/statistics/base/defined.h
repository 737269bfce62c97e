#pragma once

#include <string>
#include <utility>
#include <variant>

#include "core/base/error.h"

namespace haptrial::analysis {

/// Why a statistic does not exist for the data at hand; completes "not defined, because ...".
struct Undefined {
  std::string because;
};

/// Reason why values whose squares overflow or vanish have no statistic.
inline const char* const kBeyondDouble = "the values are too large or too small to compute with";

/// A statistic, or the reason why it does not exist: degenerate data never become a NaN in a table.
template <class T>
class Defined {
 public:
  Defined(T value) : state_(std::move(value)) {}
  Defined(Undefined reason) : state_(std::move(reason)) {}

  explicit operator bool() const { return std::holds_alternative<T>(state_); }
  /// @throws InputError with the reason if there is no value: not every statistic asks before.
  const T& operator*() const {
    if (const Undefined* reason = std::get_if<Undefined>(&state_)) {
      throw InputError("a statistic is not defined, because " + reason->because);
    }
    return std::get<T>(state_);
  }
  const T* operator->() const { return &**this; }

  /// The reason; @throws std::bad_variant_access when there is a value.
  const std::string& because() const { return std::get<Undefined>(state_).because; }

 private:
  std::variant<T, Undefined> state_;
};

}  // namespace haptrial::analysis
