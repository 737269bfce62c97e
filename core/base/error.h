#pragma once

#include <stdexcept>
#include <string>

namespace haptrial {

/// Bad input from outside: a file, a definition, an argument. The message is one sentence that says
/// where, what was found and what is allowed. The command prints it and exits with status 2.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Something failed that good input cannot mend (a full disk, a lost device). Exit status 1.
class RunError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace haptrial
