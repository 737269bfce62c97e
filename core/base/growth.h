#pragma once

#include <cstddef>

namespace haptrial {

/// vector.resize(size, value), with room for an eighth more where it has to grow: a vector's own
/// growth would double what is large.
template <class Vector>
void resize_slowly(Vector& vector, std::size_t size,
                   const typename Vector::value_type& value = {}) {
  constexpr std::size_t kFew = 16;
  if (size > vector.capacity()) {
    vector.reserve(size + size / 8 + kFew);
  }
  vector.resize(size, value);
}

}  // namespace haptrial
