#include "core/base/dynamic_library.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <utility>

#include "core/base/error.h"
#include "core/base/file_text.h"

namespace haptrial {

DynamicLibrary::DynamicLibrary(std::string name, std::string_view where) : name_(std::move(name)) {
  if (name_.find('/') != std::string::npos) {  // others are looked for among the system's
    refuse_special_file(name_);
  }
  handle_ = dlopen(name_.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (handle_ == nullptr) {
    const char* reason = dlerror();
    throw InputError(fmt::format("the library {} cannot be loaded ({}); it belongs to {}", name_,
                                 reason != nullptr ? reason : "no reason given", where));
  }
}

DynamicLibrary::DynamicLibrary(DynamicLibrary&& other) noexcept
    : name_(std::move(other.name_)), handle_(std::exchange(other.handle_, nullptr)) {}

DynamicLibrary::~DynamicLibrary() {
  if (handle_ != nullptr) {
    dlclose(handle_);
  }
}

void* DynamicLibrary::optional(const char* symbol) const noexcept { return dlsym(handle_, symbol); }

void* DynamicLibrary::required(const char* symbol) const {
  void* const address = optional(symbol);
  if (address == nullptr) {
    throw InputError(fmt::format("the library {} has no function {}; install another version of it",
                                 name_, symbol));
  }
  return address;
}

}  // namespace haptrial
