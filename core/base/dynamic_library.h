#pragma once

#include <string>
#include <string_view>

namespace haptrial {

/// A shared library that is loaded at run time: one of a vendor, which the program neither links
/// nor ships, or one that few commands need and that takes long to load.
class DynamicLibrary {
 public:
  /// @param name   a file name that the system's loader searches for ("libdhd.so.3"), or a path
  /// @param where  completes the sentence "it is part of WHERE"
  /// @throws InputError with the library, the loader's words and `where`, when it cannot be loaded.
  DynamicLibrary(std::string name, std::string_view where);
  ~DynamicLibrary();
  DynamicLibrary(DynamicLibrary&& other) noexcept;
  DynamicLibrary(const DynamicLibrary&) = delete;
  DynamicLibrary& operator=(const DynamicLibrary&) = delete;

  const std::string& name() const noexcept { return name_; }

  /// @throws InputError naming library and function, when the library (and what it itself loaded)
  ///         has no such function.
  template <class Function>
  void get(Function*& function, const char* symbol) const {
    function = reinterpret_cast<Function*>(required(symbol));
  }
  /// The same; a null pointer where there is none.
  template <class Function>
  void find(Function*& function, const char* symbol) const noexcept {
    function = reinterpret_cast<Function*>(optional(symbol));
  }

 private:
  void* required(const char* symbol) const;
  void* optional(const char* symbol) const noexcept;

  std::string name_;
  void* handle_{nullptr};
};

}  // namespace haptrial
