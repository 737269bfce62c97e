#include "core/base/exception_words.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <functional>
#include <new>
#include <optional>
#include <regex>
#include <stdexcept>
#include <typeinfo>
#include <variant>

#include "core/base/error.h"

namespace haptrial {
namespace {

/// The library throws this if a program uses it wrongly; no input should lead there.
bool is_own_fault(const std::exception& error) {
  const auto is = [&]<class... Kind>() {
    return (... || (dynamic_cast<const Kind*>(&error) != nullptr));
  };
  return is.
  operator()<std::bad_variant_access, std::bad_optional_access, std::bad_cast, std::bad_typeid,
             std::bad_function_call, std::bad_exception, std::out_of_range, std::regex_error>();
}

std::string sentence_of_path(const std::filesystem::filesystem_error& error) {
  const std::string why = error.code().message();
  if (error.path1().empty()) {
    return "a file cannot be used: " + why;
  }
  const std::string other = error.path2().empty() ? "" : " (to " + error.path2().string() + ")";
  return error.path1().string() + other + ": " + why;
}

}  // namespace

std::string sentence_of(const std::exception& error) {
  if (const auto* path = dynamic_cast<const std::filesystem::filesystem_error*>(&error)) {
    return sentence_of_path(*path);
  }
  const bool too_long = dynamic_cast<const std::length_error*>(&error) != nullptr;
  if (too_long || dynamic_cast<const std::bad_alloc*>(&error) != nullptr) {
    return "the memory is not enough; close other programs, allow more (ulimit -v), or give less";
  }
  if (is_own_fault(error)) {
    return std::string("this is a fault of haptrial (") + error.what() +
           "); please report it with the command and its files";
  }
  return error.what();
}

bool is_bad_input(const std::exception& error) {
  using std::errc;
  constexpr std::array kOfPaths{
      errc::no_such_file_or_directory, errc::filename_too_long,
      errc::not_a_directory,           errc::is_a_directory,
      errc::permission_denied,         errc::too_many_symbolic_link_levels,
      errc::read_only_file_system,     errc::file_exists,
      errc::directory_not_empty};
  if (const auto* path = dynamic_cast<const std::filesystem::filesystem_error*>(&error)) {
    return std::ranges::any_of(kOfPaths, [&](errc each) { return path->code() == each; });
  }
  return dynamic_cast<const InputError*>(&error) != nullptr;
}

}  // namespace haptrial
